// ossa_bag_reader FILE.bag TOPIC: writes the depth images of a ROS 1 bag to standard output; TOPIC
// "" takes the one that is named after depth. Depths are sensor_msgs/Image of 16UC1 or mono16
// (REP 118: millimetres) or 32FC1 (metres); the RealSense viewer's bags state their unit; the
// camera is in the sensor_msgs/CameraInfo beside them.
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "depth/base/error.h"
#include "depth/sensor/readers/bag_topics.h"
#include "depth/sensor/readers/reader_pipe_internal.h"
#include "depth/sensor/readers/ros_messages.h"

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

// The first message of a topic; empty where there is none.
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

// The RealSense viewer's: metres to the unit; 0 where nothing states it.
double ReadUnit(const rosbag::Bag& bag, const std::string& topic) {
  const Bytes unit = ReadFirst(bag, topic);
  const float metres = unit.empty() ? 0.0F : ParseRosFloat(unit);
  return metres > 0 && std::isfinite(metres) ? metres : 0.0;
}

ReaderHello MakeHello(const rosbag::Bag& bag, const BagChoice& choice, const RosImage& first) {
  constexpr uint32_t kTooLarge = kLargestImageSide + 1;
  ReaderHello hello;
  hello.camera.width = static_cast<int>(std::min(first.width, kTooLarge));
  hello.camera.height = static_cast<int>(std::min(first.height, kTooLarge));
  CheckCamera(hello.camera, choice.image);
  const Bytes info = ReadFirst(bag, choice.camera_info);
  const auto k = info.empty() ? std::array<double, 9>{} : ParseRosIntrinsics(info);
  hello.is_camera_stated = k[0] != 0;
  if (hello.is_camera_stated) {
    hello.camera = {hello.camera.width, hello.camera.height, k[0], k[4], k[2], k[5]};
    CheckCamera(hello.camera, choice.camera_info);
  }
  return hello;
}

void Read(const std::string& path, const std::string& asked) {
  rosbag::Bag bag;
  bag.open(path, rosbag::bagmode::Read);
  const std::vector<BagTopic> topics = ListTopics(bag);
  const BagChoice choice = ChooseDepthTopic(DepthTopics(bag, topics), topics, asked);
  if (!choice.note.empty()) SendText(ReaderKind::kNote, choice.note);
  const Bytes first_bytes = ReadFirst(bag, choice.image);
  const RosImage first = ParseRosImage(first_bytes);
  const double unit_m = ReadUnit(bag, choice.unit);
  ReaderHello hello = MakeHello(bag, choice, first);
  hello.is_unit_stated = unit_m > 0 || ParseDepthEncoding(first) == RosDepth::kMetres;
  rosbag::View view(bag, rosbag::TopicQuery(choice.image));
  hello.frame_count = view.size();
  SendHello(hello);
  for (const rosbag::MessageInstance& message : view) {
    const Bytes bytes = ReadBytes(message);
    const RosImage image = ParseRosImage(bytes);
    if (image.width != first.width || image.height != first.height ||
        image.encoding != first.encoding) {
      throw InputError(choice.image + ": expected images that are all alike");
    }
    const double time_s = image.time_s > 0 ? image.time_s : message.getTime().toSec();
    SendFrame({hello.camera.width, hello.camera.height, time_s}, DecodeDepths(image, unit_m));
  }
}

void ReadOrExplain(const std::string& path, const std::string& topic) {
  try {
    Read(path, topic);
  } catch (const rosbag::BagUnindexedException&) {
    throw InputError(
        "expected a bag with an index, found one that was not closed: 'rosbag reindex' mends it");
  } catch (const rosbag::BagException& error) {
    throw InputError(std::string("expected a ROS 1 bag, found: ") + error.what());
  }
}

}  // namespace
}  // namespace ossa::depth

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  ossa::depth::RunReader([&] { ossa::depth::ReadOrExplain(argv[1], argv[2]); });
}
