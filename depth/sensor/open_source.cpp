#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/image/depth_file.h"
#include "depth/sensor/folder_listing_internal.h"
#include "depth/sensor/recording_name_internal.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {
namespace {

constexpr std::string_view kDevicePrefix = "openni:";

std::string ShortText(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

// NAME.oni, or the leftover of a killed recorder: NAME.oni.partial-...
bool IsOniName(const std::filesystem::path& path) {
  constexpr const char* kPartial = ".partial-";
  const bool is_left = path.extension().string().starts_with(kPartial);
  return LowerCaseExtension(is_left ? path.stem() : path) == ".oni";
}

std::string SizeText(const Camera& camera) {
  return depth::SizeText({camera.width, camera.height});
}

}  // namespace

const char* DescribeConversion(const std::filesystem::path& file) {
  constexpr const char* kVideo =
      "a video, which holds colours and no distances; one of 16-bit greys becomes a folder to read "
      "by 'ffmpeg -i FILE -pix_fmt gray16be FOLDER/%06d.png'";
  constexpr const char* kPacked = "a compressed file: 'zstd -d FILE' unpacks it";
  constexpr const char* kImage =
      "an image that is not read: ImageMagick's 'mogrify -format png FILE' keeps its 16 bits (of "
      "floats Python's ossa.Tracker takes whole millimetres, as uint16)";
  constexpr const char* kArray =
      "an array: Python's ossa.Tracker takes it once it is loaded, millimetres as uint16";
  constexpr const char* kRaw =
      "numbers without a header: Python's ossa.Tracker takes them, millimetres as uint16, once "
      "they are loaded: numpy.fromfile(FILE, dtype).reshape(height, width)";
  constexpr const char* kFloats =
      "an image of floats: Python's ossa.Tracker takes whole millimetres, as uint16";
  constexpr const char* kCloud = "a cloud of points, which is no image: record the depth images";
  constexpr const char* kSens =
      "a ScanNet recording: its SensReader's 'reader.py --export_depth_images "
      "--export_intrinsics' makes 16-bit PNGs of it";
  constexpr const char* kKlg =
      "a log of Kintinuous or ElasticFusion: unpack its depth images to 16-bit PNGs, which are "
      "millimetres already";
  constexpr const char* kZed = "a ZED recording: its SDK's ZED_SVO_Export makes 16-bit PNGs of it";
  using How = std::pair<std::string_view, const char*>;
  constexpr std::array kHow = {
      How{".mp4", kVideo}, How{".avi", kVideo},  How{".mov", kVideo},   How{".webm", kVideo},
      How{".m4v", kVideo}, How{".wmv", kVideo},  How{".zstd", kPacked}, How{".pkl", kArray},
      How{".raw", kRaw},   How{".bin", kRaw},    How{".exr", kFloats},  How{".ply", kCloud},
      How{".pcd", kCloud}, How{".svo", kZed},    How{".svo2", kZed},    How{".sens", kSens},
      How{".klg", kKlg},   How{".pfm", kFloats}, How{".jp2", kImage}};
  const auto found = std::find_if(
      kHow.begin(), kHow.end(),
      [extension = LowerCaseExtension(file)](const auto& how) { return how.first == extension; });
  return found == kHow.end() ? nullptr : found->second;
}

namespace {

bool IsOtherArray(const std::filesystem::path& path) {
  return LowerCaseExtension(path) == ".npy" && IsOtherImage(path);
}

// Whether the folder holds only depth images of another format: beside skeletons there may be
// videos.
bool HoldsOnlyForeignImages(const std::filesystem::path& folder) {
  bool any = false;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().filename().string().starts_with('.')) continue;
    if (!entry.is_regular_file() || DescribeConversion(entry.path()) == nullptr) return false;
    any = true;
  }
  return any;
}

}  // namespace

bool IsRecording(const std::filesystem::path& path) {
  if (IsStream(path.string())) return true;
  if (!std::filesystem::is_directory(path)) {
    const std::filesystem::path file = RecordingName(path.string()).file;
    const std::string extension = LowerCaseExtension(file);
    return IsOniName(path) || extension == ".mkv" || extension == ".xef" || IsRos1Name(file) ||
           IsRos2Bag(file) || IsDepthFileName(path) || IsArrayName(file) ||
           DescribeConversion(file) != nullptr;
  }
  const std::filesystem::directory_iterator entries(path);
  const bool has_depth = std::any_of(begin(entries), end(entries), [](const auto& entry) {
    // Beside skeletons there may be arrays of anything.
    const bool is_image = IsDepthFileName(entry.path()) && !IsOtherArray(entry.path());
    return is_image || entry.path().filename() == "depth.txt";
  });
  return has_depth || HoldsDepthFolder(path) || HoldsOnlyForeignImages(path) || IsRos2Bag(path);
}

void SourceOptions::Check() const {
  const auto require = [](const char* name, double value, bool legal, const char* expected) {
    if (legal) return;
    throw InputError("SourceOptions." + std::string(name) + ": expected " + expected + ", found " +
                     ShortText(value));
  };
  const auto is_rate = [](double value) { return std::isfinite(value) && value > 0; };
  const double scale = depth_scale.value_or(1.0), rate = fps.value_or(1.0);
  require("depth_scale", scale, is_rate(scale), "units to the metre, > 0");
  const bool reads_scale = depth_format != DepthFormat::kDisparity || !depth_scale;
  require("depth_scale", scale, reads_scale, "none with raw shifts, whose unit is known");
  require("fps", rate, is_rate(rate), "frames a second, > 0");
  require("inverted_from", inverted_from, inverted_from >= 1 && inverted_from <= 65535,
          "1 to 65535");
}

namespace {

// Notes what a camera file states beyond the camera, and warns if the images have another aspect
// ratio: then they are a crop, or of another camera.
void ReportCamera(const std::string& source, const Camera& images, const SourceOptions& options) {
  if (!options.camera || !options.note) return;
  const Camera& chosen = options.camera->camera;
  if (!options.camera->unheeded.empty()) {
    options.note(NoteKind::kWarning, options.camera->unheeded);
  }
  const int64_t across = int64_t{chosen.width} * images.height;
  const int64_t down = int64_t{chosen.height} * images.width;
  // Sizes that were halved and rounded have the same shape.
  const bool is_alike = std::abs(across - down) <= chosen.width + chosen.height;
  if (!options.camera->preset.empty() || chosen.width == 0 || is_alike) return;
  options.note(NoteKind::kWarning, source + ": the camera is stated for images of " +
                                       SizeText(chosen) + ", these are of another shape, " +
                                       SizeText(images) +
                                       ": it was stretched to them and is hardly theirs");
}

// Intrinsics in another unit than pixels, such as shares of the width, are valid numbers.
void WarnOfFieldOfView(const std::string& source, const Camera& camera,
                       const SourceOptions& options) {
  constexpr double kWidest = 0.2, kNarrowest = 10.0;  // f / longer side, by hand: 136 and 6 degrees
  const double share = camera.fx / std::max(camera.width, camera.height);
  if (!options.note || (share > kWidest && share < kNarrowest)) return;
  options.note(NoteKind::kWarning, source + ": no depth camera has f " + ShortText(camera.fx) +
                                       " px at " + SizeText(camera) +
                                       ": are its intrinsics in pixels, and of these images?");
}

// A camera chosen for larger images, such as a colour camera's, puts everybody beside the view. One
// with an image size is scaled instead.
void WarnOfCentre(const std::string& source, const Camera& camera, const SourceOptions& options) {
  if (!options.note || !options.camera || IsCentreNear(camera)) return;
  options.note(NoteKind::kWarning, source + ": the centre of the camera, " + ShortText(camera.cx) +
                                       "," + ShortText(camera.cy) + ", is not that of images of " +
                                       SizeText(camera) + ": are they cropped?");
}

std::unique_ptr<FrameSource> OpenByName(const std::string& source, const SourceOptions& options) {
  if (source.starts_with(kDevicePrefix)) {
    // OpenNI2 treats a file as a device and plays it repeatedly, with wrong times.
    const std::string uri = source.substr(kDevicePrefix.size());
    std::error_code none;
    if (std::filesystem::is_regular_file(uri, none)) return OpenByName(uri, options);
    return Prepared(source, OpenOpenNiDevice(uri, options), UnitStated::kYes, options);
  }
  const std::filesystem::path path(source);
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    if (IsDataSet(path)) {
      return Prepared(source, OpenDataSet(path, options), UnitStated::kNo, options);
    }
    if (IsRos2Bag(path)) return OpenRos2Bag(path, "", options);
    const std::filesystem::path folder = HoldsDepthFolder(path) ? path / "depth" : path;
    return Prepared(source, OpenFolder(folder, options), UnitStated::kNo, options);
  }
  if (IsOniName(path)) {
    return Prepared(source, OpenOniFile(path, options), UnitStated::kYes, options);
  }
  const auto [file, part] = RecordingName(source);
  if (std::filesystem::exists(file, error)) {
    if (LowerCaseExtension(file) == ".mkv") return OpenMkvFile(path, options);
    if (LowerCaseExtension(file) == ".xef") {
      return Prepared(source, OpenXefFile(path, options), UnitStated::kYes, options);
    }
    if (IsRos1Name(file)) return OpenBagFile(file, part, options);
    if (IsRos2Bag(file)) return OpenRos2Bag(file, part, options);
    if (IsArrayName(file)) return OpenArrayFile(file, part, options);
    if (IsMsrDepthFile(path)) {
      return Prepared(source, OpenMsrDepthFile(path, options), UnitStated::kNo, options);
    }
    if (const char* how = DescribeConversion(file)) {
      throw InputError(source + ": expected depth images, found " + how);
    }
  }
  if (IsStream(source) || HoldsSeveralPgms(path)) {
    return Prepared(source, OpenImageStream(source, options), UnitStated::kNo, options);
  }
  if (HoldsSeveralPages(path)) {
    return Prepared(source, OpenTiffPages(path, options), UnitStated::kNo, options);
  }
  if (IsDepthFileName(path) && std::filesystem::exists(path, error)) {
    return Prepared(source, OpenStill(path, options), UnitStated::kNo, options);
  }
  throw InputError(
      source +
      ": expected openni:, openni:URI, FILE.oni, FILE.xef, FILE.mkv, FILE.bag, FILE.db3, "
      "FILE.mcap, arrays (.npy, .npz, .mat, .h5), a 16-bit PNG, TIFF or PGM, a folder of them, a "
      "data set, or - (standard input), found " +
      (std::filesystem::exists(path, error) ? "a file of another name" : "no such file or folder"));
}

}  // namespace

std::unique_ptr<FrameSource> OpenSource(const std::string& source, const SourceOptions& options) {
  options.Check();
  auto opened = OpenByName(source, options);
  ReportCamera(source, opened->camera(), options);
  WarnOfFieldOfView(source, opened->camera(), options);
  WarnOfCentre(source, opened->camera(), options);
  return options.mirrored ? UnmirroredSource(std::move(opened)) : std::move(opened);
}

}  // namespace ossa::depth
