#include "depth/image/calibration_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"

namespace ossa::depth {
namespace {

constexpr std::string_view kBetween = " \t\r\n,;[]";  // separators of a matrix's numbers

bool EndsWord(std::string_view text, size_t at) {
  constexpr std::string_view kWordEnds = " \t\r\n,;[]<>:{}\"";
  return at >= text.size() || kWordEnds.find(text[at]) != std::string_view::npos;
}

// The numbers up to the first other text. A dash before a blank starts an entry of a YAML list.
std::vector<double> ReadNumbers(std::string_view text) {
  std::vector<double> numbers;
  for (size_t at = 0; at < text.size();) {
    const bool is_entry = text[at] == '-' && EndsWord(text, at + 1);
    if (is_entry || kBetween.find(text[at]) != std::string_view::npos) {
      ++at;
      continue;
    }
    double number = 0.0;
    const char* const begin = text.data() + at;
    const auto [end, error] = std::from_chars(begin, text.data() + text.size(), number);
    at += static_cast<size_t>(end - begin);
    if (error != std::errc() || !EndsWord(text, at)) break;
    numbers.push_back(number);
  }
  return numbers;
}

// Position of the value of a key: key: ..., "key": ..., <key> or <key type_id="...">. YAML keys
// count only at the start of a line: others belong to a matrix.
size_t FindValue(std::string_view text, std::string_view key) {
  for (size_t at = text.find(key); at != text.npos; at = text.find(key, at + 1)) {
    const size_t end = at + key.size();
    const char before = at == 0 ? '\n' : text[at - 1];
    const char after = end < text.size() ? text[end] : '\n';
    if (before == '\n' && after == ':') return end + 1;
    if (before == '<' && (after == '>' || after == ' ')) return text.find('>', end) + 1;
    const bool is_quoted = before == '"' && after == '"';
    const size_t colon = is_quoted ? text.find_first_not_of(" \t\r\n", end + 1) : text.npos;
    if (colon != text.npos && text[colon] == ':') return colon + 1;
  }
  return text.npos;
}

// The value up to the end of its tag, its JSON object, or the next YAML line that is not indented.
std::string_view ValueFrom(std::string_view text, size_t begin, std::string_view key) {
  const std::string_view rest = text.substr(begin);
  const size_t tag = rest.find("</" + std::string(key) + ">");
  if (tag != rest.npos) return rest.substr(0, tag);
  const size_t first = rest.find_first_not_of(" \t\r\n");
  if (first != rest.npos && rest[first] == '{') return rest.substr(0, rest.find('}'));
  for (size_t line = rest.find('\n'); line != rest.npos; line = rest.find('\n', line + 1)) {
    const std::string_view next = rest.substr(line + 1);
    const bool is_key = !next.empty() && std::string_view(" \t\r\n-]").find(next[0]) == next.npos;
    if (is_key) return rest.substr(0, line);
  }
  return rest;
}

std::optional<std::string_view> Value(std::string_view text,
                                      std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys) {
    const size_t begin = FindValue(text, key);
    if (begin != text.npos) return ValueFrom(text, begin, key);
  }
  return std::nullopt;
}

std::vector<double> NumbersOf(std::string_view value) {
  const size_t first = value.find_first_not_of(" \t\r\n");
  const bool is_bare =
      first != value.npos &&
      std::string_view("[-.0123456789").find(value[first]) != std::string_view::npos;
  if (is_bare) return ReadNumbers(value);
  for (const std::string_view data : {"data:", "\"data\":", "<data>"}) {
    const size_t at = value.find(data);
    if (at != value.npos) return ReadNumbers(value.substr(at + data.size()));
  }
  return ReadNumbers(value);
}

int SideOf(std::optional<std::string_view> value, const std::string& name) {
  if (!value) return 0;
  constexpr double kAnInt =
      1e9;  // pixels: a bound that fits into an int; larger images are refused later
  const std::vector<double> numbers = NumbersOf(*value);
  if (numbers.empty() || !(numbers[0] >= 1 && numbers[0] < kAnInt) ||
      numbers[0] != std::floor(numbers[0])) {
    throw InputError(name + ": expected the image's width and height in whole pixels");
  }
  return static_cast<int>(numbers[0]);
}

std::string WordOf(std::optional<std::string_view> value) {
  if (!value) return "";
  constexpr std::string_view kAround = " \t\r\n\"',";
  const size_t begin = value->find_first_not_of(kAround);
  if (begin == value->npos) return "";
  return std::string(value->substr(begin, value->find_first_of(kAround, begin) - begin));
}

// Displacement of a ray x, y by OpenCV's distortion (cv::projectPoints).
std::array<double, 2> ComputeShift(const std::vector<double>& k, double x, double y) {
  const double r2 = x * x + y * y;
  const double factor =
      (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
  return {x * (factor - 1) + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x),
          y * (factor - 1) + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y};
}

bool IsFisheye(const std::string& model) {
  const std::string name = LowerCase(model);
  constexpr std::array kNames = {"fisheye", "equi", "fov", "kannala"};  // of ROS, Kalibr, COLMAP
  return std::any_of(kNames.begin(), kNames.end(),
                     [&](const char* part) { return name.find(part) != name.npos; });
}

// Nine numbers in row-major order, from row-major (OpenCV, ROS) or column-major order (MATLAB,
// Record3D): the principal point is in the last column or in the last row.
std::array<double, 9> RowByRow(const std::vector<double>& n) {
  const bool is_by_columns = n[2] == 0 && n[5] == 0 && (n[6] != 0 || n[7] != 0);
  if (is_by_columns) return {n[0], n[3], n[6], n[1], n[4], n[7], n[2], n[5], n[8]};
  return {n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8]};
}

// The numbers of the matrix in a text. It may be called "intrinsics", which may also be something
// else.
std::optional<std::vector<double>> FindMatrix(std::string_view text, const std::string& name) {
  const auto matrix = Value(text, {"camera_matrix", "cameraMatrix", "CameraMatrix", "K", "k"});
  if (!matrix) {
    const auto other = Value(text, {"intrinsics", "intrinsic", "Intrinsics"});
    std::vector<double> numbers = other ? NumbersOf(*other) : std::vector<double>();
    return numbers.size() == 9 ? std::optional(std::move(numbers)) : std::nullopt;
  }
  std::vector<double> numbers = NumbersOf(*matrix);
  if (numbers.size() != 9) {
    throw InputError(name + ": expected nine numbers of a camera matrix, found " +
                     std::to_string(numbers.size()));
  }
  return numbers;
}

// A line `Camera.fx: 525.0`, `fx = 525` or `fx 525`: the name behind its last point, lower case,
// and the number.
std::optional<std::pair<std::string, double>> ReadNamedNumber(std::string_view line) {
  constexpr std::string_view kAround = " \t\r\"'", kEnds = " \t:=\"'";
  line.remove_prefix(std::min(line.find_first_not_of(kAround), line.size()));
  std::string_view name = line.substr(0, line.find_first_of(kEnds));
  line.remove_prefix(name.size());
  line.remove_prefix(std::min(line.find_first_not_of(kEnds), line.size()));
  name = name.substr(name.rfind('.') + 1);
  const std::vector<double> numbers = ReadNumbers(line);
  if (name.empty() || numbers.size() != 1) return std::nullopt;
  return std::pair{LowerCase(name), numbers.front()};
}

// The YAML blocks `NAME:` with indented lines, without the indentation.
std::vector<std::string> SplitBlocks(const std::string& text) {
  std::vector<std::string> blocks;
  size_t indent = 0;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    const size_t blanks = std::min(line.find_first_not_of(' '), line.size());
    if (blanks == 0) {
      blocks.emplace_back();
      indent = 0;
    } else if (!blocks.empty()) {
      if (indent == 0) indent = blanks;
      blocks.back().append(line.substr(std::min(indent, blanks))) += '\n';
    }
    begin = end + 1;
  }
  return blocks;
}

std::optional<Calibration> ReadCameraModel(const std::string& block, const std::string& name) {
  const auto model = Value(block, {"camera_model"});
  const auto intrinsics = Value(block, {"intrinsics"});
  if (!model || !intrinsics) return std::nullopt;
  const std::vector<double> n = NumbersOf(*intrinsics);
  if (WordOf(model) != "pinhole" || n.size() != 4) {
    throw InputError(name + ": expected camera_model pinhole and four intrinsics, found " +
                     WordOf(model) + " and " + std::to_string(n.size()));
  }
  Calibration found{.matrix = {n[0], 0, n[2], 0, n[1], n[3], 0, 0, 1}};
  if (const auto size = Value(block, {"resolution"})) {
    const std::vector<double> sides = NumbersOf(*size);
    found.width = SideOf(size, name);
    found.height = SideOf(sides.size() == 2 ? std::to_string(sides[1]) : std::string(), name);
  }
  if (const auto lens = Value(block, {"distortion_coeffs", "distortion_coefficients"})) {
    found.distortion = NumbersOf(*lens);
  }
  found.model = WordOf(Value(block, {"distortion_model"}));
  if (found.model == "radtan" || found.model == "radial-tangential") found.model = "plumb_bob";
  return found;
}

// Numbers alone may also be those of a pose or a rotation, such as ScanNet's extrinsics.
bool IsOfACamera(const std::array<double, 9>& matrix) {
  constexpr double kRounded = 1e-6;  // no unit; by hand: of numbers that were computed
  const auto is = [&](size_t i, double value) { return std::abs(matrix[i] - value) < kRounded; };
  return is(3, 0.0) && is(6, 0.0) && is(7, 0.0) && is(8, 1.0) && !(is(0, 1.0) && is(4, 1.0));
}

}  // namespace

std::optional<Calibration> ReadKalibrCamera(const std::string& text, const std::string& name) {
  std::vector<std::string> blocks = SplitBlocks(text);
  blocks.push_back(text);  // EuRoC's sensor.yaml has one camera and no block
  std::optional<Calibration> found;
  for (const std::string& block : blocks) {
    auto camera = ReadCameraModel(block, name);
    if (camera && found) throw InputError(name + ": expected one camera, found several");
    if (camera) found = std::move(camera);
  }
  return found;
}

std::optional<Calibration> ReadNamedNumbers(const std::string& text, const std::string& name) {
  std::map<std::string, double> named;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    if (auto number = ReadNamedNumber(std::string_view(text).substr(begin, end - begin))) {
      named.insert(std::move(*number));  // of several cameras the first
    }
    begin = end + 1;
  }
  for (const char* needed : {"fx", "fy", "cx", "cy"}) {
    if (!named.contains(needed)) return std::nullopt;
  }
  Calibration found;
  found.matrix = {named["fx"], 0, named["cx"], 0, named["fy"], named["cy"], 0, 0, 1};
  found.width = SideOf(Value(text, {"Camera.width", "width"}), name);
  found.height = SideOf(Value(text, {"Camera.height", "height"}), name);
  for (const char* term : {"k1", "k2", "p1", "p2", "k3"}) found.distortion.push_back(named[term]);
  return found;
}

std::optional<Calibration> ReadBareMatrix(const std::string& text) {
  if (text.find_first_not_of("0123456789+-.eE \t\r\n,;[]") != text.npos) return std::nullopt;
  const std::vector<double> n = ReadNumbers(text);
  const bool begins_with_matrix =  // as in BIWI's depth.cal, which also has the distortion
      n.size() > 9 && n[3] == 0 && n[6] == 0 && n[7] == 0 && n[8] == 1;
  Calibration found;
  if (n.size() == 9 || begins_with_matrix) {
    found.matrix = RowByRow(n);
  } else if (n.size() == 12 || n.size() == 16) {  // rows of four
    found.matrix = RowByRow({n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10]});
  } else {
    return std::nullopt;
  }
  return IsOfACamera(found.matrix) ? std::optional(found) : std::nullopt;
}

std::optional<Calibration> FindCalibration(const std::string& text, const std::string& name) {
  const auto numbers = FindMatrix(text, name);
  if (!numbers) return std::nullopt;
  Calibration found;
  found.matrix = RowByRow(*numbers);
  found.width = SideOf(Value(text, {"image_width", "imageWidth", "width"}), name);
  found.height = SideOf(Value(text, {"image_height", "imageHeight", "height"}), name);
  if (const auto lens = Value(
          text, {"distortion_coefficients", "distCoeffs", "dist_coeffs", "dist_coeff", "D", "d"})) {
    found.distortion = NumbersOf(*lens);
  }
  found.model = WordOf(Value(text, {"distortion_model"}));
  return found;
}

double ComputeCornerShift(const Calibration& calibration) {
  // They bend without coefficients, too.
  if (IsFisheye(calibration.model)) return std::numeric_limits<double>::quiet_NaN();
  const bool is_straight = std::all_of(calibration.distortion.begin(), calibration.distortion.end(),
                                       [](double k) { return k == 0.0; });
  if (is_straight) return 0.0;
  const bool is_known = calibration.model.empty() || calibration.model == "plumb_bob" ||
                        calibration.model == "rational_polynomial";
  if (!is_known) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> k = calibration.distortion;
  k.resize(std::max<size_t>(k.size(), 8), 0.0);
  const double fx = calibration.matrix[0], cx = calibration.matrix[2];
  const double fy = calibration.matrix[4], cy = calibration.matrix[5];
  const double right = calibration.width > 0 ? calibration.width - 1 : 2 * cx;
  const double bottom = calibration.height > 0 ? calibration.height - 1 : 2 * cy;
  double most = 0.0;
  for (const double u : {0.0, right}) {
    for (const double v : {0.0, bottom}) {
      const auto [x, y] = ComputeShift(k, (u - cx) / fx, (v - cy) / fy);
      most = std::max(most, std::sqrt(fx * x * fx * x + fy * y * fy * y));
    }
  }
  return most;
}

}  // namespace ossa::depth
