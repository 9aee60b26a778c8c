#include "depth/sensor/xef_file.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <map>
#include <new>
#include <span>
#include <string_view>

#include "depth/base/error.h"

namespace ossa::depth {
namespace {

// Constants: the format's, as KinectXEFTools documents it.
constexpr std::string_view kMagic("EVENTS1\0", 8);
constexpr int64_t kHeaderBytes = 24;   // of the file, and of each event
constexpr int kDescriptionTag = 24;    // bytes of tag of events that describe
constexpr uint32_t kStreamName = 292;  // bytes of the event that names a stream
constexpr int64_t kExtra = 8;          // bytes behind the name of a compressed stream
constexpr int64_t kFooterBytes = 2 + 0x6B0;
constexpr uint16_t kMetadata = 0, kUnknown = 0xFFFF;  // stream indices
constexpr uint16_t kCompressed = 1;                   // stream flag
constexpr double kTick_s = 1e-7;
// {0A3914D6-3B16-11E1-AAC3-001E4FD58C0F}, "Nui Depth", as bytes.
constexpr std::array<uint8_t, 16> kDepthType = {0xd6, 0x14, 0x39, 0x0a, 0x16, 0x3b, 0xe1, 0x11,
                                                0xaa, 0xc3, 0x00, 0x1e, 0x4f, 0xd5, 0x8c, 0x0f};
// {A0C45179-5168-4875-A75C-F8F1760F637C}, "Nui Body Frame".
constexpr std::array<uint8_t, 16> kBodyType = {0x79, 0x51, 0xc4, 0xa0, 0x68, 0x51, 0x75, 0x48,
                                               0xa7, 0x5c, 0xf8, 0xf1, 0x76, 0x0f, 0x63, 0x7c};
constexpr uint32_t kImageBytes = 2 * kXefWidth * kXefHeight;
constexpr uint32_t kBodiesBytes = 32 + 6 * 1040;  // at least
constexpr uint32_t kMostBodiesBytes = 1 << 16;    // by hand: ten times as many
constexpr uint32_t kLargestEvent = 16 << 20;  // bytes, by hand: four of the colour camera's images

template <typename T>
T NumberAt(std::span<const uint8_t> bytes, size_t at) {
  static_assert(std::endian::native == std::endian::little);
  T number;
  std::memcpy(&number, &bytes[at], sizeof(T));
  return number;
}

struct Header {
  uint16_t stream = 0, flags = 0;
  uint32_t stored = 0, whole = 0;  // bytes, without the tag
  uint64_t ticks = 0;
};

struct Stream {
  uint16_t flags = 0;
  uint16_t tag = 0;                          // bytes before the data of its events
  std::vector<XefEvent>* events = nullptr;   // of depth and bodies: where they are kept
  uint32_t least = 0, most = kLargestEvent;  // bytes of an event, unpacked

  bool MayHave(const Header& event) const {
    const bool is_compressed = (event.flags & kCompressed) != 0;
    return is_compressed == ((flags & kCompressed) != 0) && event.whole >= least &&
           event.whole <= most && (is_compressed || event.stored == event.whole);
  }
};

Header ParseHeader(std::span<const uint8_t> bytes) {
  return {NumberAt<uint16_t>(bytes, 0), NumberAt<uint16_t>(bytes, 2), NumberAt<uint32_t>(bytes, 4),
          NumberAt<uint32_t>(bytes, 20), NumberAt<uint64_t>(bytes, 8)};
}

// A name of 128 UTF-16 units; other letters than ASCII's become question marks.
std::string NameOf(std::span<const uint8_t> bytes) {
  std::string name;
  for (size_t i = 0; i < 256; i += 2) {
    const auto unit = NumberAt<uint16_t>(bytes, i);
    if (unit == 0) break;
    name += unit >= ' ' && unit < 127 ? static_cast<char>(unit) : '?';
  }
  return name;
}

class IndexReader {
 public:
  IndexReader(std::istream& file, const std::string& name) : name_(name), file_(file) {
    file_.seekg(0, std::ios::end);
    size_ = static_cast<int64_t>(file_.tellg());
    const auto header = Bytes(0, kHeaderBytes);
    if (!IsXef({reinterpret_cast<const char*>(header.data()), header.size()})) {
      throw InputError(name_ + ": expected a recording of Kinect Studio");
    }
    stream_count_ = NumberAt<uint32_t>(header, 12);
  }

  XefIndex Read() {
    int64_t at = kHeaderBytes;
    while (at + kHeaderBytes <= size_) {
      if (IsFooter(at)) return std::move(index_);
      const int64_t next = TakeEvent(at);
      if (next > 0) {
        at = next;
        continue;
      }
      const bool is_expected = ParseHeader(Bytes(at, kHeaderBytes)).stream == kUnknown;
      const int64_t found = FindEvent(at + 1);
      if (!is_expected) index_.lost_bytes += found - at;
      at = found;
    }
    index_.is_cut_short = true;
    return std::move(index_);
  }

 private:
  std::vector<uint8_t> Bytes(int64_t at, int64_t count) {
    if (at + count > size_) return {};
    std::vector<uint8_t> bytes(static_cast<size_t>(count));
    file_.seekg(at);
    file_.read(reinterpret_cast<char*>(bytes.data()), count);
    if (!file_) throw InputError(name_ + ": cannot be read at byte " + std::to_string(at));
    return bytes;
  }

  // The end begins with an index after the last stream's. Archives state no number of streams.
  bool IsFooter(int64_t at) {
    const Header header = ParseHeader(Bytes(at, kHeaderBytes));
    return stream_count_ > 0 ? header.stream == stream_count_
                             : size_ - at <= kFooterBytes && EndOf(at, header) == 0;
  }
  bool IsNewStream(uint16_t index) const {
    return index != kMetadata && index != kUnknown && !streams_.contains(index) &&
           (stream_count_ == 0 || index < stream_count_);
  }

  // Its end if this can be an event; else 0.
  int64_t EndOf(int64_t at, const Header& event) const {
    const auto stream = streams_.find(event.stream);
    const bool is_described = stream != streams_.end();
    if (event.stored > kLargestEvent || event.whole > kLargestEvent) return 0;
    if (is_described && !stream->second.MayHave(event)) return 0;
    if (!is_described && event.stream != kMetadata && !IsNewStream(event.stream)) return 0;
    if (IsNewStream(event.stream) && event.stored != kStreamName) return 0;
    const int64_t tag = is_described ? stream->second.tag : kDescriptionTag;
    return at + kHeaderBytes + tag + event.stored;
  }

  // Where the next event begins; 0 if here is none.
  int64_t TakeEvent(int64_t at) {
    const Header event = ParseHeader(Bytes(at, kHeaderBytes));
    const int64_t end = EndOf(at, event);
    if (end == 0) return 0;
    if (end > size_) return end;
    if (IsNewStream(event.stream)) return end + AddStream(at, event.stream);
    const auto stream = streams_.find(event.stream);
    if (stream != streams_.end() && stream->second.events != nullptr) {
      KeepEvent(at, event, stream->second);
    }
    return end;
  }

  // Bytes behind the event that are part of the description.
  int64_t AddStream(int64_t at, uint16_t number) {
    const auto tag = Bytes(at + kHeaderBytes, kDescriptionTag + kStreamName);
    Stream stream;
    stream.flags = NumberAt<uint16_t>(tag, 2);
    stream.tag = NumberAt<uint16_t>(tag, kDescriptionTag + 258);
    const auto is_of = [&](const std::array<uint8_t, 16>& type) {
      return std::equal(type.begin(), type.end(), tag.begin() + 4);
    };
    if (is_of(kDepthType)) {
      stream.events = &index_.depth;
      stream.least = stream.most = kImageBytes;
    } else if (is_of(kBodyType)) {
      stream.events = &index_.bodies;
      stream.least = kBodiesBytes;
      stream.most = kMostBodiesBytes;
    }
    index_.streams.push_back(NameOf(std::span(tag).subspan(kDescriptionTag)));
    streams_[number] = stream;
    return (stream.flags & kCompressed) != 0 ? kExtra : 0;
  }

  void KeepEvent(int64_t at, const Header& header, const Stream& stream) {
    XefEvent event;
    event.at = at + kHeaderBytes + stream.tag;
    event.stored_bytes = header.stored;
    event.bytes = header.whole;
    event.is_compressed = (header.flags & kCompressed) != 0;
    event.time_s = static_cast<double>(header.ticks) * kTick_s;
    if (stream.tag == 4) event.number = NumberAt<uint32_t>(Bytes(at + kHeaderBytes, 4), 0);
    stream.events->push_back(event);
    last_ticks_ = header.ticks;
  }

  // Records of unknown kind and length lie between events: the next place where two events follow
  // one another, or one and the end.
  int64_t FindEvent(int64_t from) {
    constexpr int64_t kBlock = 1 << 16;  // bytes, by hand
    for (int64_t begin = from; begin + kHeaderBytes <= size_; begin += kBlock) {
      const auto block = Bytes(begin, std::min(kBlock + kHeaderBytes, size_ - begin));
      for (int64_t i = 0; i < kBlock && i + kHeaderBytes <= std::ssize(block); ++i) {
        const auto header = std::span(block).subspan(static_cast<size_t>(i), kHeaderBytes);
        if (IsEventAt(begin + i, ParseHeader(header))) {
          return begin + i;
        }
      }
    }
    return size_;
  }

  bool IsEventAt(int64_t at, const Header& event) {
    if (event.stored == 0 || event.stream == kMetadata) return false;
    int64_t end = EndOf(at, event);
    const auto stream = streams_.find(event.stream);
    const bool is_kept = stream != streams_.end() && stream->second.events != nullptr;
    if (end == 0 || (stream != streams_.end() && !IsSoonAfterTheLast(event.ticks))) return false;
    if (end > size_) return is_kept;
    if (IsNewStream(event.stream)) {
      const auto tag = Bytes(at + kHeaderBytes, 4);
      if (NumberAt<uint16_t>(tag, 0) != event.stream) return false;
      if ((NumberAt<uint16_t>(tag, 2) & kCompressed) != 0) end += kExtra;
    }
    if (end + kHeaderBytes > size_ || IsFooter(end)) return true;
    const Header next = ParseHeader(Bytes(end, kHeaderBytes));
    return next.stream == kUnknown || EndOf(end, next) > 0;
  }

  bool IsSoonAfterTheLast(uint64_t ticks) const {
    constexpr uint64_t kHour = 36'000'000'000;  // ticks
    return last_ticks_ == 0 || (ticks + kHour > last_ticks_ && ticks < last_ticks_ + kHour);
  }

  std::string name_;
  std::istream& file_;
  int64_t size_ = 0;
  uint32_t stream_count_ = 0;  // with one that is none
  uint64_t last_ticks_ = 0;    // of the last event kept; 0: none yet
  std::map<uint16_t, Stream> streams_;
  XefIndex index_;
};

// Whether the stream ends with its checksum is not documented: it is checked if it is there.
std::vector<uint8_t> Inflated(std::vector<uint8_t>& stored, uint32_t size) {
  std::vector<uint8_t> bytes(size);
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  stream.next_in = stored.data();
  stream.avail_in = static_cast<uInt>(stored.size());
  stream.next_out = bytes.data();
  stream.avail_out = size;
  const int status = inflate(&stream, Z_FINISH);
  inflateEnd(&stream);
  const bool is_whole = status == Z_STREAM_END || (status == Z_BUF_ERROR && stream.avail_in == 0);
  if (!is_whole || stream.avail_out > 0) throw InputError("its compressed bytes are damaged");
  return bytes;
}

}  // namespace

std::string XefIndex::StreamNames() const {
  std::string text;
  for (const std::string& name : streams) text.append(text.empty() ? "" : ", ").append(name);
  return text.empty() ? "none" : text;
}

bool IsXef(std::string_view head) { return head.starts_with(kMagic); }

XefIndex ReadXefIndex(std::istream& file, const std::string& name) {
  return IndexReader(file, name).Read();
}

std::vector<uint8_t> ReadXefBytes(std::istream& file, const XefEvent& event) {
  std::vector<uint8_t> stored(event.stored_bytes);
  file.clear();
  file.seekg(event.at);
  file.read(reinterpret_cast<char*>(stored.data()), static_cast<std::streamsize>(stored.size()));
  if (!file) throw InputError("cut short");
  if (!event.is_compressed) return stored;
  return Inflated(stored, event.bytes);
}

}  // namespace ossa::depth
