// OpenNI2 devices, using the virtual one: behaviour and failures of a live camera.
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <fstream>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "depth/base/error.h"
#include "depth/image/camera_io.h"
#include "depth/image/turn.h"
#include "depth/sensor/frame_source.h"
#include "depth/sensor/oni_recorder.h"
#include "depth/sensor/openni2/lasting_thread.h"
#include "tests/support/depth_examples.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using test::ExampleFrame;
using test::TemporaryFolder;
using test::WriteExampleFolder;

std::string Uri(const TemporaryFolder& folder, const std::string& options = "") {
  return "openni:ossa://" + folder.path().string() + options;
}

// Busy machines may delay a frame by seconds; a minute without one is a failure.
ReadResult NextFrame(FrameSource& source) {
  const auto deadline = Clock::now() + std::chrono::minutes(1);
  ReadResult result;
  do {
    result = source.Read(milliseconds(500));
  } while (result.status != ReadStatus::kFrame && Clock::now() < deadline);
  return result;
}

// The folder index of this frame; -1 if it is none of them.
int NumberOf(const DepthFrame& frame, int count) {
  for (int i = 0; i < count; ++i) {
    if (frame.depth_mm == ExampleFrame(i).depth_mm) return i;
  }
  return -1;
}

// Held by an object older than the drivers, which are destroyed first at program exit.
std::unique_ptr<FrameSource> g_held_to_the_end;
struct LooksAtTheEnd {
  ~LooksAtTheEnd() {
    if (!g_held_to_the_end) return;
    const bool is_closed =
        g_held_to_the_end->Read(milliseconds(0)).status == ReadStatus::kDisconnected;
    if (!is_closed) _exit(3);
  }
} g_looks_at_the_end;

TEST(DeviceDeathTest, StaticDeviceClosesBeforeItsDriver) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto hold = [] {
    {
      const TemporaryFolder folder;
      WriteExampleFolder(folder.path(), 3);
      g_held_to_the_end = OpenSource(Uri(folder, "?loop=1"));
      NextFrame(*g_held_to_the_end);
    }
    exit(0);  // NOLINT(concurrency-mt-unsafe): that is what is tried
  };
  EXPECT_EXIT(hold(), testing::ExitedWithCode(0), "");
}

// OpenNI2 would play it as a device, without end.
TEST(Device, UriOfARecordingPlaysItToItsEnd) {
  const TemporaryFolder folder;
  {
    OniRecorder recorder(folder / "x.oni", ExampleFrame(0).camera);
    for (int i = 0; i < 3; ++i) recorder.Write(ExampleFrame(i));
    recorder.Finish();
  }
  const auto source = OpenSource("openni:" + (folder / "x.oni").string());
  EXPECT_FALSE(source->is_live());
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(NextFrame(*source).frame.depth_mm, ExampleFrame(i).depth_mm);
  EXPECT_EQ(source->Read(std::chrono::minutes(1)).status, ReadStatus::kEnd);
}

TEST(Device, DeliversTheFramesBitForBitAt30Hz) {
  const TemporaryFolder folder;
  constexpr int kFrames = 60;  // two seconds: a busy machine loses some of them
  WriteExampleFolder(folder.path(), kFrames);
  const auto source = OpenSource(Uri(folder));
  EXPECT_TRUE(source->is_live());
  EXPECT_EQ(source->frame_count(), std::nullopt);
  int last = -1;
  for (int i = 0; i < 5; ++i) {
    const ReadResult result = NextFrame(*source);
    ASSERT_EQ(result.status, ReadStatus::kFrame);
    const int number = NumberOf(result.frame, kFrames);
    ASSERT_GT(number, last) << "frames in order, none twice";
    if (last >= 0) {
      EXPECT_EQ(result.dropped, number - last - 1);
      EXPECT_EQ(result.frame.index, i + result.dropped);
    }
    last = number;
  }
}

TEST(Device, ReportsItsExactCamera) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 3);
  const Camera camera{32, 24, 30.5, 31.25, 15.5, 11.5};
  WriteCameraJson(folder / "camera.json", camera);
  EXPECT_EQ(OpenSource(Uri(folder))->camera(), camera);
  const SourceOptions options{.camera = ParseCamera("1,2,3,4"), .device_wait = {}};
  EXPECT_EQ(OpenSource(Uri(folder), options)->camera(), (Camera{32, 24, 1, 2, 3, 4}));
}

// A recording of mirrored images may be played as a device.
TEST(Device, MirroredOptionUnmirrorsImages) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 10);
  WriteCameraJson(folder / "camera.json", {32, 24, 30, 30, 14, 11.5});
  const auto source = OpenSource(Uri(folder, "?loop=1"), {.mirrored = true});
  EXPECT_EQ(source->camera().cx, 17.0);
  const DepthFrame frame = NextFrame(*source).frame;
  EXPECT_GE(NumberOf(Unmirrored(frame), 10), 0);
  EXPECT_EQ(NumberOf(frame, 10), -1);
}

// Other OpenNI2 programs have no option of ours: the URI is all that they can say. The second frame
// is of the second time round.
TEST(Device, MirroredUriUnmirrorsImages) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 1);
  WriteCameraJson(folder / "camera.json", {32, 24, 30, 30, 14, 11.5});
  const auto source = OpenSource(Uri(folder, "?mirrored=1&loop=1"));
  EXPECT_EQ(source->camera().cx, 17.0);
  for (int i = 0; i < 2; ++i) {
    const DepthFrame frame = NextFrame(*source).frame;
    EXPECT_EQ(NumberOf(Unmirrored(frame), 1), 0);
    EXPECT_EQ(NumberOf(frame, 1), -1);
  }
}

TEST(Device, MirroringIsSwitchedOff) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 10);
  const auto source = OpenSource(Uri(folder, "?mirror=1&loop=1"));
  EXPECT_GE(NumberOf(NextFrame(*source).frame, 10), 0);
}

TEST(Device, SlowReadersGetTheNewestFrameAndTheDroppedCount) {
  const TemporaryFolder folder;
  constexpr int kFrames = 60;
  WriteExampleFolder(folder.path(), kFrames);
  const auto source = OpenSource(Uri(folder, "?loop=1&fps=100"));
  int before = NumberOf(NextFrame(*source).frame, kFrames);
  // 200 ms are 20 frames, of which a queue would lose none. On a busy machine the camera itself may
  // stall for as long: then try again.
  int64_t dropped = 0;
  for (int attempt = 0; attempt < 20 && dropped <= 10; ++attempt) {
    std::this_thread::sleep_for(milliseconds(200));
    const ReadResult late = NextFrame(*source);
    ASSERT_EQ(late.status, ReadStatus::kFrame);
    dropped = late.dropped;
    const int number = NumberOf(late.frame, kFrames);
    EXPECT_EQ((before + 1 + dropped) % kFrames, number);
    before = number;
  }
  EXPECT_GT(dropped, 10);
}

TEST(Device, ReplugsWithNothingButAGap) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 8);
  const auto source =
      OpenSource(Uri(folder, "?loop=1&fps=60&unplug_after=6&replug_after_ms=150&unplugs=1000"));
  int disconnections = 0;
  bool connected = true;
  int64_t index = -1;
  double time_s = -1.0;
  int64_t dropped = 0;
  const auto deadline = Clock::now() + std::chrono::minutes(1);
  int frames_after = 0;
  while (frames_after < 3 && Clock::now() < deadline) {
    const ReadResult result = source->Read(milliseconds(50));
    if (result.status == ReadStatus::kDisconnected) {
      disconnections += connected ? 1 : 0;
      connected = false;
    }
    if (result.status != ReadStatus::kFrame) continue;
    connected = true;
    EXPECT_EQ(result.frame.index, index + 1 + result.dropped);
    EXPECT_GT(result.frame.time_s, time_s);
    index = result.frame.index;
    time_s = result.frame.time_s;
    dropped += result.dropped;
    if (disconnections >= 3) ++frames_after;
  }
  EXPECT_GE(disconnections, 3);
  EXPECT_EQ(frames_after, 3);
  EXPECT_GE(dropped, 3 * 8) << "each gap of 150 ms is 9 frames";
}

TEST(Device, TimesOutWhenNoFramesArrive) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 10);
  const auto source = OpenSource(Uri(folder, "?stall_after=1"));
  EXPECT_EQ(NextFrame(*source).status, ReadStatus::kFrame);
  const auto began = Clock::now();
  EXPECT_EQ(source->Read(milliseconds(250)).status, ReadStatus::kTimeout);
  EXPECT_GE(Clock::now() - began, milliseconds(250));
}

TEST(Device, StaysUnpluggedAfterItsEnd) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 3);
  const auto source = OpenSource(Uri(folder));
  ReadStatus status = ReadStatus::kFrame;
  for (int i = 0; i < 100 && status != ReadStatus::kDisconnected; ++i) {
    status = source->Read(milliseconds(200)).status;
  }
  EXPECT_EQ(status, ReadStatus::kDisconnected);
  EXPECT_EQ(source->Read(milliseconds(50)).status, ReadStatus::kDisconnected);
}

TEST(Device, UnreadableFramesCountAsDropped) {
  const TemporaryFolder folder;
  constexpr int kFrames = 6;
  WriteExampleFolder(folder.path(), kFrames);
  std::ofstream(folder / "000002.png") << "no PNG";
  const auto source = OpenSource(Uri(folder, "?loop=1&fps=20"));
  int last = -1;
  for (int64_t index = 0; index < 2 * kFrames;) {
    const ReadResult result = NextFrame(*source);
    ASSERT_EQ(result.status, ReadStatus::kFrame);
    index = result.frame.index;
    const int number = NumberOf(result.frame, kFrames);
    if (last >= 0) {
      EXPECT_EQ((last + 1 + result.dropped) % kFrames, number);
    }
    last = number;
  }
}

// A stream's size is fixed: a later recording at the same path may have another.
TEST(Device, DropsFramesOfAnotherSizeThanTheStream) {
  const TemporaryFolder folder;
  for (const auto& [name, width] : {std::pair("large", 32), {"small", 16}}) {
    std::filesystem::create_directory(folder / name);
    WriteExampleFolder(folder / name, 1, width, width * 3 / 4);
  }
  std::filesystem::create_directory_symlink("large", folder / "now");
  const auto source = OpenSource(Uri(folder, "/now?loop=1&fps=20"));
  ASSERT_EQ(NumberOf(NextFrame(*source).frame, 1), 0);
  std::filesystem::create_directory_symlink("small", folder / "next");
  std::filesystem::rename(folder / "next", folder / "now");
  const auto deadline = Clock::now() + std::chrono::minutes(1);
  ReadResult result;
  do {
    result = source->Read(milliseconds(200));
    ASSERT_TRUE(result.status != ReadStatus::kFrame || NumberOf(result.frame, 1) == 0);
  } while (result.status != ReadStatus::kDisconnected && Clock::now() < deadline);
  EXPECT_EQ(result.status, ReadStatus::kDisconnected) << "as at the end of a recording";
}

TEST(Device, TwoDevicesRunIndependently) {
  const TemporaryFolder a;
  const TemporaryFolder b;
  WriteExampleFolder(a.path(), 10);
  WriteExampleFolder(b.path(), 10, 16, 12);
  const auto first = OpenSource(Uri(a, "?loop=1"));
  const auto second = OpenSource(Uri(b, "?loop=1"));
  EXPECT_EQ(NextFrame(*first).frame.camera.width, 32);
  EXPECT_EQ(NextFrame(*second).frame.camera.width, 16);
}

TEST(Device, FirstDeviceIsNotReplacedByAnotherAfterUnplugging) {
  const TemporaryFolder a, b;
  WriteExampleFolder(a.path(), 5);
  WriteExampleFolder(b.path(), 5, 16, 12);
  setenv("OSSA_VIRTUAL_DEVICE", ("ossa://" + a.path().string()).c_str(), 1);
  const auto first = OpenSource("openni:");
  unsetenv("OSSA_VIRTUAL_DEVICE");
  ASSERT_EQ(NextFrame(*first).frame.camera.width, 32);
  const auto other = OpenSource(Uri(b, "?loop=1"));  // from now on one of OpenNI2's devices
  ReadStatus status = ReadStatus::kFrame;
  for (int i = 0; i < 100 && status != ReadStatus::kDisconnected; ++i) {
    status = first->Read(milliseconds(200)).status;
  }
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(first->Read(milliseconds(200)).status, ReadStatus::kDisconnected);
  }
}

// OpenNI2 changes to its drivers' folder before loading them.
TEST(Device, RelativePathsStartAtTheWorkingDirectory) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "clip");
  WriteExampleFolder(folder / "clip", 5);
  const char* before = getenv("PWD");
  const std::string shell = before == nullptr ? "" : before;
  setenv("PWD", folder.path().c_str(), 1);
  setenv("OSSA_VIRTUAL_DEVICE", "ossa://clip?loop=1", 1);
  const auto source = OpenSource("openni:");
  unsetenv("OSSA_VIRTUAL_DEVICE");
  setenv("PWD", shell.c_str(), 1);
  EXPECT_EQ(NextFrame(*source).frame.camera.width, 32);
}

TEST(Device, FirstDeviceContinuesAfterReplugging) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 8);
  const std::string options = "?loop=1&fps=60&unplug_after=6&replug_after_ms=150";
  setenv("OSSA_VIRTUAL_DEVICE", ("ossa://" + folder.path().string() + options).c_str(), 1);
  const auto source = OpenSource("openni:");
  unsetenv("OSSA_VIRTUAL_DEVICE");
  int64_t dropped = 0;  // some 9 frames where it was gone
  for (int i = 0; i < 20 && dropped < 8; ++i) dropped = NextFrame(*source).dropped;
  EXPECT_GE(dropped, 8);
}

// Runs the task on a thread that is completely released afterwards: its stack is larger than
// glibc's cache of stacks and than that of the previous thread, so it cannot reuse memory.
void OnAThreadThatEnds(std::function<void()> task) {
  static size_t stack = size_t{256} << 20;  // bytes
  stack += size_t{16} << 20;
  pthread_attr_t attributes;
  ASSERT_EQ(pthread_attr_init(&attributes), 0);
  ASSERT_EQ(pthread_attr_setstacksize(&attributes, stack), 0);
  const auto run = [](void* what) -> void* {
    (*static_cast<std::function<void()>*>(what))();
    return nullptr;
  };
  pthread_t thread{};
  ASSERT_EQ(pthread_create(&thread, &attributes, run, &task), 0);
  ASSERT_EQ(pthread_join(thread, nullptr), 0);
  pthread_attr_destroy(&attributes);
}

// OpenNI2 checks whether every thread that ever called it is alive, which crashes in glibc for
// ended threads: as in a program that opens its camera twice, each time on a new thread.
TEST(Device, OutlivesThreadsThatUsedIt) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 30);
  const std::string uri = Uri(folder, "?loop=1");
  for (int i = 0; i < 3; ++i) {
    OnAThreadThatEnds([&] {
      const auto source = OpenSource(uri);
      EXPECT_EQ(NextFrame(*source).status, ReadStatus::kFrame);
    });
  }
  std::unique_ptr<FrameSource> source;
  OnAThreadThatEnds([&] { source = OpenSource(uri); });
  for (int i = 0; i < 3; ++i) {
    OnAThreadThatEnds([&] { EXPECT_EQ(NextFrame(*source).status, ReadStatus::kFrame); });
  }
  OnAThreadThatEnds([&] { source.reset(); });
}

// Python's check for Ctrl-C has no effect on other threads.
TEST(Device, KeepWaitingIsCalledOnTheWaitingThread) {
  SourceOptions options;
  options.device_wait = std::chrono::minutes(1);
  std::vector<std::thread::id> asked;
  options.keep_waiting = [&] {
    asked.push_back(std::this_thread::get_id());
    return asked.size() < 2;
  };
  EXPECT_THROW(OpenSource("openni:ossa:///nowhere", options), InputError);
  EXPECT_EQ(asked, std::vector<std::thread::id>(2, std::this_thread::get_id()));
}

// A forked process has the sources but none of the threads.
TEST(LastingThread, InAForkedProcessTheCallerDoesTheWork) {
  const BorrowedThread thread;
  int done = 0;
  thread->Run([&] { done = 1; });
  const pid_t child = fork();
  if (child == 0) {
    alarm(20);
    thread->Run([&] { done = 2; });
    _exit(done == 2 ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(done, 1);
}

TEST(Device, MissingDeviceIsOneLineAfterTheRequestedWait) {
  for (const char* name :
       {"openni:", "openni:ossa:///nowhere", "openni:ossa://x?bad=1", "openni:1d27/0601@1/2"}) {
    const auto began = Clock::now();
    try {
      OpenSource(name, {.camera = {}, .device_wait = milliseconds(250)});
      ADD_FAILURE() << name;
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.rfind(std::string(name) + ": ", 0), 0u) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
    EXPECT_GE(Clock::now() - began, milliseconds(250));
  }
}

}  // namespace
}  // namespace ossa::depth
