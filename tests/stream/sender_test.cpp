#include "tools/stream/sender.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cstring>
#include <string>

namespace ossa::stream {
namespace {

// What is sent to a port of this machine.
class Receiver {
 public:
  Receiver() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&address), size), 0);
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~Receiver() { close(socket_); }
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  int port() const { return port_; }
  std::string Next() const {
    std::string datagram(65536, ' ');
    const ssize_t size = recv(socket_, datagram.data(), datagram.size(), 0);
    datagram.resize(size > 0 ? static_cast<size_t>(size) : 0);
    return datagram;
  }

 private:
  int socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  int port_ = 0;
};

// The float of a bundle's /VMC/Ext/T.
float TimeIn(const std::string& bundle) {
  constexpr std::string_view kHead("/VMC/Ext/T\0\0,f\0\0", 16);
  const size_t at = bundle.find(kHead);
  if (at == std::string::npos || at + kHead.size() + 4 > bundle.size()) return -1.0F;
  uint32_t bits = 0;
  std::memcpy(&bits, bundle.data() + at + kHead.size(), sizeof(bits));
  return std::bit_cast<float>(ntohl(bits));
}

// A float of the seconds since 1970 has steps of 128.
TEST(Sender, APerformersTimeCountsFromTheFirstFrame) {
  const Receiver receiver;
  Sender sender({ParseTarget("vmc://127.0.0.1:" + std::to_string(receiver.port()))});
  tracker::BodyFrame frame;
  frame.bodies.resize(1);
  frame.bodies[0].id = 1;
  frame.bodies[0].state = tracker::BodyState::kTracked;
  for (const double time_s : {0.0, 0.5, 1.25}) {
    frame.time_s = 1.6e9 + time_s;
    sender.Send(frame);
    EXPECT_EQ(TimeIn(receiver.Next()), static_cast<float>(time_s));
  }
}

}  // namespace
}  // namespace ossa::stream
