#include "tools/stream/sender.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "tools/stream/udp_socket_internal.h"

namespace ossa::stream {
namespace {

// The datagrams sent to a port of this machine.
class Receiver {
 public:
  explicit Receiver(in_addr_t at = INADDR_LOOPBACK) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(at);
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
  // On this machine a datagram is there once it was sent.
  bool HasOne() const {
    char byte = 0;
    return recv(socket_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) >= 0;
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
TEST(Sender, TimeOfAPerformerCountsFromTheFirstFrame) {
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

tracker::BodyFrame FrameOf(double time_s, const std::vector<int>& ids) {
  tracker::BodyFrame frame;
  frame.time_s = time_s;
  for (const int id : ids) {
    tracker::Body& body = frame.bodies.emplace_back();
    body.id = id;
    body.state = tracker::BodyState::kTracked;
    body.joints[recon::Joint::kHead].position_m.x() = id;
  }
  return frame;
}

// The person whom VRChat receives in each frame, by the head's x, which is the id; 0: nobody.
std::vector<int> WhomVrchatGets(const std::vector<tracker::BodyFrame>& frames) {
  const Receiver receiver;
  Sender sender({ParseTarget("vrchat://127.0.0.1:" + std::to_string(receiver.port()))});
  std::vector<int> whom;
  for (const tracker::BodyFrame& frame : frames) {
    sender.Send(frame);
    whom.push_back(0);
    if (!receiver.HasOne()) continue;
    constexpr std::string_view kHead("/tracking/trackers/head/position\0\0\0\0,fff\0\0\0\0", 44);
    const std::string bundle = receiver.Next();
    uint32_t bits = 0;
    std::memcpy(&bits, bundle.data() + bundle.find(kHead) + kHead.size(), sizeof(bits));
    whom.back() = static_cast<int>(std::lround(std::bit_cast<float>(ntohl(bits))));
    EXPECT_FALSE(receiver.HasOne()) << "one body a frame";
  }
  return whom;
}

TEST(Sender, VrchatReceivesTheNextPersonAfterTheFirstLeft) {
  EXPECT_EQ(WhomVrchatGets({FrameOf(0.0, {1, 2}), FrameOf(0.1, {2}), FrameOf(1.9, {2}),
                            FrameOf(2.5, {2}), FrameOf(2.6, {2, 3})}),
            (std::vector<int>{1, 0, 0, 2, 2}));
}

TEST(Sender, VrchatReceivesTheFirstPersonAgainAfterAShortAbsence) {
  EXPECT_EQ(WhomVrchatGets({FrameOf(0.0, {1, 2}), FrameOf(0.1, {2}), FrameOf(0.2, {1, 2})}),
            (std::vector<int>{1, 0, 1}));
  EXPECT_EQ(WhomVrchatGets({FrameOf(0.0, {1, 2}), FrameOf(0.1, {2}), FrameOf(0.2, {2, 3})}),
            (std::vector<int>{1, 0, 3}))
      << "with a new id, in the seat that was theirs";
}

// The addresses of "localhost" on Debian: ::1 first, where no receiver listens.
TEST(UdpSocket, HostWithBothKindsOfAddressIsReachedByIPv4) {
  addrinfo v4{}, v6{};
  v4.ai_family = AF_INET;
  v6.ai_family = AF_INET6;
  EXPECT_EQ(&ChooseAddress(v6), &v6);
  EXPECT_EQ(&ChooseAddress(v4), &v4);
  v6.ai_next = &v4;
  EXPECT_EQ(&ChooseAddress(v6), &v4);
}

TEST(UdpSocket, SendsToABroadcastAddress) {
  const Receiver receiver(INADDR_ANY);
  const UdpSocket socket(ParseTarget("udp://127.255.255.255:" + std::to_string(receiver.port())));
  socket.Send("x", 0);
  ASSERT_TRUE(receiver.HasOne());
  EXPECT_EQ(receiver.Next(), "x");
}

// 65536 would be port 0 of 16 bits, 65538 port 2.
TEST(UdpSocket, RefusesPortsBeyondTheLast) {
  const Receiver receiver;
  Target target = ParseTarget("udp://127.0.0.1:1");
  target.port = receiver.port();
  const UdpSocket socket(target);
  socket.Send("x", 65536);
  EXPECT_FALSE(receiver.HasOne());
  socket.Send("y", 0);
  EXPECT_EQ(receiver.Next(), "y");
}

}  // namespace
}  // namespace ossa::stream
