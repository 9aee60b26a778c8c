// What others' recordings say in text and messages: lists and names of frames, calibrations, ROS 1
// messages, a Matroska file's length. Any bytes are a value or an InputError of one line.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "depth/sensor/depth_list.h"
#include "depth/sensor/frame_names.h"
#include "depth/sensor/readers/k4a_calibration.h"
#include "depth/sensor/readers/matroska_length.h"
#include "depth/sensor/readers/ros_messages.h"
#include "tests/depth/sensor/mkv_writer.h"
#include "tests/depth/sensor/ros_bytes.h"
#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"
#include "tests/support/depth_examples.h"

namespace {

using namespace ossa::depth;

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char c : text) {
    if (c == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  }
  return lines;
}

// As many times as names, in order.
void CheckNames(const std::vector<std::string>& names) {
  const NamedTimes times = ReadTimesFromNames(names);
  if (times.kind == NamedTimes::Kind::kTimes && times.times_s.size() != names.size()) abort();
  if (times.kind == NamedTimes::Kind::kNumbers && times.numbers.size() != names.size()) abort();
  for (const std::string& name : names) {
    if (NaturalLess(name, name) || NaturalLess(name, names[0]) == NaturalLess(names[0], name)) {
      if (name != names[0]) abort();
    }
  }
}

void CheckList(const std::string& text) {
  for (const DepthList::Entry& entry : ParseDepthList(text).entries) {
    if (!std::isfinite(entry.time_s) || entry.file.empty()) abort();
  }
}

void CheckCameraInfo(std::span<const uint8_t> bytes) {
  const RosCameraInfo info = ParseRosCameraInfo(bytes);
  const auto camera = CameraOf(info, true, 640, 480);
  const auto lens = camera ? LensOf(info, *camera) : std::nullopt;
  if (lens) UndistortionMap(*lens);
}

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  const auto image = test::RosImageBytes("16UC1", 2, 2, {1, 2, 3, 4}, 4);
  const auto info = test::RosCameraInfoBytes(512, 424, 366);
  return {"# t f\n1305031102.175304 depth/1305031102.175304.png\n1305031102.275304 depth/b.png\n",
          "img_2\nimg_10",
          test::MkvBytes({test::ExampleFrame(0, 4, 3)}),
          "100\n200\n300",
          R"({"CalibrationInformation":{"Cameras":[{"Purpose":"CALIBRATION_CameraPurposeDepth",)"
          R"("Intrinsics":{"ModelParameters":[0.5,0.5,0.5,0.5,0.1,0,0,0,0,0,0,0,0,0]}}]}})",
          {image.begin(), image.end()},
          {info.begin(), info.end()}};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::span bytes(data, size);
  CheckList(text);
  CheckNames(LinesOf(text));
  ossa::fuzz::ExpectValueOrOneLine([&] { UndistortionMap(ReadK4aCalibration(text, 320, 288)); });
  ossa::fuzz::ExpectValueOrOneLine([&] { DecodeDepths(ParseRosImage(bytes), 0.001); });
  ossa::fuzz::ExpectValueOrOneLine([&] { CheckCameraInfo(bytes); });
  ossa::fuzz::ExpectValueOrOneLine([&] { ParseRosFloat(bytes); });
  std::istringstream file(text);
  CheckForCut(file);
  return 0;
}
