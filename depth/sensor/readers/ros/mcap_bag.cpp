#include "depth/sensor/readers/ros/mcap_bag.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "depth/base/error.h"
#include "depth/sensor/readers/ros/packed_bytes.h"
#include "depth/sensor/readers/ros/ros_fields.h"

namespace ossa::depth {
namespace {

using Bytes = std::span<const uint8_t>;

constexpr std::array<char, 8> kMagic = {'\x89', 'M', 'C', 'A', 'P', '0', '\r', '\n'};

// Kinds of records, of mcap.dev/spec.
enum Record : uint8_t {
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
};

// The numbers and texts of a record are laid out as ROS 1 has them.
RosFields FieldsOf(Bytes record) { return {record, RosWire::kRos1}; }

struct Channel {
  std::string topic;
  uint16_t schema = 0;
  std::optional<RosWire> wire;  // none: not of ROS
};

// A chunk, or a message outside of chunks.
struct Part {
  Record kind = kChunk;
  uint64_t at = 0, size = 0;                   // of its record's contents, bytes
  std::optional<std::set<uint16_t>> channels;  // none: not known
};

class Reader {
 public:
  explicit Reader(const std::string& path)
      : file_(path, std::ios::binary), size_(std::filesystem::file_size(path)) {
    std::array<char, kMagic.size()> magic{};
    file_.read(magic.data(), magic.size());
    if (file_ && magic == kMagic) return;
    throw InputError("expected an MCAP file, found " +
                     std::string(size_ == 0 ? "an empty one" : "one that begins otherwise"));
  }
  uint64_t size() const { return size_; }

  std::vector<uint8_t> ReadAt(uint64_t at, uint64_t size) {
    CheckUnpackedSize(size);
    std::vector<uint8_t> bytes(size);
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(at));
    file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (!file_) throw InputError("byte " + std::to_string(at) + ": cannot be read");
    return bytes;
  }

 private:
  std::ifstream file_;
  uint64_t size_;  // bytes
};

class McapBag final : public BagFile {
 public:
  explicit McapBag(const std::string& path) : reader_(path) {
    Scan();
    for (Part& part : parts_) Learn(part);
  }

  std::vector<BagTopic> ListTopics() override {
    std::map<std::string, BagTopic> topics;
    for (const auto& [id, channel] : channels_) {
      const std::string& type = schemas_[channel.schema];
      if (channel.wire) topics[channel.topic] = {channel.topic, type, *channel.wire};
    }
    if (topics.empty() && !damaged_chunk_.empty()) throw InputError(damaged_chunk_);
    std::vector<BagTopic> listed;
    for (const auto& [name, topic] : topics) listed.push_back(topic);
    return listed;
  }

  int64_t CountMessages(const std::string& topic) override {
    int64_t count = 0;
    for (const uint16_t id : ChannelsOf(topic)) count += counts_[id];
    return count;
  }

  void Read(const std::string& topic, const Take& take) override {
    const std::set<uint16_t> wanted = ChannelsOf(topic);
    for (const Part& part : parts_) {
      if (Holds(part, wanted) && !ReadPart(part, wanted, take)) return;
    }
  }

  std::string damage() const override { return damage_; }

 private:
  // Walks the records of the file, its summary included, without the contents of chunks.
  void Scan() {
    constexpr uint64_t kHeader = sizeof(uint8_t) + sizeof(uint64_t);
    for (uint64_t at = kMagic.size();;) {
      if (at + kHeader > reader_.size()) return NoteCut(at);
      const auto header = reader_.ReadAt(at, kHeader);
      RosFields fields = FieldsOf(header);
      const auto kind = fields.Value<uint8_t>();
      const auto size = fields.Value<uint64_t>();
      if (kind == kFooter) return;
      if (size > reader_.size() - at - kHeader) return NoteCut(at);
      ScanRecord(kind, at + kHeader, size);
      at += kHeader + size;
    }
  }

  void NoteCut(uint64_t at) {
    damage_ = "it was not closed: byte " + std::to_string(at) +
              ": expected a whole record, found the end of the file; what is before it was read";
  }

  void ScanRecord(uint8_t kind, uint64_t at, uint64_t size) {
    if (kind == kChunk) {
      parts_.push_back({kChunk, at, size, std::nullopt});
    } else if (kind == kMessage) {
      const auto id = FieldsOf(reader_.ReadAt(at, sizeof(uint16_t))).Value<uint16_t>();
      parts_.push_back({kMessage, at, size, std::set{id}});
      ++counts_[id];
    } else if (kind == kMessageIndex) {
      NoteIndex(reader_.ReadAt(at, size));
    } else if (kind == kSchema || kind == kChannel) {
      NoteType(kind, reader_.ReadAt(at, size));
    }
  }

  // An index follows its chunk, for each of its channels.
  void NoteIndex(Bytes record) {
    constexpr size_t kEntry = 2 * sizeof(uint64_t);  // time and offset
    RosFields fields = FieldsOf(record);
    const auto id = fields.Value<uint16_t>();
    const size_t count = fields.ByteSequence().size() / kEntry;
    if (parts_.empty() || parts_.back().kind != kChunk || count == 0) return;
    Part& chunk = parts_.back();
    if (!chunk.channels) chunk.channels.emplace();
    if (chunk.channels->insert(id).second) counts_[id] += static_cast<int64_t>(count);
  }

  void NoteType(uint8_t kind, Bytes record) {
    RosFields fields = FieldsOf(record);
    const auto id = fields.Value<uint16_t>();
    if (kind == kSchema) {
      schemas_[id] = Ros1TypeOf(fields.Text());
      return;
    }
    Channel channel;
    channel.schema = fields.Value<uint16_t>();
    channel.topic = fields.Text();
    const std::string encoding = fields.Text();
    if (encoding == "ros1") channel.wire = RosWire::kRos1;
    if (encoding == "cdr") channel.wire = RosWire::kCdr;
    channels_[id] = channel;
  }

  // Gives each record of a chunk's contents.
  template <typename Give>
  void ForEachRecord(Bytes contents, const Give& give) {
    RosFields fields = FieldsOf(contents);
    for (size_t left = contents.size(); left > 0;) {
      const auto kind = fields.Value<uint8_t>();
      const auto size = fields.Value<uint64_t>();
      give(kind, fields.Bytes(size));
      left -= sizeof(kind) + sizeof(size) + size;
    }
  }

  // Without an index or a summary, only the chunk itself tells what is in it. A damaged one says so
  // when it is read, after the messages before it.
  void Learn(Part& part) {
    if (part.kind == kMessage) return;
    try {
      if (!part.channels) {
        LearnChannels(part);
      } else if (HasUnknownChannel(part)) {
        LearnTypes(part);
      }
    } catch (const InputError& error) {
      part.channels.reset();
      if (damaged_chunk_.empty()) damaged_chunk_ = error.what();
    }
  }

  bool HasUnknownChannel(const Part& part) const {
    return std::any_of(part.channels->begin(), part.channels->end(),
                       [this](uint16_t id) { return !channels_.contains(id); });
  }

  void LearnTypes(const Part& chunk) {
    ForEachRecord(Unpack(chunk), [this](uint8_t kind, Bytes record) {
      if (kind == kSchema || kind == kChannel) NoteType(kind, record);
    });
  }

  void LearnChannels(Part& chunk) {
    std::set<uint16_t> found;
    ForEachRecord(Unpack(chunk), [this, &found](uint8_t kind, Bytes record) {
      if (kind == kSchema || kind == kChannel) NoteType(kind, record);
      if (kind != kMessage) return;
      const auto id = FieldsOf(record).Value<uint16_t>();
      found.insert(id);
      ++counts_[id];
    });
    chunk.channels = std::move(found);
  }

  std::set<uint16_t> ChannelsOf(const std::string& topic) const {
    std::set<uint16_t> ids;
    for (const auto& [id, channel] : channels_) {
      if (channel.topic == topic) ids.insert(id);
    }
    return ids;
  }

  static bool Holds(const Part& part, const std::set<uint16_t>& wanted) {
    return !part.channels || std::any_of(wanted.begin(), wanted.end(), [&part](uint16_t id) {
      return part.channels->contains(id);
    });
  }

  std::vector<uint8_t> Unpack(const Part& chunk) {
    const std::vector<uint8_t> record = reader_.ReadAt(chunk.at, chunk.size);
    RosFields fields = FieldsOf(record);
    fields.Values<uint64_t, 2>();  // times
    const auto size = fields.Value<uint64_t>();
    const auto checksum = fields.Value<uint32_t>();
    const std::string compression = fields.Text();
    const auto packed = fields.Bytes(fields.Value<uint64_t>());
    std::vector<uint8_t> contents = Decompress(packed, compression, size);
    if (contents.size() != size || (checksum != 0 && checksum != ChecksumOf(contents))) {
      throw InputError("byte " + std::to_string(chunk.at) + ": expected a chunk, found damage");
    }
    return contents;
  }

  static std::vector<uint8_t> Decompress(Bytes packed, const std::string& compression,
                                         uint64_t size) {
    if (compression == "zstd") return UnpackZstd(packed, size);
    if (compression == "lz4") return UnpackLz4(packed, size);
    if (compression.empty()) return {packed.begin(), packed.end()};
    throw InputError("expected chunks of lz4, zstd or plain, found '" + compression + "'");
  }

  static uint32_t ChecksumOf(Bytes bytes) {
    return static_cast<uint32_t>(crc32_z(0, bytes.data(), bytes.size()));
  }

  bool ReadPart(const Part& part, const std::set<uint16_t>& wanted, const Take& take) {
    if (part.kind == kMessage) return TakeMessage(reader_.ReadAt(part.at, part.size), take);
    bool goes_on = true;
    ForEachRecord(Unpack(part), [&](uint8_t kind, Bytes record) {
      const bool is_wanted =
          goes_on && kind == kMessage && wanted.contains(FieldsOf(record).Value<uint16_t>());
      if (is_wanted) goes_on = TakeMessage(record, take);
    });
    return goes_on;
  }

  static bool TakeMessage(Bytes record, const Take& take) {
    constexpr size_t kHeader = sizeof(uint16_t) + sizeof(uint32_t) + 2 * sizeof(uint64_t);
    RosFields fields = FieldsOf(record);
    fields.Value<uint16_t>();  // channel
    fields.Value<uint32_t>();  // sequence
    const double time_s = kSecondsPerNanosecond * static_cast<double>(fields.Value<uint64_t>());
    fields.Value<uint64_t>();  // when it was sent
    const auto bytes = fields.Bytes(record.size() - kHeader);
    return IsZstd(bytes) ? take({time_s, UnpackZstd(bytes)}) : take({time_s, bytes});
  }

  Reader reader_;
  std::vector<Part> parts_;  // in the file's order
  std::map<uint16_t, std::string> schemas_;
  std::map<uint16_t, Channel> channels_;
  std::map<uint16_t, int64_t> counts_;  // messages
  std::string damage_;
  std::string damaged_chunk_;  // what is wrong with the first that could not be learned from
};

}  // namespace

std::unique_ptr<BagFile> OpenMcapBag(const std::string& path) {
  return std::make_unique<McapBag>(path);
}

}  // namespace ossa::depth
