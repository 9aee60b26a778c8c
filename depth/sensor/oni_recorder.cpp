// Departure: OpenNI2's own openni::Recorder is not used. It records only device streams, in real
// time, with an unbounded queue and a busy-waiting thread, corrupts values at MAX_VALUE by its
// tables, and some last pixels by the order in which it ends a frame. The container is simple;
// tests check that OpenNI2 plays ours back exactly.
#include "depth/sensor/oni_recorder.h"

#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/open_file.h"
#include "depth/image/depth_png.h"
#include "depth/image/packed_depth.h"
#include "depth/sensor/oni_codec_internal.h"
#include "depth/sensor/oni_format_internal.h"
#include "depth/sensor/sensor_clock.h"

namespace ossa::depth {
namespace {

// Constants: of OpenNI2's format.

constexpr uint32_t kDepthNode = 2;             // type of node
constexpr uint32_t kCodec16zT = 0x547a3631;    // "16zT"
constexpr uint32_t kGrey16 = 4;                // OpenNI 1's name of the pixel format
constexpr uint32_t kSupportsGrey16 = 1u << 3;  // as a bit of the supported formats
constexpr uint32_t kDepth1mm = 100;            // OpenNI 2's
constexpr uint32_t kUnknownCount = ~uint32_t{0};

using Bytes = std::vector<uint8_t>;

void AppendBytes(const void* bytes, size_t size, Bytes* out) {
  const size_t at = out->size();
  out->resize(at + size);
  if (size > 0) std::memcpy(out->data() + at, bytes, size);
}

template <typename T>
void Append(const T& value, Bytes* out) {
  AppendBytes(&value, sizeof(T), out);
}

void AppendString(const std::string& text, Bytes* out) {
  Append(static_cast<uint32_t>(text.size() + 1), out);
  AppendBytes(text.c_str(), text.size() + 1, out);
}

Bytes Record(OniRecord type, const Bytes& fields, size_t payload_size = 0, uint64_t undo = 0) {
  OniRecordHeader header;
  header.type = static_cast<uint32_t>(type);
  header.node_id = type == OniRecord::kEnd ? 0 : 1;
  header.fields_size = static_cast<uint32_t>(sizeof(header) + fields.size());
  header.payload_size = static_cast<uint32_t>(payload_size);
  header.undo_position = undo;
  Bytes record;
  Append(header, &record);
  AppendBytes(fields.data(), fields.size(), &record);
  return record;
}

Bytes Property(OniRecord type, const std::string& name, const Bytes& value) {
  Bytes fields;
  AppendString(name, &fields);
  Append(static_cast<uint32_t>(value.size()), &fields);
  AppendBytes(value.data(), value.size(), &fields);
  return Record(type, fields);
}

Bytes IntProperty(const std::string& name, uint64_t value) {
  Bytes bytes;
  Append(value, &bytes);
  return Property(OniRecord::kIntProperty, name, bytes);
}

template <typename... T>
Bytes GeneralProperty(const std::string& name, const T&... values) {
  Bytes bytes;
  (Append(values, &bytes), ...);
  return Property(OniRecord::kGeneralProperty, name, bytes);
}

// Known only at the end: the part before the first frame is written twice.
struct Totals {
  uint32_t frames = kUnknownCount;
  uint64_t last_timestamp_us = ~uint64_t{0};
  uint64_t seek_table_at = 0;
  uint64_t seal = 0;
};

Bytes NodeAdded(const Totals& totals) {
  Bytes fields;
  AppendString("Depth", &fields);
  Append(kDepthNode, &fields);
  Append(kCodec16zT, &fields);
  Append(totals.frames, &fields);
  Append(uint64_t{0}, &fields);  // first time stamp
  Append(totals.last_timestamp_us, &fields);
  Append(totals.seek_table_at, &fields);
  return Record(OniRecord::kNodeAdded, fields);
}

Bytes DeviceName() {
  std::array<char, 256> name{};  // OpenNI2's fixed length
  std::strncpy(name.data(), "ossa", name.size() - 1);
  return GeneralProperty("oniOriginalDevice", name);
}

// The properties that OpenNI2's recorder writes for a depth stream, and our two.
std::vector<Bytes> StreamProperties(const Camera& camera, int fps, const Totals& totals) {
  const auto width = static_cast<uint32_t>(camera.width);
  const auto height = static_cast<uint32_t>(camera.height);
  const auto rate = static_cast<uint32_t>(fps);
  const double horizontal_fov = 2 * std::atan(camera.width / (2 * camera.fx));
  const double vertical_fov = 2 * std::atan(camera.height / (2 * camera.fy));
  return {DeviceName(),
          IntProperty("oniRequiredFrameSize", uint64_t{width} * height * 2),
          IntProperty("xnIsGenerating", 1),
          IntProperty("xnDeviceMaxDepth", kLargestOniDepth_mm + 1u),
          IntProperty("xnSupportedMapOutputModesCount", 1),
          GeneralProperty("xnSupportedMapOutputModes", width, height, rate),
          GeneralProperty("xnMapOutputMode", width, height, rate),
          GeneralProperty("xnSupportedPixelFormats", kSupportsGrey16),
          IntProperty("xnPixelFormat", kGrey16),
          IntProperty("oniPixelFormat", kDepth1mm),
          GeneralProperty("xnFOV", horizontal_fov, vertical_fov),
          IntProperty("Cropping", 1),
          GeneralProperty("xnCropping", std::array<uint16_t, 6>{}),  // not cropped
          IntProperty("Mirror", 1),
          IntProperty("xnMirror", 0),
          GeneralProperty(kOniCameraProperty, static_cast<double>(camera.width),
                          static_cast<double>(camera.height), camera.fx, camera.fy, camera.cx,
                          camera.cy),
          GeneralProperty(kOniSealProperty, totals.seal)};
}

Bytes Preamble(const Camera& camera, int fps, const Totals& totals) {
  Bytes bytes;
  Append(OniFileHeader{}, &bytes);
  const auto add = [&](const Bytes& record) { AppendBytes(record.data(), record.size(), &bytes); };
  add(NodeAdded(totals));
  for (const Bytes& record : StreamProperties(camera, fps, totals)) add(record);
  add(Record(OniRecord::kNodeStateReady, {}));
  Bytes data_begin;
  Append(kUnknownCount, &data_begin);
  Append(~uint64_t{0}, &data_begin);
  add(Record(OniRecord::kNodeDataBegin, data_begin));
  return bytes;
}

}  // namespace

struct OniRecorder::State {
  State(const std::filesystem::path& path, const Camera& stream_camera, int fps)
      : name(path.string()), file(path), camera(stream_camera), frames_per_second(fps) {
    XXH3_64bits_reset(hash.get());
  }

  void Put(const Bytes& bytes) {
    file.stream().write(reinterpret_cast<const char*>(bytes.data()),
                        static_cast<std::streamsize>(bytes.size()));
    XXH3_64bits_update(hash.get(), bytes.data(), bytes.size());
    position += bytes.size();
    file.Check();
  }

  // Throws InputError for frames that the format cannot represent.
  Bytes Encode(const DepthFrame& frame) const {
    const std::string place = name + ": frame " + std::to_string(seek_table.size() - 1) + ": ";
    if (!HasSize(frame, camera.width, camera.height)) {
      throw InputError(place + "expected " + SizeText({camera.width, camera.height}) + ", found " +
                       SizeText({frame.camera.width, frame.camera.height}) + " and " +
                       std::to_string(frame.pixel_count()) + " depths");
    }
    std::vector<uint16_t> scratch;
    const std::span<const uint16_t> depth_mm = PackedDepth(frame.view(), scratch);
    const auto largest = std::max_element(depth_mm.begin(), depth_mm.end());
    if (largest != depth_mm.end() && *largest > kLargestOniDepth_mm) {
      throw InputError(place + "expected depths of at most " + std::to_string(kLargestOniDepth_mm) +
                       " mm, found " + std::to_string(*largest) + ", which .oni would corrupt");
    }
    Bytes data;
    if (!EncodeOniDepth(depth_mm, &data)) {
      throw InputError(place + "expected at most " + std::to_string(kLargestOniTable) +
                       " different depths, found more, which .oni would corrupt");
    }
    if (static_cast<int64_t>(data.size()) > kLargestOniData) {
      throw InputError(place + "expected depths that fit the " + std::to_string(kLargestOniData) +
                       " bytes that an OpenNI2 player has for a frame, found noise that takes " +
                       std::to_string(data.size()));
    }
    return data;
  }

  // Writes the part after the frames.
  Totals PutEnd() {
    Put(Record(OniRecord::kNodeRemoved, {}, 0, sizeof(OniFileHeader)));
    Totals totals;
    totals.frames = static_cast<uint32_t>(seek_table.size() - 1);
    totals.last_timestamp_us = seek_table.back().timestamp_us;
    const size_t table_size = seek_table.size() * sizeof(OniSeekEntry);
    if (static_cast<int64_t>(table_size) < kLargestOniData) {  // 2.6 hours; longer: no seek table
      totals.seek_table_at = position;
      Put(Record(OniRecord::kSeekTable, {}, table_size));
      const auto* entries = reinterpret_cast<const uint8_t*>(seek_table.data());
      Put(Bytes(entries, entries + table_size));
    }
    Put(Record(OniRecord::kEnd, {}));
    file.Flush();
    return totals;
  }

  void PutSealedPreamble(const Totals& totals) {
    file.stream().seekp(0);
    Put(Preamble(camera, frames_per_second, totals));
    file.Flush();
  }

  // Drops the last frames, at least `bytes` bytes.
  void Drop(uint64_t bytes) {
    for (const uint64_t end = frames_end; end - frames_end < bytes && seek_table.size() > 1;) {
      frames_end = seek_table.back().position;
      seek_table.pop_back();
    }
  }

  // Time since the first frame, strictly increasing, as the player's seek table requires.
  uint64_t ComputeTimestamp_us(const DepthFrame& frame) {
    const double time_s = clock.TimeOf(frame.time_s);
    if (seek_table.size() == 1) first_time_s = time_s;
    const double since_us = (time_s - first_time_s) * 1e6;
    const auto stamp = static_cast<uint64_t>(std::llround(since_us));
    const bool first = seek_table.size() == 1;
    return first ? 0 : std::max(stamp, seek_table.back().timestamp_us + 1);
  }

  std::string name;
  AtomicFile file;
  Camera camera;
  int frames_per_second;
  std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> hash{XXH3_createState(), XXH3_freeState};
  std::vector<OniSeekEntry> seek_table{OniSeekEntry{}};  // entry 0 is unused: frames start at 1
  SensorClock clock;
  double first_time_s = 0.0;
  uint64_t position = 0;
  uint64_t frames_end = 0;  // end of the last complete frame
};

OniRecorder::OniRecorder(const std::filesystem::path& path, const Camera& camera,
                         int frames_per_second) {
  if (int64_t{2} * camera.width * camera.height > kLargestOniData) {
    throw InputError(path.string() + ": expected frames that an OpenNI2 player can hold, found " +
                     SizeText({camera.width, camera.height}));
  }
  state_ = std::make_unique<State>(path, camera, frames_per_second);
  state_->Put(Preamble(camera, frames_per_second, {}));
  state_->file.Flush();
  XXH3_64bits_reset(state_->hash.get());  // the seal begins at the first frame
}

OniRecorder::~OniRecorder() = default;

int64_t OniRecorder::frame_count() const {
  return static_cast<int64_t>(state_->seek_table.size()) - 1;
}

void OniRecorder::Write(const DepthFrame& frame) {
  const Bytes data = state_->Encode(frame);
  const OniSeekEntry entry{state_->ComputeTimestamp_us(frame), 0, state_->position};
  Bytes fields;
  Append(entry.timestamp_us, &fields);
  Append(static_cast<uint32_t>(state_->seek_table.size()), &fields);
  state_->Put(Record(OniRecord::kNewData, fields, data.size(), state_->seek_table.back().position));
  state_->Put(data);
  state_->file.Flush();
  state_->seek_table.push_back(entry);
  state_->frames_end = state_->position;
}

void OniRecorder::Finish() {
  State& state = *state_;
  Totals totals = state.PutEnd();
  const Bytes unsealed = Preamble(state.camera, state.frames_per_second, totals);
  XXH3_64bits_update(state.hash.get(), unsealed.data(), unsealed.size());
  totals.seal = XXH3_64bits_digest(state.hash.get());
  state.PutSealedPreamble(totals);
  state.file.Commit();
}

// Space for the end part is not reserved in advance; it is made by dropping frames, on every file
// system. Other processes may take that space, so several attempts may be needed.
int64_t OniRecorder::FinishWithWhatFits() {
  State& state = *state_;
  for (uint64_t to_drop = 0;;) {
    state.Drop(to_drop);
    if (frame_count() == 0) return 0;
    try {
      state.file.CutTo(state.frames_end);
      state.position = state.frames_end;
      Totals totals = state.PutEnd();
      // The running hash includes the dropped frames.
      std::ifstream written = OpenFile(state.file.temporary_path());
      totals.seal =
          ComputeOniSeal(written, Preamble(state.camera, state.frames_per_second, totals));
      state.PutSealedPreamble(totals);
      state.file.Commit();
      return frame_count();
    } catch (const DiskFull&) {
      const uint64_t end_size = state.seek_table.size() * sizeof(OniSeekEntry);
      to_drop = std::max(2 * to_drop, end_size);
    }
  }
}

}  // namespace ossa::depth
