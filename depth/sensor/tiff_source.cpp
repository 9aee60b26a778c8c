// TIFF files of several pages, an image each.
#include <utility>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/base/naming_the_file.h"
#include "depth/image/number_image_internal.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {
namespace {

class TiffSource final : public FrameSource {
 public:
  TiffSource(std::filesystem::path path, const SourceOptions& options)
      : path_(std::move(path)), pages_(path_), note_(options.note) {
    const ImageSize size = pages_.first().size;
    const std::filesystem::path folder = std::filesystem::absolute(path_).parent_path();
    camera_ = FileCamera(path_.string(), folder, size, options);
  }

  ReadResult Read(std::chrono::milliseconds) override {
    constexpr double kFrameRate = 30.0;  // Hz, of the usual depth camera; by convention
    ReadResult result{.status = ReadStatus::kFrame, .frame = {}};
    for (; pages_.Next(); ++result.dropped) {
      ++index_;
      try {
        result.frame.depth_mm = NamingTheFile(path_, [&] { return ToDepth(pages_.Read()).data; });
      } catch (const InputError& error) {
        if (damaged_++ == 0) first_damage_ = "page " + std::to_string(index_) + ": " + error.what();
        continue;
      }
      result.frame.camera = camera_;
      result.frame.index = index_;
      result.frame.time_s = static_cast<double>(index_) / kFrameRate;
      return result;
    }
    result.status = ReadStatus::kEnd;
    TellOfDamage();
    return result;
  }
  const Camera& camera() const override { return camera_; }
  bool is_live() const override { return false; }
  std::optional<int64_t> frame_count() const override { return pages_.count(); }

 private:
  void TellOfDamage() {
    const int damaged = std::exchange(damaged_, 0);
    if (damaged == pages_.count()) throw InputError(first_damage_);
    if (damaged == 0 || !note_) return;
    note_(NoteKind::kWarning, path_.string() + ": skipped " + std::to_string(damaged) + " of " +
                                  std::to_string(pages_.count()) +
                                  " pages that cannot be read, the first: " + first_damage_);
  }

  std::filesystem::path path_;
  TiffPages pages_;
  std::function<void(NoteKind, const std::string&)> note_;  // may be empty
  Camera camera_;
  int64_t index_ = -1;  // the last page's
  int damaged_ = 0;
  std::string first_damage_;
};

}  // namespace

bool HoldsSeveralPages(const std::filesystem::path& path) {
  const std::string extension = LowerCaseExtension(path);
  if (extension != ".tif" && extension != ".tiff") return false;
  try {
    const TiffPages pages(path);
    return pages.count() > 1 && pages.first().channels == 1 && HoldsDepths(pages.first().format);
  } catch (const InputError&) {  // reported when it is opened as a still
    return false;
  }
}

std::unique_ptr<FrameSource> OpenTiffPages(const std::filesystem::path& path,
                                           const SourceOptions& options) {
  return std::make_unique<TiffSource>(path, options);
}

}  // namespace ossa::depth
