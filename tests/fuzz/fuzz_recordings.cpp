// What others' recordings say in text and messages: lists and names of frames, calibrations, ROS
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
#include "depth/sensor/readers/ros/bag_image.h"
#include "depth/sensor/readers/ros/maker_messages.h"
#include "depth/sensor/readers/ros/ros_messages.h"
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

void CheckCameraInfo(const RosCameraInfo& info) {
  const auto camera = CameraOf(info, true, 640, 480);
  const auto lens = camera ? LensOf(info, *camera) : std::nullopt;
  if (lens) UndistortionMap(*lens);
}

// Messages of each type that a topic may have.
void CheckMessages(std::span<const uint8_t> bytes, RosWire wire) {
  for (const char* type : {"sensor_msgs/Image", "sensor_msgs/CompressedImage"}) {
    ossa::fuzz::ExpectValueOrOneLine([&] {
      const BagImage read = ReadBagImage({"/depth", type, wire}, bytes);
      if (ParseDepthEncoding(read.image) != RosDepth::kNone) DecodeDepths(read.image, 0.001);
    });
  }
  for (const char* type :
       {"sensor_msgs/CameraInfo", "custom_msg/OBStreamProfileInfo", "std_msgs/String"}) {
    ossa::fuzz::ExpectValueOrOneLine([&] {
      CheckCameraInfo(ReadCameraInfo({"/camera_info", type, wire}, bytes));
    });
  }
  for (const char* type : {"std_msgs/Float32", "std_msgs/String"}) {
    ossa::fuzz::ExpectValueOrOneLine([&] { ReadDepthUnit({"/unit", type, wire}, bytes); });
  }
}

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  constexpr auto kCdr = RosWire::kCdr;
  const auto image2 = test::RosImageBytes("16UC1", 2, 2, {1, 2, 3, 4}, 4, false, 1, kCdr);
  const std::vector<uint8_t> rvl = {0,    0,    0,    0,    0,    0,    0,    0,   0, 0,
                                    0,    0,    6,    0,    0,    0,    1,    0,   0, 0,
                                    0xC2, 0xF3, 0x8A, 0x23, 0x00, 0x00, 0x10, 0xD3};
  const auto packed = test::RosBytes(kCdr)
                          .AddHeader(1, 2)
                          .AddText("16UC1; compressedDepth rvl")
                          .AddSequence(rvl)
                          .bytes;
  const auto intrinsics =
      test::RosBytes(kCdr).AddText("width=4;height=3;fx=5;fy=5;ppx=2;ppy=1;coeffs=1,2").bytes;
  const auto image = test::RosImageBytes("16UC1", 2, 2, {1, 2, 3, 4}, 4);
  const auto info = test::RosCameraInfoBytes(512, 424, 366);
  return {"# t f\n1305031102.175304 depth/1305031102.175304.png\n1305031102.275304 depth/b.png\n",
          "img_2\nimg_10",
          test::MkvBytes({test::ExampleFrame(0, 4, 3)}),
          "100\n200\n300",
          R"({"CalibrationInformation":{"Cameras":[{"Purpose":"CALIBRATION_CameraPurposeDepth",)"
          R"("Intrinsics":{"ModelParameters":[0.5,0.5,0.5,0.5,0.1,0,0,0,0,0,0,0,0,0]}}]}})",
          {image.begin(), image.end()},
          {image2.begin(), image2.end()},
          {packed.begin(), packed.end()},
          {intrinsics.begin(), intrinsics.end()},
          {info.begin(), info.end()}};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::span bytes(data, size);
  CheckList(text);
  CheckNames(LinesOf(text));
  ossa::fuzz::ExpectValueOrOneLine([&] { UndistortionMap(ReadK4aCalibration(text, 320, 288)); });
  CheckMessages(bytes, RosWire::kRos1);
  CheckMessages(bytes, RosWire::kCdr);
  std::istringstream file(text);
  CheckForCut(file);
  return 0;
}
