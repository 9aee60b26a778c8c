// ossa_bag_reader FILE.bag TOPIC: writes the depth images of a ROS 1 bag to standard output; TOPIC
// "" takes the one that is named after depth. Depths are sensor_msgs/Image of 16UC1 or mono16
// (REP 118: millimetres) or 32FC1 (metres); the RealSense viewer's bags state their unit; the
// camera is in the sensor_msgs/CameraInfo beside them.
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "depth/base/error.h"
#include "depth/sensor/readers/bag_topics.h"
#include "depth/sensor/readers/reader_pipe_internal.h"
#include "depth/sensor/readers/ros_messages.h"
#include "depth/sensor/readers/stamp_order.h"

namespace ossa::depth {
namespace {

using Bytes = std::vector<uint8_t>;

std::vector<BagTopic> ListTopics(const rosbag::Bag& bag) {
  rosbag::View view(bag);
  std::set<std::pair<std::string, std::string>> topics;
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    topics.insert({connection->topic, connection->datatype});
  }
  std::vector<BagTopic> found;
  for (const auto& [name, type] : topics) found.push_back({name, type});
  return found;
}

Bytes ReadBytes(const rosbag::MessageInstance& message) {
  Bytes bytes(message.size());
  ros::serialization::OStream stream(bytes.data(), static_cast<uint32_t>(bytes.size()));
  message.write(stream);
  return bytes;
}

// The first message of a topic; empty if there is none.
Bytes ReadFirst(const rosbag::Bag& bag, const std::string& topic) {
  if (topic.empty()) return {};
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  return view.begin() == view.end() ? Bytes{} : ReadBytes(*view.begin());
}

std::vector<std::string> DepthTopics(const rosbag::Bag& bag, const std::vector<BagTopic>& topics) {
  std::vector<std::string> depth;
  for (const BagTopic& topic : topics) {
    if (topic.type != "sensor_msgs/Image") continue;
    const Bytes first = ReadFirst(bag, topic.name);
    if (!first.empty() && ParseDepthEncoding(ParseRosImage(first)) != RosDepth::kNone) {
      depth.push_back(topic.name);
    }
  }
  return depth;
}

// Metres per unit in bags of the RealSense viewer; 0 if not stated.
double ReadUnit(const rosbag::Bag& bag, const std::string& topic) {
  const Bytes unit = ReadFirst(bag, topic);
  const float metres = unit.empty() ? 0.0F : ParseRosFloat(unit);
  return metres > 0 && std::isfinite(metres) ? metres : 0.0;
}

// Properties of the depth topic.
struct DepthTopic {
  ReaderHello hello;
  std::vector<int32_t> undistortion;  // pixel map to a pinhole image; empty: none needed
  double unit_m = 0.0;                // metres per unit; 0: unknown
};

// Undistortion map of raw images. The strongest distortion is Azure Kinect's: 30 pixels in the
// corners.
std::vector<int32_t> FindUndistortion(const RosCameraInfo& info, const BagChoice& choice,
                                      const Camera& camera) {
  if (!choice.is_info_own || IsRectified(choice.image) || !HasLens(info)) return {};
  const auto lens = LensOf(info, camera);
  SendText(ReaderKind::kNote,
           choice.camera_info + (lens ? " states a lens, which is undone"
                                      : " states a lens that is not undone, of the model '" +
                                            info.distortion_model + "'"));
  return lens ? UndistortionMap(*lens) : std::vector<int32_t>{};
}

DepthTopic MakeTopic(const rosbag::Bag& bag, const BagChoice& choice, const RosImage& first) {
  constexpr uint32_t kTooLarge = kLargestImageSide + 1;
  DepthTopic topic;
  topic.unit_m = ReadUnit(bag, choice.unit);
  ReaderHello& hello = topic.hello;
  hello.is_unit_stated = topic.unit_m > 0 || ParseDepthEncoding(first) == RosDepth::kMetres;
  hello.camera.width = static_cast<int>(std::min(first.width, kTooLarge));
  hello.camera.height = static_cast<int>(std::min(first.height, kTooLarge));
  CheckCamera(hello.camera, choice.image);
  const Bytes bytes = ReadFirst(bag, choice.camera_info);
  const RosCameraInfo info = bytes.empty() ? RosCameraInfo{} : ParseRosCameraInfo(bytes);
  const auto camera =
      CameraOf(info, IsRectified(choice.image), hello.camera.width, hello.camera.height);
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
  return topic;
}

// Sends a frame and the number of frames dropped before it.
void Give(const DepthTopic& topic, const TimedDepth& frame, int64_t dropped) {
  const Camera& camera = topic.hello.camera;
  const ReaderFrame head{camera.width, camera.height, frame.time_s, dropped};
  if (topic.undistortion.empty()) return SendFrame(head, frame.depth);
  SendFrame(head, Undistorted(frame.depth, topic.undistortion));
}

void AddFrames(rosbag::View& view, const std::string& name, const RosImage& first, double unit_m,
               StampOrder& order) {
  for (const rosbag::MessageInstance& message : view) {
    const Bytes bytes = ReadBytes(message);
    const RosImage image = ParseRosImage(bytes);
    if (image.width != first.width || image.height != first.height ||
        image.encoding != first.encoding) {
      throw InputError(name + ": expected images that are all alike");
    }
    const double time_s = image.time_s > 0 ? image.time_s : message.getTime().toSec();
    order.Add({time_s, DecodeDepths(image, unit_m)});
  }
}

void Read(const std::string& path, const std::string& asked) {
  rosbag::Bag bag;
  bag.open(path, rosbag::bagmode::Read);
  const std::vector<BagTopic> topics = ListTopics(bag);
  const BagChoice choice = ChooseDepthTopic(DepthTopics(bag, topics), topics, asked);
  for (const std::string& note : choice.notes) SendText(ReaderKind::kNote, note);
  const Bytes first_bytes = ReadFirst(bag, choice.image);
  const RosImage first = ParseRosImage(first_bytes);
  DepthTopic topic = MakeTopic(bag, choice, first);
  rosbag::View view(bag, rosbag::TopicQuery(choice.image));
  topic.hello.frame_count = view.size();
  SendHello(topic.hello);
  StampOrder order([&](const TimedDepth& frame, int64_t dropped) { Give(topic, frame, dropped); });
  try {
    AddFrames(view, choice.image, first, topic.unit_m, order);
  } catch (...) {
    order.Finish();  // errors are reported after the valid frames
    throw;
  }
  order.Finish();
  if (order.late() > 0) {
    SendText(ReaderKind::kWarning, std::to_string(order.late()) +
                                       " frames are left out: their stamps lie before those of "
                                       "frames that came long before");
  }
}

// Else rosbag calls any file that begins otherwise one that is cut short.
void CheckIsBag(const std::string& path) {
  constexpr std::string_view kMagic =
      "#ROS";  // of every version: "#ROSBAG V2.0", "#ROSRECORD V1.2"
  std::ifstream file(path, std::ios::binary);
  std::string head(kMagic.size(), '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<size_t>(file.gcount()));
  if (head == kMagic) return;
  throw InputError("expected a ROS 1 bag, which begins with #ROSBAG, found " +
                   (head.empty() ? std::string("an empty file") : "a file that begins otherwise"));
}

// ROS itself reads no LZ4 blocks that refer to those before them: PyPI's rosbags 0.11 writes such.
std::string AdviceOnLz4(std::string_view what) {
  if (what.find("ROSLZ4") == what.npos) return {};
  return ": damaged, or chunks of LZ4 that ROS does not read either, as PyPI's rosbags writes "
         "them: "
         "written again with bz2 or without compression they are read";
}

void ReadOrExplain(const std::string& path, const std::string& topic) {
  CheckIsBag(path);
  try {
    Read(path, topic);
  } catch (const rosbag::BagUnindexedException&) {
    throw InputError(
        "expected a bag with an index, found one that was not closed: 'rosbag reindex' mends it");
  } catch (const rosbag::BagIOException& error) {
    throw InputError(std::string("expected a whole ROS 1 bag, found one that is cut short (") +
                     error.what() + "): 'rosbag reindex' saves what is there");
  } catch (const rosbag::BagException& error) {
    throw InputError(std::string("expected a ROS 1 bag, found: ") + error.what() +
                     AdviceOnLz4(error.what()));
  }
}

}  // namespace
}  // namespace ossa::depth

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  ossa::depth::RunReader([&] { ossa::depth::ReadOrExplain(argv[1], argv[2]); });
}
