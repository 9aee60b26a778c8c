#include "tools/viewer/viewer.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/depth_examples.h"

namespace ossa::viewer {
namespace {

using std::chrono::milliseconds;

/// A client of the viewer that says what it likes.
class Client {
 public:
  explicit Client(int port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{10, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
    EXPECT_EQ(connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  }
  Client(const Client&) = delete;
  ~Client() { close(socket_); }
  void Say(const std::string& text) const { send(socket_, text.data(), text.size(), MSG_NOSIGNAL); }
  /// The first line of what comes back; empty when nothing does.
  std::string Answer() const {
    std::string text(4096, '\0');
    const ssize_t size = recv(socket_, text.data(), text.size(), 0);
    text.resize(static_cast<size_t>(std::max<ssize_t>(size, 0)));
    return text.substr(0, text.find('\r'));
  }

 private:
  int socket_;
};

std::string AnswerTo(int port, const std::string& request) {
  const Client client(port);
  client.Say(request + "\r\n\r\n");
  return client.Answer();
}

TEST(Viewer, AnswersThisMachineAndNoPageElsewhere) {
  const Viewer viewer(0);
  for (const char* host : {"127.0.0.1", "localhost", "localhost:9000", "[::1]:9000"}) {
    const auto request = std::string("GET /frame HTTP/1.1\r\nHost: ") + host;
    EXPECT_EQ(AnswerTo(viewer.port(), request), "HTTP/1.1 200 OK") << host;
  }
  EXPECT_EQ(AnswerTo(viewer.port(), "GET /depth HTTP/1.1\r\nHost: evil.example"),
            "HTTP/1.1 403 Forbidden");
}

TEST(Viewer, TakesNoLargeRequest) {
  const Viewer viewer(0);
  EXPECT_EQ(AnswerTo(viewer.port(),
                     "POST /frame HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1200000000"),
            "HTTP/1.1 413 Payload Too Large");
}

// Browsers hold connections in store. One a thread, and two more; some send a byte now and then.
TEST(Viewer, NeitherServesNorEndsLateForClientsThatStall) {
  const auto started = std::chrono::steady_clock::now();
  {
    const Viewer viewer(0);
    std::vector<std::unique_ptr<Client>> stalling;
    for (int i = 0; i < 10; ++i) stalling.push_back(std::make_unique<Client>(viewer.port()));
    std::atomic<bool> done = false;
    std::thread dripping([&] {
      while (!done) {
        for (const auto& client : stalling) client->Say("G");
        std::this_thread::sleep_for(milliseconds(500));
      }
    });
    EXPECT_EQ(AnswerTo(viewer.port(), "GET /frame HTTP/1.1\r\nHost: localhost"), "HTTP/1.1 200 OK");
    done = true;
    dripping.join();
  }
  EXPECT_LT(std::chrono::steady_clock::now() - started, std::chrono::seconds(15));
}

// Frames come from one thread while browsers ask from others.
TEST(Viewer, ShowsWhileItIsAsked) {
  Viewer viewer(0);
  std::atomic<bool> done = false;
  std::thread asking([&] {
    while (!done) {
      for (const char* what : {"/frame", "/depth"}) {
        const std::string request = std::string("GET ") + what + " HTTP/1.1\r\nHost: localhost";
        EXPECT_EQ(AnswerTo(viewer.port(), request), "HTTP/1.1 200 OK") << what;
      }
    }
  });
  for (int f = 0; f < 30; ++f) {
    recon::SkeletonFrame skeletons;
    skeletons.frame = f;
    viewer.Show(test::ExampleFrame(f), skeletons);
    std::this_thread::sleep_for(milliseconds(5));
  }
  done = true;
  asking.join();
}

}  // namespace
}  // namespace ossa::viewer
