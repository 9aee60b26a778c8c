#include "tools/viewer/viewer.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/sanitized.h"
#include "tests/tools/viewer/example_display_frames.h"
#include "tests/tools/viewer/web_client.h"

namespace ossa::viewer {
namespace {

using std::chrono::milliseconds;

// Browsers open spare connections; some clients send a byte now and then.
TEST(Viewer, ServesThePageBesideTwoHundredSlowConnections) {
  constexpr size_t kSlow = 200;
  const auto started = std::chrono::steady_clock::now();
  {
    const Viewer viewer(AnyPort());
    std::vector<std::unique_ptr<Client>> stalling;
    for (size_t i = 0; i < kSlow; ++i) stalling.push_back(std::make_unique<Client>(viewer.port()));
    for (int round = 0; round < 5; ++round) {
      for (const auto& client : stalling) client->Say("G");
      EXPECT_EQ(AnswerTo(viewer.port(), kStateRequest), "HTTP/1.1 200 OK");
    }
  }
  EXPECT_LT(std::chrono::steady_clock::now() - started, std::chrono::seconds(5));
}

double ResidentMegabytes() {
  long size = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> size >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

// Opens all files that this process may open, but for one.
class AllFilesButOne {
 public:
  AllFilesButOne() {
    getrlimit(RLIMIT_NOFILE, &before_);
    rlimit few = before_;
    few.rlim_cur = 128;
    setrlimit(RLIMIT_NOFILE, &few);
    for (int file = dup(0); file >= 0; file = dup(0)) files_.push_back(file);
    close(files_.back());
    files_.pop_back();
  }
  ~AllFilesButOne() {
    for (const int file : files_) close(file);
    setrlimit(RLIMIT_NOFILE, &before_);
  }
  AllFilesButOne(const AllFilesButOne&) = delete;
  AllFilesButOne& operator=(const AllFilesButOne&) = delete;

 private:
  rlimit before_{};
  std::vector<int> files_;
};

TEST(Viewer, WaitsIdlyWithoutFreeFileDescriptors) {
  const Viewer viewer(AnyPort());
  auto files = std::make_optional<AllFilesButOne>();
  const Client client(viewer.port());  // takes the last one
  const std::clock_t before = std::clock();
  std::this_thread::sleep_for(milliseconds(500));
  const double busy_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  EXPECT_LT(busy_s, 0.1) << "processor time of all threads in half a second";
  files.reset();
  client.Say(std::string(kStateRequest) + "\r\n\r\n");
  EXPECT_EQ(client.Answer(), "HTTP/1.1 200 OK");
}

// More connections than are held at a time, each with a request that it does not end.
TEST(Viewer, FreesTheMemoryOfAFloodOfRequests) {
  if (test::kSanitized) GTEST_SKIP() << "what is freed is kept to watch it";
  Viewer viewer(AnyPort());
  const double before = ResidentMegabytes();
  for (int i = 0; i < 2000; ++i) {
    const Client client(viewer.port());
    client.Say("GET /" + std::string(7000, 'x'));
  }
  EXPECT_EQ(AnswerTo(viewer.port(), kStateRequest), "HTTP/1.1 200 OK");
  constexpr double kMost_mb = 30;  // 2000 times 16 kB would be 32; held are 256 at most
  EXPECT_LT(ResidentMegabytes() - before, kMost_mb);
}

// A client that sends requests and never reads: its buffer is full, others are still served.
TEST(Viewer, ServesOtherPagesWhileOneReadsNothing) {
  Viewer viewer(AnyPort());
  viewer.Show(ExampleDisplayFrame(0));
  PageClient stuck(viewer.port()), page(viewer.port());
  for (int i = 0; i < 50; ++i) stuck.Say(R"({"after":-1})");
  for (int f = 1; f < 20; ++f) {
    viewer.Show(ExampleDisplayFrame(f));
    EXPECT_EQ(HeaderOf(page.Ask(R"({"after":-1})"))["number"], f);
  }
}

// Frames come from one thread while requests come from others.
TEST(Viewer, AcceptsFramesWhileItAnswersRequests) {
  Viewer viewer(AnyPort(true));
  std::atomic<bool> done = false;
  std::thread asking([&] {
    PageClient page(viewer.port());
    while (!done) {
      EXPECT_EQ(AnswerTo(viewer.port(), kStateRequest), "HTTP/1.1 200 OK");
      page.Ask(R"({"frame":3})");
    }
  });
  for (int f = 0; f < 30; ++f) {
    viewer.Show(ExampleDisplayFrame(f));
    if (f == 15) viewer.Clear();
    std::this_thread::sleep_for(milliseconds(5));
  }
  done = true;
  asking.join();
}

}  // namespace
}  // namespace ossa::viewer
