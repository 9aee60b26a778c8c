// Depth files of Microsoft Research's action data sets: three counts, of frames, columns and rows,
// then 32-bit depths; in MSR Daily Activity 3D each row is followed by a byte a pixel, the user.
#include <array>
#include <cstring>
#include <fstream>
#include <optional>
#include <utility>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/base/open_file.h"
#include "depth/image/number_format.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {
namespace {

constexpr size_t kHeader = 12, kNumber = 4;  // bytes, the format's

struct Layout {
  int64_t frames = 0;
  ImageSize size;
  size_t row_bytes = 0;  // with the users

  size_t FrameBytes() const { return row_bytes * static_cast<size_t>(size.height); }
};

// The layout by the counts and the file's size, which has to be theirs to the byte.
std::optional<Layout> FindLayout(std::istream& file, uintmax_t file_bytes) {
  std::array<int32_t, 3> counts{};
  file.seekg(0);
  file.read(reinterpret_cast<char*>(counts.data()), kHeader);
  const auto [frames, width, height] = counts;
  const auto is_side = [](int32_t side) { return side >= 1 && side <= kLargestImageSide; };
  if (!file || frames < 1 || !is_side(width) || !is_side(height)) return std::nullopt;
  for (const size_t pixel : {kNumber, kNumber + 1}) {
    const Layout layout{frames, {width, height}, pixel * static_cast<size_t>(width)};
    if (kHeader + static_cast<uintmax_t>(frames) * layout.FrameBytes() == file_bytes) return layout;
  }
  return std::nullopt;
}

std::optional<Layout> FindLayout(const std::filesystem::path& path) {
  std::error_code unknown;
  const uintmax_t bytes = std::filesystem::file_size(path, unknown);
  std::ifstream file = OpenFile(path);
  return unknown ? std::nullopt : FindLayout(file, bytes);
}

class MsrDepthSource final : public FrameSource {
 public:
  MsrDepthSource(const std::filesystem::path& path, const Layout& layout,
                 const SourceOptions& options)
      : name_(path.string()), file_(OpenFile(path)), layout_(layout) {
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    camera_ = FileCamera(name_, folder, layout.size, options);
    file_.seekg(kHeader);
  }

  ReadResult Read(std::chrono::milliseconds) override {
    constexpr double kFrameRate = 30.0;  // Hz, of a Kinect; by convention
    if (next_ == layout_.frames) return {.status = ReadStatus::kEnd, .frame = {}};
    std::vector<uint8_t> bytes(layout_.FrameBytes());
    if (!file_.read(reinterpret_cast<char*>(bytes.data()),
                    static_cast<std::streamsize>(bytes.size()))) {
      throw InputError(name_ + ": cut short in frame " + std::to_string(next_));
    }
    ReadResult result{.status = ReadStatus::kFrame, .frame = {}};
    result.frame.camera = camera_;
    result.frame.index = next_;
    result.frame.time_s = static_cast<double>(next_++) / kFrameRate;
    result.frame.depth_mm = DepthsOf({NumberKind::kSigned, kNumber}, WithoutUsers(bytes), 1.0);
    return result;
  }
  const Camera& camera() const override { return camera_; }
  bool is_live() const override { return false; }
  std::optional<int64_t> frame_count() const override { return layout_.frames; }

 private:
  std::vector<uint8_t> WithoutUsers(const std::vector<uint8_t>& bytes) const {
    const size_t row = kNumber * static_cast<size_t>(layout_.size.width);
    std::vector<uint8_t> depths;
    depths.reserve(row * static_cast<size_t>(layout_.size.height));
    for (size_t at = 0; at < bytes.size(); at += layout_.row_bytes) {
      const auto begin = bytes.begin() + static_cast<ptrdiff_t>(at);
      depths.insert(depths.end(), begin, begin + static_cast<ptrdiff_t>(row));
    }
    return depths;
  }

  std::string name_;
  std::ifstream file_;
  Layout layout_;
  Camera camera_;
  int64_t next_ = 0;
};

}  // namespace

bool IsMsrDepthFile(const std::filesystem::path& path) {
  return LowerCaseExtension(path) == ".bin" && FindLayout(path).has_value();
}

std::unique_ptr<FrameSource> OpenMsrDepthFile(const std::filesystem::path& path,
                                              const SourceOptions& options) {
  const auto layout = FindLayout(path);
  if (!layout) throw InputError(path.string() + ": expected depth images of a MSR data set");
  return std::make_unique<MsrDepthSource>(path, *layout, options);
}

}  // namespace ossa::depth
