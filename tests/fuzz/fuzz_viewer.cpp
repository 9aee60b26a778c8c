// HTTP and WebSocket as the viewer's server reads them: whatever comes over a connection, and what
// pages ask for within.
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/fuzz/seeds.h"
#include "tools/viewer/server_internal.h"

namespace {

using namespace ossa;

viewer::ViewerOptions Options() {
  viewer::ViewerOptions options;
  options.keeps = true;
  options.settings = viewer::Settings{.method = "best", .smoothing = ""};
  options.methods = {"best", "holt"};
  return options;
}

// A recording of two frames.
struct Recording {
  Recording() : shared(Options()) {
    for (int f = 0; f < 2; ++f) {
      recon::SkeletonFrame frame;
      frame.frame = f;
      frame.time_s = f / 30.0;
      shared.store.Add(viewer::MakeDisplayFrame(frame));
    }
    shared.store.Complete();
  }
  viewer::SharedState shared;
};

std::string Get(const std::string& target) {
  return "GET " + target + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
}

// A whole text message of a client (RFC 6455, 5.2), its mask all zeros.
std::string Message(const std::string& text) {
  return std::string("\x81") + static_cast<char>(0x80 | text.size()) + std::string(4, '\0') + text;
}

void Drain(int socket) {
  char piece[65536];
  while (recv(socket, piece, sizeof(piece), MSG_DONTWAIT) > 0) {
  }
}

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  const std::string upgrade =
      "GET /socket HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  return {Get("/"),
          Get("/state?token=1"),
          Get("/lines?layer=final&from=0&count=1") + Get("/skeletons"),
          Get("/export?format=csv&from=0&to=1"),
          upgrade + Message(R"({"frame":1,"step":2})") + Message(R"({"state":true})"),
          upgrade + Message(R"({"settings":{"method":"holt","users":2}})") +
              Message(R"({"after":-1})") + std::string("\x89\x80\0\0\0\0", 6)};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static Recording recording;
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return 0;
  {
    viewer::Server server(recording.shared, {});
    const boost::asio::generic::stream_protocol protocol(AF_UNIX, 0);
    server.StartSession(viewer::Server::Socket(server.context(), protocol, ends[0]));
    send(ends[1], data, size, MSG_DONTWAIT | MSG_NOSIGNAL);
    shutdown(ends[1], SHUT_WR);
    constexpr int kRounds = 20;  // a request and its answer take two or three
    for (int i = 0; i < kRounds; ++i) {
      server.context().poll();
      Drain(ends[1]);
    }
  }
  close(ends[1]);
  return 0;
}
