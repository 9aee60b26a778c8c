#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "depth/sensor/readers/ros/bag_topics.h"

namespace ossa::depth {

struct BagMessage {
  double time_s = 0.0;  // when it was recorded
  std::span<const uint8_t> bytes;
};

/// A bag of any format. All throw InputError for a damaged file.
class BagFile {
 public:
  /// Receives a message; false: no more are wanted.
  using Take = std::function<bool(const BagMessage&)>;

  virtual ~BagFile() = default;
  virtual std::vector<BagTopic> ListTopics() = 0;
  virtual int64_t CountMessages(const std::string& topic) = 0;
  /// The messages of a topic as they were recorded, one after the other.
  virtual void Read(const std::string& topic, const Take& take) = 0;
  /// What is wrong with the file although its messages are sound; "": nothing.
  virtual std::string damage() const { return {}; }
};

/// Sends the depth images of a bag and their camera to the parent (reader_pipe_internal.h).
/// `asked`: their topic; "": chosen by its name and type. Throws InputError.
void SendDepth(BagFile& bag, const std::string& asked);

}  // namespace ossa::depth
