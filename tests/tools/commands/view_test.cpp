#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"
#include "tools/viewer/viewer.h"

namespace ossa::commands {
namespace {

using std::chrono::milliseconds;
using test::CommandResult;
using test::LineCount;
using test::RunOssa;
using test::TemporaryFolder;

void WriteSkeletons(const std::filesystem::path& path) {
  std::ofstream file(path);
  for (int i = 0; i < 3; ++i) {
    file << R"({"frame":)" << i << R"(,"time_s":)" << i / 30.0
         << R"(,"bodies":[{"id":1,"joints":{"Head":{"p":[0,0.5,2],"state":"tracked"}}}]})"
         << "\n";
  }
}

TEST(ViewCommand, ShowsASkeletonFileOnceAndEnds) {
  const TemporaryFolder folder;
  WriteSkeletons(folder / "x.jsonl");
  const CommandResult result =
      RunOssa({"view", (folder / "x.jsonl").string(), "--port", "0", "--once"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_NE(result.err.find("watch at http://127.0.0.1:"), std::string::npos) << result.err;
}

TEST(ViewCommand, CtrlCEndsIt) {
  const TemporaryFolder folder;
  WriteSkeletons(folder / "x.jsonl");
  auto command = test::StartOssa({"view", (folder / "x.jsonl").string(), "--port", "0"});
  ASSERT_TRUE(command.WaitForError("watch at", test::kCommandTimeout));
  command.Signal(SIGINT);
  EXPECT_FALSE(command.Wait(test::kCommandTimeout).timed_out);
}

// It began anew without end: a second of processor time would be used up at once.
TEST(ViewCommand, ARecordingOfOneFrameIsShownAtItsLeisure) {
  const TemporaryFolder folder;
  std::ofstream(folder / "one.jsonl") << R"({"frame":0,"time_s":0,"bodies":[]})"
                                      << "\n";
  const CommandResult result = test::RunProgram(
      {"/bin/bash", "-c", R"(ulimit -t 1; timeout -s INT 3 "$1" view "$2" --port 0)", "shell",
       test::OssaPath(), (folder / "one.jsonl").string()});
  constexpr int kEndedByTimeout = 124;
  EXPECT_EQ(result.exit_status, kEndedByTimeout) << result.err;
}

TEST(ViewCommand, APortThatIsTakenIsOneLine) {
  const TemporaryFolder folder;
  WriteSkeletons(folder / "x.jsonl");
  const viewer::Viewer taken(0);
  const CommandResult result = RunOssa(
      {"view", (folder / "x.jsonl").string(), "--once", "--port", std::to_string(taken.port())});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(LineCount(result.err), 1) << result.err;
  EXPECT_NE(result.err.find(std::to_string(taken.port())), std::string::npos);
}

TEST(ViewCommand, WhatIsNoSkeletonFileIsNamed) {
  const TemporaryFolder folder;
  std::ofstream(folder / "x.jsonl") << "not json\n";
  const CommandResult result =
      RunOssa({"view", (folder / "x.jsonl").string(), "--port", "0", "--once"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_NE(result.err.find("x.jsonl"), std::string::npos) << result.err;
  EXPECT_EQ(LineCount(result.err), 1) << "nobody is told where to watch what cannot be shown";
  EXPECT_EQ(RunOssa({"view"}).exit_status, 2);
  EXPECT_EQ(RunOssa({"view", "x", "--camera", "wide"}).exit_status, 1) << "x comes first";
  EXPECT_EQ(RunOssa({"view", folder.path().string(), "--camera", "wide"}).exit_status, 2);
}

TEST(ViewCommand, AMethodThatLearnsNeedsWhatWasLearned) {
  const TemporaryFolder folder;
  const CommandResult result = RunOssa({"view", folder.path().string(), "--method", "full-gp"});
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_NE(result.err.find("--learned"), std::string::npos) << result.err;
}

TEST(ViewCommand, AStillIsASource) {
  const TemporaryFolder folder;
  std::ofstream(folder / "still.png") << "no image\n";
  const CommandResult result =
      RunOssa({"view", (folder / "still.png").string(), "--port", "0", "--once"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_NE(result.err.find("PNG"), std::string::npos) << result.err;
}

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
  const viewer::Viewer viewer(0);
  for (const char* host : {"127.0.0.1", "localhost", "localhost:9000", "[::1]:9000"}) {
    const auto request = std::string("GET /frame HTTP/1.1\r\nHost: ") + host;
    EXPECT_EQ(AnswerTo(viewer.port(), request), "HTTP/1.1 200 OK") << host;
  }
  EXPECT_EQ(AnswerTo(viewer.port(), "GET /depth HTTP/1.1\r\nHost: evil.example"),
            "HTTP/1.1 403 Forbidden");
}

TEST(Viewer, TakesNoLargeRequest) {
  const viewer::Viewer viewer(0);
  EXPECT_EQ(AnswerTo(viewer.port(),
                     "POST /frame HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1200000000"),
            "HTTP/1.1 413 Payload Too Large");
}

// Browsers hold connections in store. One a thread, and two more; some send a byte now and then.
TEST(Viewer, NeitherServesNorEndsLateForClientsThatStall) {
  const auto started = std::chrono::steady_clock::now();
  {
    const viewer::Viewer viewer(0);
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

}  // namespace
}  // namespace ossa::commands
