#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "depth/base/error.h"
#include "depth/image/camera_io.h"
#include "depth/image/depth_file.h"
#include "depth/sensor/folder_listing_internal.h"
#include "depth/sensor/source_internal.h"
#include "depth/sensor/stray_scanner.h"

namespace ossa::depth {
namespace {

namespace fs = std::filesystem;

// Unreadable frames, reported at the end.
struct Skipped {
  int64_t frames = 0;
  std::string first;  // error of the first one
};

class FolderSource final : public FrameSource {
 public:
  FolderSource(std::string name, FolderListing listing, const Camera& camera,
               const SourceOptions& options)
      : name_(std::move(name)),
        listing_(std::move(listing)),
        camera_(camera),
        options_(options),
        has_confidence_(HasConfidence(fs::absolute(listing_.frames.front().path).lexically_normal(),
                                      listing_.size)),
        next_number_(listing_.frames.front().number) {
    if (!has_confidence_ || !options_.note) return;
    options_.note(NoteKind::kInfo, name_ +
                                       ": readings of confidence 0, by the images in the folder "
                                       "confidence beside depth, are left out");
  }

  ReadResult Read(std::chrono::milliseconds) override {
    while (next_ < listing_.frames.size()) {
      const ListedFrame& at = listing_.frames[next_++];
      try {
        return Give(at, ReadFrame(at.path));
      } catch (const InputError& error) {
        if (skipped_.frames++ == 0) skipped_.first = error.what();
      }
    }
    TellOfSkipped();
    return {.status = ReadStatus::kEnd,
            .frame = {},
            .dropped = CountDropped(listing_.frames.back().number + 1)};
  }
  const Camera& camera() const override { return camera_; }
  bool is_live() const override { return false; }
  std::optional<int64_t> frame_count() const override {
    return static_cast<int64_t>(listing_.frames.size());
  }

 private:
  Image<uint16_t> ReadFrame(const fs::path& path) const {
    Image<uint16_t> image = ReadDepthFile(path);
    const ImageSize size{image.width, image.height};
    if (size == listing_.size) {
      if (has_confidence_) RemoveUnconfident(fs::absolute(path).lexically_normal(), image);
      return image;
    }
    throw InputError(path.string() + ": expected " + SizeText(listing_.size) +
                     " like the other frames, found " + SizeText(size));
  }

  ReadResult Give(const ListedFrame& at, Image<uint16_t> image) {
    ReadResult result{.status = ReadStatus::kFrame, .frame = {}};
    result.frame.depth_mm = std::move(image.data);
    result.frame.camera = camera_;
    result.frame.index = at.number;
    result.frame.time_s = at.time_s;
    result.dropped = CountDropped(at.number);
    return result;
  }

  // Number of frames missing since the last one.
  int64_t CountDropped(int64_t number) {
    const int64_t dropped = number - next_number_;
    next_number_ = number + 1;
    return std::max<int64_t>(dropped, 0);
  }

  void TellOfSkipped() {
    const bool is_any_read = skipped_.frames < static_cast<int64_t>(listing_.frames.size());
    if (!is_any_read) throw InputError(skipped_.first);
    if (skipped_.frames > 0 && options_.note) {
      options_.note(NoteKind::kWarning,
                    name_ + ": skipped " + std::to_string(skipped_.frames) + " of " +
                        std::to_string(listing_.frames.size()) +
                        " frames that cannot be read, the first: " + skipped_.first);
    }
    skipped_ = {};
  }

  std::string name_;
  FolderListing listing_;
  Camera camera_;
  SourceOptions options_;
  bool has_confidence_;
  size_t next_ = 0;
  Skipped skipped_;
  int64_t next_number_;  // number of the next expected frame
};

// Checks that a camera from a file fits the frame size.
Camera StatedCamera(const CameraChoice& choice, const fs::path& file, ImageSize size) {
  const Camera& camera = choice.camera;
  const bool has_size = camera.width > 0;
  if (has_size && (camera.width != size.width || camera.height != size.height)) {
    throw InputError(file.string() + ": camera: expected the frames' size " + SizeText(size) +
                     ", found " + SizeText({camera.width, camera.height}));
  }
  return CameraForSize(choice, size.width, size.height);
}

Camera ReadStatedCamera(const fs::path& file, ImageSize size, const SourceOptions& options) {
  const CameraChoice choice = ReadCameraFile(file);
  const Camera camera = StatedCamera(choice, file, size);
  if (options.note && !choice.unheeded.empty()) {
    options.note(NoteKind::kWarning, choice.unheeded);
  }
  return camera;
}

// Camera files of Open3D's recorders and of scene data sets (ScanNet, DeepDeform, 3DMatch), beside
// the images or above the depth folder, there also of Stray Scanner, and ROS's calibration beside
// the images: above, it might be a colour camera's.
std::vector<fs::path> CameraFilesOfOthers(const fs::path& folder) {
  constexpr std::array kNames = {"camera_intrinsic.json", "intrinsic.json",
                                 "intrinsic_depth.txt",   "intrinsics.txt",
                                 "camera-intrinsics.txt", "camera_intrinsics.txt"};
  const fs::path here = fs::absolute(folder).lexically_normal();
  const fs::path plain = here.has_filename() ? here : here.parent_path();
  std::vector<fs::path> files;
  for (const char* name : kNames) files.push_back(plain / name);
  files.push_back(plain / "camera_info.yaml");
  files.push_back(plain / "ost.yaml");
  if (plain.filename() != "depth") return files;
  for (const char* name : kNames) files.push_back(plain.parent_path() / name);
  files.push_back(plain.parent_path() / "intrinsic/intrinsic_depth.txt");
  files.push_back(plain.parent_path() / kScannerCameraFile);
  return files;
}

// A matrix without a size may be for larger images, such as the colour camera's.
void CheckCentre(const Camera& camera, const fs::path& file) {
  if (IsCentreNear(camera)) return;
  throw InputError(file.string() + ": its centre is not that of images of " +
                   SizeText({camera.width, camera.height}));
}

// Unrelated files of these names are ignored.
std::optional<Camera> CameraOfOthers(const fs::path& folder, ImageSize size,
                                     const SourceOptions& options) {
  for (const fs::path& file : CameraFilesOfOthers(folder)) {
    if (!fs::exists(file)) continue;
    std::string note = "its camera is used";
    std::optional<Camera> camera;
    try {
      const bool is_scanner = file.filename() == kScannerCameraFile;
      const Camera stated =
          is_scanner ? ReadScannerCamera(file, size) : ReadStatedCamera(file, size, options);
      CheckCentre(stated, file);
      camera = stated;
    } catch (const InputError& error) {
      note = std::string("ignored: ") + error.what();
    }
    if (options.note) options.note(NoteKind::kInfo, file.string() + ": " + note);
    if (camera) return camera;
  }
  return std::nullopt;
}

std::unique_ptr<FrameSource> OpenFrames(FolderListing frames, const fs::path& folder,
                                        const SourceOptions& options) {
  const Camera camera = FileCamera(folder.string(), folder, frames.size, options);
  return std::make_unique<FolderSource>(folder.string(), std::move(frames), camera, options);
}

std::unique_ptr<FrameSource> OpenDatasetFrames(FolderListing frames, const fs::path& folder,
                                               const SourceOptions& options) {
  const ImageSize size = frames.size;
  const fs::path manifest = folder / "manifest.json";
  std::optional<Camera> camera;
  if (options.camera) camera = ChosenCamera(options, size.width, size.height);
  if (!camera) camera = CameraFileIn(folder, size, options);
  if (!camera) camera = StatedCamera(ReadManifestCamera(manifest), manifest, size);
  return std::make_unique<FolderSource>(folder.string(), std::move(frames), *camera, options);
}

FolderListing OneFrame(const fs::path& image) {
  return {{{image, 0, 0.0}}, ReadDepthFileSize(image)};
}

}  // namespace

std::unique_ptr<FrameSource> OpenFolder(const fs::path& folder, const SourceOptions& options) {
  return OpenFrames(ListDepthFolder(folder, options), folder, options);
}

std::unique_ptr<FrameSource> OpenStill(const fs::path& image, const SourceOptions& options) {
  const fs::path folder = fs::absolute(image).lexically_normal().parent_path();
  const fs::path above = folder.parent_path();
  return IsDataSet(above) && folder == above / "depth"
             ? OpenDatasetFrames(OneFrame(image), above, options)
             : OpenFrames(OneFrame(image), folder, options);
}

std::optional<Camera> CameraFileIn(const fs::path& folder, ImageSize size,
                                   const SourceOptions& options) {
  const fs::path file = folder / "camera.json";
  return fs::exists(file) ? ReadStatedCamera(file, size, options)
                          : CameraOfOthers(folder, size, options);
}

Camera FileCamera(const std::string& name, const fs::path& folder, ImageSize size,
                  const SourceOptions& options) {
  if (options.camera) return ChosenCamera(options, size.width, size.height);
  const std::optional<Camera> stated =
      folder.empty() ? std::nullopt : CameraFileIn(folder, size, options);
  return stated ? *stated : CameraByImageSize(name, size.width, size.height, options);
}

bool IsCentreNear(const Camera& camera) {
  constexpr double kFarthest = 0.25;  // share of the size; by hand: cropping moves it by a tenth
  return std::abs(camera.cx / camera.width - 0.5) < kFarthest &&
         std::abs(camera.cy / camera.height - 0.5) < kFarthest;
}

bool IsDataSet(const fs::path& folder) {
  return fs::is_regular_file(folder / "manifest.json") && fs::is_directory(folder / "depth");
}

bool HoldsDepthFolder(const fs::path& folder) {
  std::error_code none;
  const fs::path depth = folder / "depth";
  if (!fs::is_directory(depth, none)) return false;
  for (fs::directory_iterator it(folder, none), end; !none && it != end; it.increment(none)) {
    if (IsDepthFileName(it->path())) return false;
  }
  const std::vector<fs::path> files = CameraFilesOfOthers(depth);
  const fs::path inside = files.front().parent_path();
  return std::any_of(files.begin(), files.end(), [&](const fs::path& file) {
    return file.parent_path() != inside && fs::is_regular_file(file, none);
  });
}

std::unique_ptr<FrameSource> OpenDataSet(const fs::path& folder, const SourceOptions& options) {
  return OpenDatasetFrames(ListDepthFolder(folder / "depth", options), folder, options);
}

}  // namespace ossa::depth
