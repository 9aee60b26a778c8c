#include <netinet/in.h>
#include <unistd.h>

#include <cstring>
#include <memory>
#include <utility>

#include "depth/base/error.h"
#include "tools/stream/udp_socket_internal.h"

namespace ossa::stream {
namespace {

void SetPort(sockaddr_storage& address, int port) {
  const in_port_t value = htons(static_cast<uint16_t>(port));
  if (address.ss_family == AF_INET6) {
    reinterpret_cast<sockaddr_in6&>(address).sin6_port = value;
  } else {
    reinterpret_cast<sockaddr_in&>(address).sin_port = value;
  }
}

}  // namespace

const addrinfo& ChooseAddress(const addrinfo& first) {
  for (const addrinfo* one = &first; one != nullptr; one = one->ai_next) {
    if (one->ai_family == AF_INET) return *one;
  }
  return first;
}

UdpSocket::UdpSocket(const Target& target) : port_(target.port) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int failure = getaddrinfo(target.host.c_str(), nullptr, &wanted, &found);
  if (failure != 0) {
    throw InputError("--send " + target.url + ": expected a host: " + gai_strerror(failure));
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> freed(found, &freeaddrinfo);
  const addrinfo& chosen = ChooseAddress(*found);
  std::memcpy(&address_, chosen.ai_addr, chosen.ai_addrlen);
  address_size_ = chosen.ai_addrlen;
  descriptor_ = socket(chosen.ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (descriptor_ < 0) {
    throw InputError("--send " + target.url + ": no socket: " + std::strerror(errno));
  }
  // So that a whole network's address may be sent to, as programs on a stage are; else that would
  // fail without a word at each datagram.
  const int yes = 1;
  setsockopt(descriptor_, SOL_SOCKET, SO_BROADCAST, &yes, sizeof(yes));
}

UdpSocket::~UdpSocket() {
  if (descriptor_ >= 0) close(descriptor_);
}

UdpSocket::UdpSocket(UdpSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      port_(other.port_),
      address_(other.address_),
      address_size_(other.address_size_) {}

void UdpSocket::Send(const std::string& bytes, int offset) const {
  if (port_ + offset > kMostPort) return;
  sockaddr_storage address = address_;
  SetPort(address, port_ + offset);
  // Fire and forget: no answer is expected.
  static_cast<void>(sendto(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL,
                           reinterpret_cast<const sockaddr*>(&address), address_size_));
}

}  // namespace ossa::stream
