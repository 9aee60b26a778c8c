// The text form of COLMAP's cameras, cameras.txt.
#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>
#include <string_view>

#include "depth/base/error.h"
#include "depth/image/calibration_text.h"

namespace ossa::depth {
namespace {

/// A camera model of COLMAP (src/colmap/sensor/models.h). Its parameters in order: the focal
/// lengths, cx, cy, the distortion.
struct ColmapModel {
  std::string_view name;
  size_t focal_lengths;  // 1: f; 2: fx, fy
  size_t distortion;     // number of parameters
  bool is_opencv;        // the distortion is in OpenCV's order: k1 k2 p1 p2 k3 ...
};
constexpr std::array kColmapModels = {
    ColmapModel{"SIMPLE_PINHOLE", 1, 0, true},  ColmapModel{"PINHOLE", 2, 0, true},
    ColmapModel{"SIMPLE_RADIAL", 1, 1, true},   ColmapModel{"RADIAL", 1, 2, true},
    ColmapModel{"OPENCV", 2, 4, true},          ColmapModel{"FULL_OPENCV", 2, 8, true},
    ColmapModel{"OPENCV_FISHEYE", 2, 4, false}, ColmapModel{"SIMPLE_RADIAL_FISHEYE", 1, 1, false},
    ColmapModel{"RADIAL_FISHEYE", 1, 2, false}, ColmapModel{"FOV", 2, 1, false},
};

std::vector<std::string> SplitWords(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

const ColmapModel* FindColmapModel(const std::vector<std::string>& words) {
  if (words.size() < 2 || words[0].find_first_not_of("0123456789") != std::string::npos) {
    return nullptr;
  }
  const auto found = std::find_if(kColmapModels.begin(), kColmapModels.end(),
                                  [&](const ColmapModel& model) { return model.name == words[1]; });
  return found == kColmapModels.end() ? nullptr : &*found;
}

// Width, height and parameters, behind id and model; empty if one is no number.
std::vector<double> ReadColmapNumbers(const std::vector<std::string>& words) {
  std::vector<double> numbers;
  for (size_t i = 2; i < words.size(); ++i) {
    double number = 0.0;
    const char* const end = words[i].data() + words[i].size();
    const auto [next, error] = std::from_chars(words[i].data(), end, number);
    if (error != std::errc() || next != end) return {};
    numbers.push_back(number);
  }
  return numbers;
}

Calibration ReadColmapCamera(const std::vector<std::string>& words, const ColmapModel& model,
                             const std::string& place) {
  const std::vector<double> n = ReadColmapNumbers(words);
  const size_t cx = 2 + model.focal_lengths, lens = cx + 2;
  constexpr double kAnInt = 1e9;  // pixels: a bound that fits into an int; checked later, too
  const bool is_whole = n.size() == lens + model.distortion && n[0] >= 1 && n[0] < kAnInt &&
                        n[1] >= 1 && n[1] < kAnInt;
  if (!is_whole) {
    throw InputError(place + ": expected CAMERA_ID " + std::string(model.name) +
                     " WIDTH HEIGHT and " + std::to_string(lens - 2 + model.distortion) +
                     " parameters");
  }
  // Pixels; by the file format, COLMAP's pixel centres are at halves, ours are at whole numbers.
  constexpr double kHalf = 0.5;
  Calibration found{.width = static_cast<int>(n[0]), .height = static_cast<int>(n[1])};
  found.matrix = {n[2], 0, n[cx] - kHalf, 0, n[cx - 1], n[cx + 1] - kHalf, 0, 0, 1};
  found.distortion.assign(n.begin() + static_cast<std::ptrdiff_t>(lens), n.end());
  if (!model.is_opencv) found.model = model.name;
  return found;
}

}  // namespace

std::optional<Calibration> ReadColmapCameras(const std::string& text, const std::string& name) {
  std::istringstream lines(text);
  std::optional<Calibration> found;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::vector<std::string> words = SplitWords(line);
    if (words.empty() || words[0].starts_with('#')) continue;
    const ColmapModel* const model = FindColmapModel(words);
    if (model == nullptr) return std::nullopt;
    const std::string place = name + ": line " + std::to_string(number);
    if (found) throw InputError(place + ": expected one camera, found another");
    found = ReadColmapCamera(words, *model, place);
  }
  return found;
}

}  // namespace ossa::depth
