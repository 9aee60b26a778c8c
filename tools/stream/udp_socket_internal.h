#pragma once
#include <netdb.h>
#include <sys/socket.h>

#include <string>

#include "tools/stream/target.h"

namespace ossa::stream {

/// Of a host's addresses, of which there is at least one, that which is sent to: of IPv4 where it
/// has one. Debian's "localhost" is ::1 first, and avatars' programs listen on IPv4 alone; an IPv6
/// address that is written out has no other.
const addrinfo& ChooseAddress(const addrinfo& first);

/// Sends datagrams to a target and its next ports without ever waiting.
class UdpSocket {
 public:
  /// Throws InputError where the host has no address.
  explicit UdpSocket(const Target& target);
  ~UdpSocket();
  UdpSocket(UdpSocket&& other) noexcept;
  UdpSocket& operator=(UdpSocket&&) = delete;

  /// To the target's port plus `offset`, if there is such a port. What cannot leave at once is
  /// dropped.
  void Send(const std::string& bytes, int offset) const;

 private:
  int descriptor_ = -1;
  int port_ = 0;
  sockaddr_storage address_{};
  socklen_t address_size_ = 0;
};

}  // namespace ossa::stream
