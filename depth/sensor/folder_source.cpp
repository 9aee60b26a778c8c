#include <algorithm>
#include <vector>

#include "depth/base/error.h"
#include "depth/image/camera_io.h"
#include "depth/image/depth_png.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {
namespace {

namespace fs = std::filesystem;

constexpr double kFramePeriod_s = 1.0 / 30.0;  // folders carry no times: the Kinect's rate

struct FolderFrame {
  fs::path path;
  int64_t number = 0;  // from its name if all names are frame numbers, else its place
};

std::vector<fs::path> PngsInNameOrder(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (IsPngName(it->path())) paths.push_back(it->path());
  }
  if (error) throw InputError(folder.string() + ": cannot be read: " + error.message());
  std::sort(paths.begin(), paths.end());
  return paths;
}

// Longer digit strings are time stamps (Skeltrack's dumps), not counts of frames; nor are numbers
// that two files have (7.png and 7.PNG).
bool AreFrameNumbers(const std::vector<fs::path>& paths) {
  constexpr size_t kLongest = 8;
  const size_t length = paths.front().stem().string().size();
  const auto twice =
      std::adjacent_find(paths.begin(), paths.end(),
                         [](const fs::path& a, const fs::path& b) { return a.stem() == b.stem(); });
  return length <= kLongest && twice == paths.end() &&
         std::all_of(paths.begin(), paths.end(), [&](const fs::path& path) {
           const std::string stem = path.stem().string();
           return stem.size() == length &&
                  stem.find_first_not_of("0123456789") == std::string::npos;
         });
}

std::vector<FolderFrame> ListFrames(const fs::path& folder) {
  const std::vector<fs::path> paths = PngsInNameOrder(folder);
  if (paths.empty() && fs::is_directory(folder / "shards")) {
    throw InputError(
        folder.string() +
        ": expected a folder of 16-bit PNGs, found a packed data set, whose images are "
        "cut out around people: `ossa render --format png` or both keeps them whole");
  }
  if (paths.empty()) {
    throw InputError(folder.string() + ": expected a folder of 16-bit PNGs, found none in it");
  }
  const bool numbered = AreFrameNumbers(paths);
  std::vector<FolderFrame> frames;
  for (const fs::path& path : paths) {
    const auto place = static_cast<int64_t>(frames.size());
    frames.push_back({path, numbered ? std::stoll(path.stem().string()) : place});
  }
  return frames;
}

class FolderSource final : public FrameSource {
 public:
  FolderSource(std::vector<FolderFrame> frames, const Camera& camera)
      : frames_(std::move(frames)), camera_(camera) {}

  ReadResult Read(std::chrono::milliseconds) override {
    if (next_ == frames_.size()) return {.status = ReadStatus::kEnd, .frame = {}};
    const FolderFrame& at = frames_[next_++];
    ReadResult result{.status = ReadStatus::kFrame, .frame = {}};
    Image<uint16_t> image = ReadDepthPng(at.path);
    if (image.width != camera_.width || image.height != camera_.height) {
      throw InputError(at.path.string() + ": expected " + SizeText(camera_.width, camera_.height) +
                       " like the first frame, found " + SizeText(image.width, image.height));
    }
    result.frame.depth_mm = std::move(image.data);
    result.frame.camera = camera_;
    result.frame.index = at.number;
    result.frame.time_s = static_cast<double>(at.number - frames_[0].number) * kFramePeriod_s;
    result.dropped = last_number_ ? at.number - *last_number_ - 1 : 0;
    last_number_ = at.number;
    return result;
  }
  const Camera& camera() const override { return camera_; }
  bool is_live() const override { return false; }
  std::optional<int64_t> frame_count() const override {
    return static_cast<int64_t>(frames_.size());
  }

 private:
  static std::string SizeText(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
  }

  std::vector<FolderFrame> frames_;
  Camera camera_;
  size_t next_ = 0;
  std::optional<int64_t> last_number_;  // of the last frame given
};

// A camera that a file states must be of the size of the frames it speaks of.
Camera StatedCamera(const Camera& camera, const fs::path& file, ImageSize size) {
  if (camera.width != size.width || camera.height != size.height) {
    throw InputError(file.string() + ": camera: expected the frames' size " +
                     std::to_string(size.width) + "x" + std::to_string(size.height) + ", found " +
                     std::to_string(camera.width) + "x" + std::to_string(camera.height));
  }
  return camera;
}

std::optional<Camera> CameraJsonIn(const fs::path& folder, ImageSize size) {
  const fs::path file = folder / "camera.json";
  if (!fs::exists(file)) return std::nullopt;
  return StatedCamera(ReadCameraJson(file), file, size);
}

Camera OptionOrKinect(const SourceOptions& options, ImageSize size) {
  return options.camera ? CameraForSize(*options.camera, size.width, size.height)
                        : KinectV1Camera(size.width, size.height);
}

std::unique_ptr<FrameSource> OpenFrames(std::vector<FolderFrame> frames, const fs::path& folder,
                                        const SourceOptions& options) {
  const ImageSize size = ReadDepthPngSize(frames.front().path);
  const std::optional<Camera> stated = CameraJsonIn(folder, size);
  return std::make_unique<FolderSource>(std::move(frames),
                                        stated ? *stated : OptionOrKinect(options, size));
}

std::unique_ptr<FrameSource> OpenFramesOfSet(std::vector<FolderFrame> frames,
                                             const fs::path& folder, const SourceOptions& options) {
  const ImageSize size = ReadDepthPngSize(frames.front().path);
  const fs::path manifest = folder / "manifest.json";
  Camera camera;
  if (const std::optional<Camera> stated = CameraJsonIn(folder, size)) {
    camera = *stated;
  } else if (options.camera) {
    camera = OptionOrKinect(options, size);
  } else {
    camera = StatedCamera(ReadManifestCamera(manifest), manifest, size);
  }
  return std::make_unique<FolderSource>(std::move(frames), camera);
}

}  // namespace

std::unique_ptr<FrameSource> OpenFolder(const fs::path& folder, const SourceOptions& options) {
  return OpenFrames(ListFrames(folder), folder, options);
}

std::unique_ptr<FrameSource> OpenStill(const fs::path& png, const SourceOptions& options) {
  const fs::path folder = fs::absolute(png).parent_path();
  const fs::path above = folder.parent_path();
  return IsDataSet(above) && folder == above / "depth" ? OpenFramesOfSet({{png, 0}}, above, options)
                                                       : OpenFrames({{png, 0}}, folder, options);
}

bool IsDataSet(const fs::path& folder) {
  return fs::is_regular_file(folder / "manifest.json") && fs::is_directory(folder / "depth");
}

std::unique_ptr<FrameSource> OpenDataSet(const fs::path& folder, const SourceOptions& options) {
  return OpenFramesOfSet(ListFrames(folder / "depth"), folder, options);
}

}  // namespace ossa::depth
