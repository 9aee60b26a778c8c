#include <xxhash.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <memory>

#include "depth/base/error.h"
#include "depth/base/open_file.h"
#include "depth/sensor/oni_format_internal.h"
#include "depth/sensor/oni_frames_internal.h"

namespace ossa::depth {
namespace {

struct Property {
  std::string_view name;
  size_t value_at = 0;
  std::span<const uint8_t> value;
};

template <typename T>
T Load(std::span<const uint8_t> bytes, size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

// Fields of a property: name length including the final 0, name, value length, value.
std::optional<Property> ParseProperty(std::span<const uint8_t> bytes, size_t at, size_t end) {
  if (end - at < 4) return std::nullopt;
  const size_t name_size = Load<uint32_t>(bytes, at);
  if (name_size == 0 || name_size > end - at - 4 || end - at - 4 - name_size < 4) {
    return std::nullopt;
  }
  const size_t value_size = Load<uint32_t>(bytes, at + 4 + name_size);
  const size_t value_at = at + 8 + name_size;
  if (value_size > end - value_at) return std::nullopt;
  return Property{{reinterpret_cast<const char*>(bytes.data() + at + 4), name_size - 1},
                  value_at,
                  bytes.subspan(value_at, value_size)};
}

std::optional<Camera> CameraFrom(std::span<const uint8_t> value) {
  std::array<double, 6> numbers{};
  if (value.size() != sizeof(numbers)) return std::nullopt;
  std::memcpy(numbers.data(), value.data(), sizeof(numbers));
  const auto pixels = [](double side) {  // 0 for values outside int, and NaN
    return std::abs(side) < 1e9 ? static_cast<int>(side) : 0;
  };
  const Camera camera{pixels(numbers[0]), pixels(numbers[1]), numbers[2],
                      numbers[3],         numbers[4],         numbers[5]};
  return IsSane(camera) ? std::optional(camera) : std::nullopt;
}

void TakeProperty(const Property& property, OniPreamble* preamble) {
  if (property.name == kOniCameraProperty) preamble->camera = CameraFrom(property.value);
  if (property.name == kOniSealProperty && property.value.size() == sizeof(uint64_t)) {
    preamble->seal = Load<uint64_t>(property.value, 0);
    preamble->seal_at = property.value_at;
  }
}

std::vector<uint8_t> ReadStart(std::ifstream& file, size_t at_most) {
  std::vector<uint8_t> bytes(at_most);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<size_t>(file.gcount()));
  return bytes;
}

constexpr size_t kLongestPreamble = 1 << 16;  // bytes, a bound by hand; ours is under 2 kB

// Whether ossa wrote the file, by the names of our properties anywhere in its head: other damage
// must not hide it.
bool IsOurs(std::span<const uint8_t> start) {
  const std::string_view text(reinterpret_cast<const char*>(start.data()), start.size());
  return text.find(kOniCameraProperty) != text.npos || text.find(kOniSealProperty) != text.npos;
}

// Whether OniRecorder accepts such a camera.
bool IsRecordable(const std::optional<Camera>& camera) {
  return camera && int64_t{2} * camera->width * camera->height <= kLargestOniData;
}

bool SealHolds(std::ifstream& file, const OniPreamble& preamble, std::span<const uint8_t> start) {
  std::vector<uint8_t> unsealed(start.begin(),
                                start.begin() + static_cast<std::ptrdiff_t>(preamble.size));
  std::memset(unsealed.data() + preamble.seal_at, 0, sizeof(uint64_t));
  return ComputeOniSeal(file, unsealed) == *preamble.seal;
}

// The reason why a file could not be opened.
std::string ExplainFailure(const std::filesystem::path& path) {
  std::error_code unknown;
  const auto type = std::filesystem::status(path, unknown).type();
  using std::filesystem::file_type;
  if (type == file_type::not_found) return "found no file";
  if (type == file_type::regular || type == file_type::none) return "found one that cannot be read";
  return type == file_type::directory ? "found a folder" : "found a pipe or a device";
}

}  // namespace

OniPreamble ParseOniPreamble(std::span<const uint8_t> bytes) {
  OniPreamble preamble;
  size_t at = sizeof(OniFileHeader);
  while (at <= bytes.size() && bytes.size() - at >= sizeof(OniRecordHeader)) {
    const auto header = Load<OniRecordHeader>(bytes, at);
    const auto type = static_cast<OniRecord>(header.type);
    if (header.magic != OniRecordHeader::kMagic || header.fields_size < sizeof(header) ||
        header.fields_size > bytes.size() - at || type == OniRecord::kNewData) {
      break;
    }
    const size_t end = at + header.fields_size;
    if (type == OniRecord::kGeneralProperty) {
      const auto property = ParseProperty(bytes, at + sizeof(header), end);
      if (property) TakeProperty(*property, &preamble);
    }
    at = end;
    preamble.size = at;
    if (header.payload_size != 0 || type == OniRecord::kNodeDataBegin) break;
  }
  return preamble;
}

uint64_t ComputeOniSeal(std::ifstream& file, std::span<const uint8_t> unsealed) {
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(),
                                                                       XXH3_freeState);
  XXH3_64bits_reset(state.get());
  file.clear();
  file.seekg(static_cast<std::streamoff>(unsealed.size()));
  std::vector<char> buffer(1 << 20);
  while (file.read(buffer.data(), static_cast<std::streamsize>(buffer.size())), file.gcount() > 0) {
    XXH3_64bits_update(state.get(), buffer.data(), static_cast<size_t>(file.gcount()));
  }
  XXH3_64bits_update(state.get(), unsealed.data(), unsealed.size());
  return XXH3_64bits_digest(state.get());
}

OniFile CheckOniFile(const std::filesystem::path& path) {
  std::ifstream file = OpenFile(path);
  if (!file)
    throw InputError(path.string() + ": expected an .oni recording, " + ExplainFailure(path));
  std::vector<uint8_t> start = ReadStart(file, kLongestPreamble);
  if (start.size() < sizeof(OniFileHeader) || std::memcmp(start.data(), "NI10", 4) != 0) {
    throw InputError(path.string() + ": byte 0: expected an .oni recording (NI10), found " +
                     std::to_string(start.size()) + " bytes of something else");
  }
  const OniPreamble preamble = ParseOniPreamble(start);
  if (!IsOurs(start)) return {preamble.camera, std::nullopt};
  if (preamble.seal && SealHolds(file, preamble, start)) return {preamble.camera, std::nullopt};
  OniFrames frames;
  if (preamble.seal && IsRecordable(preamble.camera)) frames = FindOniFrames(file, preamble.size);
  // The recorder writes the seal last.
  const bool unsealed = frames.end == OniEnd::kWhole && preamble.seal == 0;
  if (frames.end != OniEnd::kCut && !unsealed) {
    throw InputError(path.string() + ": byte " + std::to_string(preamble.seal_at) +
                     ": checksum: the recording is damaged");
  }
  if (frames.frames.empty()) {
    throw InputError(path.string() + ": byte " + std::to_string(preamble.size) +
                     ": expected a frame, found an unfinished recording without any");
  }
  return {preamble.camera, std::move(frames.frames)};
}

}  // namespace ossa::depth
