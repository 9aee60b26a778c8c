#include "depth/image/camera_io.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <locale>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <system_error>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/json_nesting.h"
#include "depth/base/lower_case.h"
#include "depth/base/open_file.h"
#include "depth/image/calibration_text.h"
#include "depth/image/depth_png.h"
#include "depth/image/number_image_internal.h"

namespace ossa::depth {
namespace {

using nlohmann::json;

// Manifests have a few kilobytes; larger files are something else.
constexpr std::streamoff kLargestJson = std::streamoff{16} << 20;  // bytes; chosen by hand

std::string ReadText(const std::filesystem::path& path) {
  std::ifstream file = OpenFile(path, std::ios::ate);
  if (!file) throw InputError(path.string() + ": cannot be read: expected a camera file");
  if (file.tellg() > kLargestJson) {
    throw InputError(path.string() + ": expected a small JSON file, found " +
                     std::to_string(file.tellg()) + " bytes");
  }
  std::string text(static_cast<size_t>(file.tellg()), '\0');
  file.seekg(0);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // added by editors on Windows
  if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
  return text;
}

json ParseJson(const std::string& text, const std::string& name) {
  if (JsonNesting().IsTooDeep(text)) {
    throw InputError(name + ": expected JSON that nests at most 32 deep");
  }
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    throw InputError(name + ": byte " + std::to_string(error.byte) + ": this is not JSON");
  } catch (const json::out_of_range&) {  // found by fuzzing: 640e521
    throw InputError(name + ": expected JSON numbers that a double holds");
  }
}

double Number(const json& object, const char* field, const std::string& name) {
  const auto found = object.find(field);
  if (found == object.end() || !found->is_number()) {
    throw InputError(name + ": camera: expected a number named \"" + field + "\"");
  }
  return found->get<double>();
}

int WholeNumber(const json& object, const char* field, const std::string& name) {
  // Fits into an int; image sizes are checked later, by name; pixels; a bound
  constexpr double kAnInt = 1e9;
  const double value = Number(object, field, name);
  if (value != std::floor(value) || std::abs(value) > kAnInt) {
    throw InputError(name + ": camera: \"" + field + "\": expected a whole number of pixels");
  }
  return static_cast<int>(value);
}

// Open3D's matrix: nine numbers in column-major order.
void TakeMatrix(const json& matrix, const std::string& name, Camera* camera) {
  const bool is_matrix =
      matrix.is_array() && matrix.size() == 9 &&
      std::all_of(matrix.begin(), matrix.end(), [](const json& n) { return n.is_number(); });
  if (!is_matrix) throw InputError(name + ": intrinsic_matrix: expected nine numbers");
  camera->fx = matrix[0].get<double>();
  camera->fy = matrix[4].get<double>();
  camera->cx = matrix[6].get<double>();
  camera->cy = matrix[7].get<double>();
}

Camera FromObject(const json& object, const std::string& name) {
  if (!object.is_object()) throw InputError(name + ": camera: expected a JSON object");
  Camera camera;
  camera.width = WholeNumber(object, "width", name);
  camera.height = WholeNumber(object, "height", name);
  if (object.contains("intrinsic_matrix")) {
    TakeMatrix(object["intrinsic_matrix"], name, &camera);
  } else {
    camera.fx = Number(object, "fx", name);
    camera.fy = Number(object, "fy", name);
    // RealSense tools write ppx and ppy.
    camera.cx = Number(object, object.contains("ppx") ? "ppx" : "cx", name);
    camera.cy = Number(object, object.contains("ppy") ? "ppy" : "cy", name);
  }
  CheckCamera(camera, name + ": camera");
  return camera;
}

// Warning about lens distortion, which ossa's cameras do not model; "" if it is negligible.
std::string DescribeLens(const Calibration& calibration, const std::string& name) {
  constexpr double kStrong = 0.01;  // share of the width; by hand: below other joint errors
  const double shift = ComputeCornerShift(calibration);
  const double width = calibration.width > 0 ? calibration.width : 2 * calibration.matrix[2];
  if (shift <= kStrong * width) return "";
  const std::string what = std::isfinite(shift)
                               ? "moves the image's corners by " +
                                     std::to_string(std::lround(std::min(shift, 1e6))) + " pixels"
                               : "is of the model '" + calibration.model + "'";
  return name + ": the lens " + what + ", which is not undone: undistort the images first";
}

CameraChoice ChoiceOf(const Calibration& calibration, const std::string& name) {
  const auto& m = calibration.matrix;
  Camera camera{calibration.width, calibration.height, m[0], m[4], m[2], m[5]};
  const bool has_size = camera.width > 0 && camera.height > 0;
  if (!has_size) camera.width = camera.height = 1;
  CheckCamera(camera, name + ": camera");
  if (!has_size) camera.width = camera.height = 0;
  CameraChoice choice(camera);
  choice.unheeded = DescribeLens(calibration, name);
  return choice;
}

std::vector<double> SplitNumbers(const std::string& text) {
  std::vector<double> values;
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  while (at < end) {
    double value = 0.0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value)) return {};
    values.push_back(value);
    if (next == end) return values;
    if (*next != ',' || next + 1 == end) return {};
    at = next + 1;
  }
  return values;
}

}  // namespace

Camera CameraFromJson(const std::string& text, const std::string& name) {
  return FromObject(ParseJson(text, name), name);
}

std::string CameraToJson(const Camera& camera) {
  const nlohmann::ordered_json object = {{"width", camera.width}, {"height", camera.height},
                                         {"fx", camera.fx},       {"fy", camera.fy},
                                         {"cx", camera.cx},       {"cy", camera.cy}};
  return object.dump();
}

Camera ReadCameraJson(const std::filesystem::path& path) {
  return CameraFromJson(ReadText(path), path.string());
}

bool IsCameraFile(const std::filesystem::path& path) {
  std::error_code none;
  const std::string extension = LowerCaseExtension(path);
  return extension == ".json" || extension == ".yaml" || extension == ".yml" ||
         extension == ".xml" || extension == ".txt" ||
         (!extension.empty() && std::filesystem::is_regular_file(path, none));
}

// Several arrays, of which none is known to be the matrix.
void RefuseArchive(const std::filesystem::path& path) {
  if (LowerCaseExtension(path) != ".npz") return;
  throw InputError(
      path.string() +
      ": expected one matrix, found an archive of NumPy: numpy.save('K.npy', K) writes "
      "the matrix alone");
}

// The numbers of a matrix in an .npy file, row by row, as numpy.savetxt writes them.
std::string TextOfArray(const std::string& file, const std::string& name) {
  const std::span bytes(reinterpret_cast<const uint8_t*>(file.data()), file.size());
  const NpyHeader header = ParseNpyHeader(bytes, name + ": ");
  const bool is_matrix = header.shape == std::vector<size_t>{3, 3} ||
                         header.shape == std::vector<size_t>{3, 4} ||
                         header.shape == std::vector<size_t>{4, 4};
  const size_t rows = is_matrix ? header.shape[0] : 0, columns = is_matrix ? header.shape[1] : 0;
  const size_t size = rows * columns * static_cast<size_t>(header.format.size);
  if (!is_matrix || bytes.size() < header.data_offset + size) {
    throw InputError(name + ": expected a camera matrix, 3x3, found an array of " +
                     ShapeText(header.shape));
  }
  const std::vector<double> values =
      ValuesOf(header.format, bytes.subspan(header.data_offset, size));
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(std::numeric_limits<double>::max_digits10);
  for (size_t row = 0; row < rows; ++row) {
    for (size_t column = 0; column < columns; ++column) {
      const size_t at = header.is_fortran ? column * rows + row : row * columns + column;
      text << values[at] << (column + 1 < columns ? ' ' : '\n');
    }
  }
  return text.str();
}

CameraChoice ReadCameraFile(const std::filesystem::path& path) {
  RefuseArchive(path);
  const std::string file = ReadText(path), name = path.string();
  const std::string text = file.starts_with("\x93NUMPY") ? TextOfArray(file, name) : file;
  if (const auto calibration = FindCalibration(text, name)) return ChoiceOf(*calibration, name);
  if (LowerCaseExtension(path) == ".json") return CameraFromJson(text, name);
  if (const auto camera = ReadKalibrCamera(text, name)) return ChoiceOf(*camera, name);
  if (const auto camera = ReadColmapCameras(text, name)) return ChoiceOf(*camera, name);
  if (const auto matrix = ReadBareMatrix(text)) return ChoiceOf(*matrix, name);
  if (const auto named = ReadNamedNumbers(text, name)) return ChoiceOf(*named, name);
  throw InputError(
      name +
      ": expected a camera_matrix, as OpenCV and ROS write it, or its numbers alone (fx 0 cx, 0 fy "
      "cy, 0 0 1), or "
      "fx, fy, cx and cy by name, or a camera of Kalibr or COLMAP");
}

void WriteCameraJson(const std::filesystem::path& path, const Camera& camera) {
  AtomicFile file(path);
  file.stream() << CameraToJson(camera) << '\n';
  file.Commit();
}

Camera ReadManifestCamera(const std::filesystem::path& manifest_path) {
  const std::string name = manifest_path.string();
  const json manifest = ParseJson(ReadText(manifest_path), name);
  if (!manifest.is_object() || !manifest.contains("camera")) {
    throw InputError(name + ": expected an object named \"camera\"");
  }
  return FromObject(manifest["camera"], name);
}

CameraChoice ParseCamera(const std::string& text) {
  if (IsCameraFile(text)) return ReadCameraFile(text);
  const std::vector<double> values = SplitNumbers(text);
  if (values.size() != 4) {
    PresetCamera(text, 1, 1);  // throws with the expectation unless it is a preset
    return CameraChoice(text);
  }
  Camera camera{1, 1, values[0], values[1], values[2], values[3]};
  CheckCamera(camera, "--camera");
  camera.width = camera.height = 0;  // not known yet
  return camera;
}

}  // namespace ossa::depth
