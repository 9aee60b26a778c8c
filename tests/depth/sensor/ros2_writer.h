#pragma once
// Bags of ROS 2 as rosbag2 writes them: an SQLite database, or an MCAP file.
#include <gtest/gtest.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include <map>
#include <string>
#include <vector>

#include "tests/depth/sensor/ros_bytes.h"

namespace ossa::test {

/// A message of a bag, one second after the one before it.
struct Ros2Message {
  std::string topic, type;
  std::vector<uint8_t> bytes;
};

inline std::vector<uint8_t> PackedByZstd(std::span<const uint8_t> bytes) {
  std::vector<uint8_t> packed(ZSTD_compressBound(bytes.size()));
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1));
  return packed;
}

inline std::vector<uint8_t> PackedByLz4(std::span<const uint8_t> bytes) {
  std::vector<uint8_t> packed(LZ4F_compressFrameBound(bytes.size(), nullptr));
  packed.resize(
      LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), nullptr));
  return packed;
}

/// Writes a .db3.
class SqliteWriter {
 public:
  explicit SqliteWriter(const std::string& path) {
    EXPECT_EQ(sqlite3_open(path.c_str(), &database_), SQLITE_OK);
    Do("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
       "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)");
    Do("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
       "timestamp INTEGER NOT NULL, data BLOB NOT NULL)");
  }
  SqliteWriter(const SqliteWriter&) = delete;
  ~SqliteWriter() { sqlite3_close(database_); }

  void Write(const std::vector<Ros2Message>& messages) {
    for (const Ros2Message& message : messages) {
      const auto [topic, is_new] = topics_.insert({message.topic, topics_.size() + 1});
      const std::string id = std::to_string(topic->second);
      if (is_new) {
        Do("INSERT INTO topics VALUES (" + id + ", '" + message.topic + "', '" + message.type +
           "', 'cdr', '')");
      }
      Do("INSERT INTO messages(topic_id, timestamp, data) VALUES (" + id + ", " +
             std::to_string(++seconds_) + "000000000, ?)",
         message.bytes);
    }
  }

 private:
  void Do(const std::string& text, std::span<const uint8_t> blob = {}) {
    sqlite3_stmt* statement = nullptr;
    ASSERT_EQ(sqlite3_prepare_v2(database_, text.c_str(), -1, &statement, nullptr), SQLITE_OK)
        << text;
    sqlite3_bind_blob(statement, 1, blob.data(), static_cast<int>(blob.size()), SQLITE_STATIC);
    EXPECT_EQ(sqlite3_step(statement), SQLITE_DONE) << text;
    sqlite3_finalize(statement);
  }

  sqlite3* database_ = nullptr;
  std::map<std::string, size_t> topics_;
  int64_t seconds_ = 0;
};

/// Layout of an .mcap.
struct McapForm {
  bool has_chunks = true, has_index = true, has_checksum = true, is_closed = true;
  std::string compression = "";  // or "lz4" or "zstd"
  std::string encoding = "cdr";  // of the messages
};

/// Writes an .mcap: each message in a chunk of its own, or none in a chunk.
class McapWriter {
 public:
  explicit McapWriter(McapForm form) : form_(std::move(form)) {}

  std::vector<uint8_t> Write(const std::vector<Ros2Message>& messages) {
    file_ = Magic();
    Put(file_, 0x01, RosBytes().AddText("ros2").AddText("test").bytes);
    for (const Ros2Message& message : messages) AddMessage(message);
    if (form_.is_closed) {
      Put(file_, 0x0F, RosBytes().Add(uint32_t{0}).bytes);
      Put(file_, 0x02, RosBytes().Add(uint64_t{0}).Add(uint64_t{0}).Add(uint32_t{0}).bytes);
      Append(file_, Magic());
    }
    return file_;
  }

 private:
  using Bytes = std::vector<uint8_t>;

  static Bytes Magic() { return {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'}; }
  static void Append(Bytes& to, std::span<const uint8_t> bytes) {
    to.insert(to.end(), bytes.begin(), bytes.end());
  }
  static void Put(Bytes& to, uint8_t kind, std::span<const uint8_t> record) {
    Append(to, RosBytes().Add(kind).Add(uint64_t{record.size()}).bytes);
    Append(to, record);
  }

  void AddMessage(const Ros2Message& message) {
    const auto [channel, is_new] =
        channels_.insert({message.topic, static_cast<uint16_t>(channels_.size() + 1)});
    const uint16_t id = channel->second;
    Bytes records;
    if (is_new) {
      Put(records, 0x03,
          RosBytes().Add(id).AddText(message.type).AddText("ros2msg").AddText("").bytes);
      Put(records, 0x04,
          RosBytes()
              .Add(id)
              .Add(id)
              .AddText(message.topic)
              .AddText(form_.encoding)
              .AddText("")
              .bytes);
    }
    const uint64_t time_ns = ++seconds_ * 1'000'000'000;
    RosBytes record;
    record.Add(id).Add(uint32_t{0}).Add(time_ns).Add(time_ns);
    Append(record.bytes, message.bytes);
    Put(records, 0x05, record.bytes);
    if (form_.has_chunks) {
      AddChunk(records, id, time_ns);
    } else {
      Append(file_, records);
    }
  }

  void AddChunk(const Bytes& records, uint16_t channel, uint64_t time_ns) {
    RosBytes chunk;
    const uint32_t checksum =
        form_.has_checksum ? static_cast<uint32_t>(crc32_z(0, records.data(), records.size())) : 0;
    chunk.Add(time_ns).Add(time_ns).Add(uint64_t{records.size()}).Add(checksum);
    chunk.AddText(form_.compression);
    const Bytes packed = form_.compression == "zstd"  ? PackedByZstd(records)
                         : form_.compression == "lz4" ? PackedByLz4(records)
                                                      : records;
    chunk.Add(uint64_t{packed.size()});
    Append(chunk.bytes, packed);
    Put(file_, 0x06, chunk.bytes);
    if (!form_.has_index) return;
    const Bytes entry = RosBytes().Add(time_ns).Add(uint64_t{0}).bytes;
    Put(file_, 0x07, RosBytes().Add(channel).AddSequence(entry).bytes);
  }

  McapForm form_;
  Bytes file_;
  std::map<std::string, uint16_t> channels_;
  uint64_t seconds_ = 0;
};

}  // namespace ossa::test
