// ossa_bag_reader FILE.bag TOPIC: writes the depth images of a ROS 1 bag to standard output; TOPIC
// "" takes the one that is named after depth (bag_file.h).
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <fstream>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "depth/base/error.h"
#include "depth/sensor/readers/reader_pipe_internal.h"
#include "depth/sensor/readers/ros/bag_file.h"

namespace ossa::depth {
namespace {

class Ros1Bag final : public BagFile {
 public:
  explicit Ros1Bag(const std::string& path) { bag_.open(path, rosbag::bagmode::Read); }

  std::vector<BagTopic> ListTopics() override {
    rosbag::View view(bag_);
    std::set<std::pair<std::string, std::string>> topics;
    for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
      topics.insert({connection->topic, connection->datatype});
    }
    std::vector<BagTopic> found;
    for (const auto& [name, type] : topics) found.push_back({name, type, RosWire::kRos1});
    return found;
  }

  int64_t CountMessages(const std::string& topic) override {
    return rosbag::View(bag_, rosbag::TopicQuery(topic)).size();
  }

  void Read(const std::string& topic, const Take& take) override {
    rosbag::View view(bag_, rosbag::TopicQuery(topic));
    std::vector<uint8_t> bytes;
    for (const rosbag::MessageInstance& message : view) {
      bytes.resize(message.size());
      ros::serialization::OStream stream(bytes.data(), static_cast<uint32_t>(bytes.size()));
      message.write(stream);
      if (!take({message.getTime().toSec(), bytes})) return;
    }
  }

 private:
  rosbag::Bag bag_;
};

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
    Ros1Bag bag(path);
    SendDepth(bag, topic);
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
