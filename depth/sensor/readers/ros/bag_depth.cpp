#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "depth/base/error.h"
#include "depth/sensor/readers/reader_pipe_internal.h"
#include "depth/sensor/readers/ros/bag_file.h"
#include "depth/sensor/readers/ros/bag_image.h"
#include "depth/sensor/readers/ros/maker_messages.h"
#include "depth/sensor/readers/stamp_order.h"

namespace ossa::depth {
namespace {

using Bytes = std::vector<uint8_t>;

// The first message of a topic; none if there is none.
std::optional<Bytes> ReadFirst(BagFile& bag, const std::string& topic) {
  std::optional<Bytes> first;
  bag.Read(topic, [&first](const BagMessage& message) {
    first = Bytes(message.bytes.begin(), message.bytes.end());
    return false;
  });
  return first;
}

bool HasDepth(BagFile& bag, const BagTopic& topic) {
  if (topic.type != "sensor_msgs/Image" && topic.type != "sensor_msgs/CompressedImage")
    return false;
  const auto first = ReadFirst(bag, topic.name);
  return first && ParseDepthEncoding(ReadBagImage(topic, *first).image) != RosDepth::kNone;
}

// A bag and what of it is read.
struct Reading {
  BagFile& bag;
  std::vector<BagTopic> topics;
  BagChoice choice;

  const BagTopic& Find(const std::string& name) const {
    return *std::find_if(topics.begin(), topics.end(),
                         [&name](const BagTopic& topic) { return topic.name == name; });
  }
  // The value of a topic's first message; T{} if there is no such topic or message.
  template <typename T>
  T First(const std::string& name, T (*read)(const BagTopic&, std::span<const uint8_t>)) const {
    const auto first = name.empty() ? std::nullopt : ReadFirst(bag, name);
    return first ? read(Find(name), *first) : T{};
  }
};

Reading ChooseTopics(BagFile& bag, const std::string& asked) {
  Reading reading{bag, bag.ListTopics(), {}};
  std::vector<std::string> depth;
  for (const BagTopic& topic : reading.topics) {
    if (HasDepth(bag, topic)) depth.push_back(topic.name);
  }
  reading.choice = ChooseDepthTopic(depth, reading.topics, asked);
  for (const std::string& note : reading.choice.notes) SendText(ReaderKind::kNote, note);
  return reading;
}

// Properties of the depth topic.
struct DepthTopic {
  ReaderHello hello;
  std::vector<int32_t> undistortion;  // pixel map to a pinhole image; empty: none needed
  double unit_m = 0.0;                // metres per unit; 0: unknown
};

bool HasRectifiedImages(const BagChoice& choice) {
  return IsRectified(WithoutTransport(choice.image));
}

// Undistortion map of raw images. The strongest distortion is Azure Kinect's: 30 pixels in the
// corners.
std::vector<int32_t> FindUndistortion(const RosCameraInfo& info, const BagChoice& choice,
                                      const Camera& camera) {
  if (!choice.is_info_own || HasRectifiedImages(choice) || !HasLens(info)) return {};
  const auto lens = LensOf(info, camera);
  SendText(ReaderKind::kNote,
           choice.camera_info + (lens ? " states a lens, which is undone"
                                      : " states a lens that is not undone, of the model '" +
                                            info.distortion_model + "'"));
  return lens ? UndistortionMap(*lens) : std::vector<int32_t>{};
}

DepthTopic MakeTopic(const Reading& reading, const RosImage& first) {
  constexpr uint32_t kTooLarge = kLargestImageSide + 1;
  const BagChoice& choice = reading.choice;
  DepthTopic topic;
  topic.unit_m = reading.First(choice.unit, ReadDepthUnit);
  ReaderHello& hello = topic.hello;
  hello.is_unit_stated = topic.unit_m > 0 || ParseDepthEncoding(first) == RosDepth::kMetres;
  hello.camera.width = static_cast<int>(std::min(first.width, kTooLarge));
  hello.camera.height = static_cast<int>(std::min(first.height, kTooLarge));
  CheckCamera(hello.camera, choice.image);
  const RosCameraInfo info = reading.First(choice.camera_info, ReadCameraInfo);
  const auto camera =
      CameraOf(info, HasRectifiedImages(choice), hello.camera.width, hello.camera.height);
  hello.is_camera_stated = camera.has_value();
  if (camera) {
    hello.camera = *camera;
    CheckCamera(hello.camera, choice.camera_info);
    topic.undistortion = FindUndistortion(info, choice, *camera);
  } else if (info.k[0] != 0) {
    SendText(ReaderKind::kNote, choice.camera_info + " is of " + std::to_string(info.width) + "x" +
                                    std::to_string(info.height) + ", another shape than " +
                                    choice.image + "'s: ignored");
  }
  topic.hello.frame_count = reading.bag.CountMessages(choice.image);
  return topic;
}

// Sends a frame and the number of frames dropped before it.
void Give(const DepthTopic& topic, const TimedDepth& frame, int64_t dropped) {
  const Camera& camera = topic.hello.camera;
  const ReaderFrame head{camera.width, camera.height, frame.time_s, dropped};
  if (topic.undistortion.empty()) return SendFrame(head, frame.depth);
  SendFrame(head, Undistorted(frame.depth, topic.undistortion));
}

void AddFrames(const Reading& reading, const RosImage& first, double unit_m, StampOrder& order) {
  const BagTopic& topic = reading.Find(reading.choice.image);
  reading.bag.Read(topic.name, [&](const BagMessage& message) {
    const BagImage read = ReadBagImage(topic, message.bytes);
    const RosImage& image = read.image;
    if (image.width != first.width || image.height != first.height ||
        image.encoding != first.encoding) {
      throw InputError(topic.name + ": expected images that are all alike");
    }
    order.Add({image.time_s > 0 ? image.time_s : message.time_s, DecodeDepths(image, unit_m)});
    return true;
  });
}

void WarnOfLateFrames(const StampOrder& order) {
  if (order.late() == 0) return;
  SendText(ReaderKind::kWarning, std::to_string(order.late()) +
                                     " frames are left out: their stamps lie before those of "
                                     "frames that came long before");
}

}  // namespace

void SendDepth(BagFile& bag, const std::string& asked) {
  const Reading reading = ChooseTopics(bag, asked);
  const std::string& image = reading.choice.image;
  const Bytes first_message = *ReadFirst(bag, image);
  const BagImage first = ReadBagImage(reading.Find(image), first_message);
  const DepthTopic topic = MakeTopic(reading, first.image);
  SendHello(topic.hello);
  StampOrder order([&](const TimedDepth& frame, int64_t dropped) { Give(topic, frame, dropped); });
  try {
    AddFrames(reading, first.image, topic.unit_m, order);
  } catch (...) {
    order.Finish();  // errors are reported after the valid frames
    throw;
  }
  order.Finish();
  WarnOfLateFrames(order);
  if (!bag.damage().empty()) SendText(ReaderKind::kWarning, bag.damage());
}

}  // namespace ossa::depth
