#include "depth/sensor/fakenect_dump.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/image/packed_depth.h"

namespace ossa::depth {
namespace {

namespace fs = std::filesystem;

// Constants: of libfreenect's format.

constexpr int kWidth = 640;  // the only size fakenect supports
constexpr int kHeight = 480;
constexpr double kTicksPerSecond = 60e6;  // the Kinect's 32-bit clock

// libfreenect's freenect_raw_tilt_state of a level Kinect: 819 counts are 1 g.
struct RawTiltState {
  std::array<int16_t, 3> accelerometer = {0, 819, 0};
  int8_t tilt_angle = 0;
  int8_t padding = 0;  // named, so that no uninitialised byte is written
  int32_t tilt_status = 0;
};
static_assert(sizeof(RawTiltState) == 12);

// fakenect's file names: kind, seconds of the host clock, ticks of the Kinect's.
std::string FileName(char kind, double time_s, const char* extension) {
  // Microsecond resolution, with a decimal point in any locale.
  std::array<char, 80> seconds{};
  const auto end = std::to_chars(seconds.data(), seconds.data() + seconds.size(), time_s,
                                 std::chars_format::fixed, 6);
  const auto ticks = static_cast<uint64_t>(std::llround(time_s * kTicksPerSecond));
  return std::string(1, kind) + "-" + std::string(seconds.data(), end.ptr) + "-" +
         std::to_string(static_cast<uint32_t>(ticks)) + "." + extension;
}

void CheckSize(const Camera& camera, const fs::path& folder) {
  if (camera.width == kWidth && camera.height == kHeight) return;
  throw InputError(folder.string() + ": expected frames of 640x480 for fakenect, found " +
                   std::to_string(camera.width) + "x" + std::to_string(camera.height));
}

}  // namespace

FakenectDump::FakenectDump(const fs::path& folder, const Camera& camera) : folder_(folder) {
  CheckSize(camera, folder);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be made: " + error.message());
  if (fs::exists(folder / "INDEX.txt")) {
    throw InputError((folder / "INDEX.txt").string() + ": a dump is here already");
  }
}

void FakenectDump::Write(const DepthFrame& frame) {
  CheckSize(frame.camera, folder_);
  if (!HasSize(frame, kWidth, kHeight)) {
    throw InputError(folder_.string() + ": expected 640x480 depths, found " +
                     std::to_string(frame.pixel_count()));
  }
  constexpr double kStart_s = 1.0;  // fakenect takes time 0 as missing
  const double time_s = kStart_s + frame.time_s;
  if (level_.empty()) {
    const std::string name = FileName('a', time_s, "dump");
    const RawTiltState level;
    AtomicFile file(folder_ / name);
    file.stream().write(reinterpret_cast<const char*>(&level), sizeof(level));
    file.CommitOneOfMany();
    level_ = name;
  }
  const std::string name = FileName('d', time_s, "pgm");
  AtomicFile file(folder_ / name);
  file.stream() << "P5 640 480 65535\n";
  std::vector<uint16_t> scratch;
  const std::span<const uint16_t> depth_mm = PackedDepth(frame.view(), scratch);
  file.stream().write(reinterpret_cast<const char*>(depth_mm.data()),
                      static_cast<std::streamsize>(depth_mm.size_bytes()));
  file.CommitOneOfMany();
  frames_.push_back(name);
}

void FakenectDump::Finish() {
  SyncFiles(folder_);
  AtomicFile file(folder_ / "INDEX.txt");
  file.stream() << level_ << '\n';
  for (const std::string& name : frames_) file.stream() << name << '\n';
  file.Commit();
}

int64_t FakenectDump::FinishWithWhatFits() {
  while (!frames_.empty()) {
    try {
      Finish();
      return frame_count();
    } catch (const DiskFull&) {
      fs::remove(folder_ / frames_.back());
      frames_.pop_back();
    }
  }
  return 0;
}

}  // namespace ossa::depth
