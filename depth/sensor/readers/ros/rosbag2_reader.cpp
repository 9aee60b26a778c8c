// ossa_rosbag2_reader FILE... TOPIC: writes the depth images of a ROS 2 bag, whose files (.db3 or
// .mcap) follow one another, to standard output; TOPIC "" takes the one that is named after depth
// (bag_file.h).
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/sensor/readers/reader_pipe_internal.h"
#include "depth/sensor/readers/ros/bag_file.h"
#include "depth/sensor/readers/ros/mcap_bag.h"
#include "depth/sensor/readers/ros/sqlite_bag.h"

namespace ossa::depth {
namespace {

namespace fs = std::filesystem;

// The files of one recording as one bag. Errors name the file if there are several.
class SplitBag final : public BagFile {
 public:
  explicit SplitBag(const std::vector<std::string>& paths) {
    for (const std::string& path : paths) {
      const std::string name = paths.size() > 1 ? fs::path(path).filename().string() + ": " : "";
      Naming(name, [&] {
        files_.push_back(
            {name, LowerCaseExtension(path) == ".mcap" ? OpenMcapBag(path) : OpenSqliteBag(path)});
      });
    }
  }

  std::vector<BagTopic> ListTopics() override {
    std::map<std::string, BagTopic> topics;
    for (const File& file : files_) {
      Naming(file.name, [&] {
        for (const BagTopic& topic : file.bag->ListTopics()) topics.insert({topic.name, topic});
      });
    }
    std::vector<BagTopic> listed;
    for (const auto& [name, topic] : topics) listed.push_back(topic);
    return listed;
  }

  int64_t CountMessages(const std::string& topic) override {
    int64_t count = 0;
    for (const File& file : files_) {
      Naming(file.name, [&] { count += file.bag->CountMessages(topic); });
    }
    return count;
  }

  void Read(const std::string& topic, const Take& take) override {
    bool goes_on = true;
    const Take take_until = [&](const BagMessage& message) { return goes_on = take(message); };
    for (const File& file : files_) {
      if (goes_on) Naming(file.name, [&] { file.bag->Read(topic, take_until); });
    }
  }

  std::string damage() const override {
    for (const File& file : files_) {
      if (!file.bag->damage().empty()) return file.name + file.bag->damage();
    }
    return {};
  }

 private:
  struct File {
    std::string name;
    std::unique_ptr<BagFile> bag;
  };

  template <typename Do>
  static void Naming(const std::string& name, const Do& act) {
    try {
      act();
    } catch (const InputError& error) {
      throw InputError(name + error.what());
    }
  }

  std::vector<File> files_;
};

void ReadBag(const std::vector<std::string>& paths, const std::string& topic) {
  SplitBag bag(paths);
  SendDepth(bag, topic);
}

}  // namespace
}  // namespace ossa::depth

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const std::vector<std::string> paths(argv + 1, argv + argc - 1);
  ossa::depth::RunReader([&] { ossa::depth::ReadBag(paths, argv[argc - 1]); });
}
