#include "depth/sensor/readers/arrays/array_stack.h"

#include <cmath>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/sensor/frame_names.h"

namespace ossa::depth {
namespace {

constexpr size_t kSmallestSide = 16;  // pixels, by hand: smaller ones are no images of people

// How likely images of this size are a depth camera's.
enum class Likeness { kNone, kPossible, kSize };

Likeness LikenessOf(size_t width, size_t height) {
  using Size = std::pair<size_t, size_t>;
  // Of the cameras of docs/sources.md, of phones and of data sets, on their sides too.
  constexpr std::array kSizes = {
      Size{640, 480},  Size{320, 240},   Size{160, 120},   Size{512, 424}, Size{640, 576},
      Size{320, 288},  Size{512, 512},   Size{1024, 1024}, Size{848, 480}, Size{1280, 720},
      Size{1280, 800}, Size{640, 360},   Size{640, 400},   Size{480, 270}, Size{424, 240},
      Size{256, 192},  Size{1920, 1080}, Size{960, 540},   Size{176, 144}, Size{1920, 1440}};
  constexpr double kWidest = 2.0;  // share, by hand: of cameras 16:9
  const auto is_side = [](size_t side) {
    return side >= kSmallestSide && side <= kLargestImageSide;
  };
  if (!is_side(width) || !is_side(height)) return Likeness::kNone;
  const Size size{std::max(width, height), std::min(width, height)};
  if (std::find(kSizes.begin(), kSizes.end(), size) != kSizes.end()) return Likeness::kSize;
  const double ratio = static_cast<double>(size.first) / static_cast<double>(size.second);
  return ratio <= kWidest ? Likeness::kPossible : Likeness::kNone;
}

// The axes of `shape` that count images, rows and columns.
struct Axes {
  size_t frame, row, column;
};

ArrayStack Arrange(const ArrayInfo& array, const Axes& axes) {
  std::array<size_t, 4> shape = {1, 1, 1, 1}, step = {0, 0, 0, 0};
  size_t numbers = 1;
  for (size_t i = array.shape.size(); i-- > 0;) {
    shape[i] = array.shape[i];
    step[i] = numbers;
    numbers *= shape[i];
  }
  ArrayStack stack;
  stack.name = array.name;
  stack.arrays = {array};
  stack.count = axes.frame < array.shape.size() ? shape[axes.frame] : 1;
  stack.width = static_cast<int>(std::min(shape[axes.column], size_t{kLargestImageSide} + 1));
  stack.height = static_cast<int>(std::min(shape[axes.row], size_t{kLargestImageSide} + 1));
  stack.frame_axis = axes.frame < array.shape.size() ? axes.frame : 0;
  stack.step = {axes.frame < array.shape.size() ? step[axes.frame] : 0, step[axes.row],
                step[axes.column]};
  return stack;
}

Likeness LikenessOf(const ArrayInfo& array, const Axes& axes) {
  return LikenessOf(array.shape[axes.column], array.shape[axes.row]);
}

bool IsNamedAfterDepth(const ArrayStack& stack) {
  return LowerCase(stack.name).find("depth") != std::string::npos;
}

// Arrays of one image each, whose names differ in their numbers, as the sequences they are.
std::vector<ArrayStack> JoinSequences(std::vector<ArrayStack> stacks) {
  std::stable_sort(stacks.begin(), stacks.end(), [](const ArrayStack& a, const ArrayStack& b) {
    return NaturalLess(a.name, b.name);
  });
  using Kind = std::tuple<std::string, std::vector<size_t>, bool, std::string>;
  std::map<Kind, ArrayStack> sequences;
  std::vector<ArrayStack> joined;
  for (ArrayStack& stack : stacks) {
    const ArrayInfo& array = stack.arrays.front();
    if (array.shape.size() != 2) {
      joined.push_back(std::move(stack));
      continue;
    }
    const Kind kind{StripNumbers(stack.name), array.shape, array.is_column_major,
                    NameOf(array.format) + (array.format.is_swapped ? " swapped" : "")};
    const auto [at, is_new] = sequences.try_emplace(kind, stack);
    if (is_new) continue;
    at->second.arrays.push_back(array);
    ++at->second.count;
  }
  for (auto& [kind, stack] : sequences) {
    if (stack.count > 1) stack.name = std::get<0>(kind);
    joined.push_back(std::move(stack));
  }
  return joined;
}

// A sequence's name without what held its numbers: depth/, depth{}, frames().depth.
std::string WithoutCounts(std::string name) {
  for (const std::string_view brackets : {"{}", "()"}) {
    for (size_t at; (at = name.find(brackets)) != std::string::npos;) name.erase(at, 2);
  }
  if (name.ends_with('/')) name.pop_back();
  return name;
}

// "depth" of "camera/depth" and "camera.depth".
std::string LastPart(const std::string& name) { return name.substr(name.find_last_of("/.") + 1); }

bool IsNamedAfterTime(const std::string& name) {
  return WithoutCounts(StripNumbers(LastPart(name))) == "t" ||
         name.find("time") != std::string::npos || name.find("stamp") != std::string::npos;
}

std::string ListText(const std::vector<ArrayStack>& stacks) {
  constexpr size_t kNamed = 4;  // by hand: fits a line
  std::string text;
  for (size_t i = 0; i < std::min(stacks.size(), kNamed); ++i) {
    text += (i > 0 ? "; " : "") + stacks[i].Describe();
  }
  return text + (stacks.size() > kNamed ? "; ..." : "");
}

std::vector<ArrayStack> StacksOf(const std::vector<ArrayInfo>& arrays) {
  std::vector<ArrayStack> stacks;
  for (const ArrayInfo& array : arrays) {
    if (const auto stack = FindStack(array)) stacks.push_back(*stack);
  }
  return stacks;
}

// Those that a test prefers; all if it prefers none.
template <typename Test>
void Prefer(std::vector<ArrayStack>& stacks, const Test& test) {
  if (std::none_of(stacks.begin(), stacks.end(), test)) return;
  std::erase_if(stacks, [&](const ArrayStack& stack) { return !test(stack); });
}

}  // namespace

std::string ArrayStack::Describe() const {
  return (name.empty() ? "" : name + ", ") + std::to_string(count) +
         (count == 1 ? " image of " : " images of ") + std::to_string(width) + "x" +
         std::to_string(height) + ", " + NameOf(format());
}

std::optional<ArrayStack> FindStack(const ArrayInfo& array) {
  if (!HoldsDepths(array.format)) return std::nullopt;
  const bool is_column_major = array.is_column_major;
  if (array.shape.size() == 2) {
    const Axes axes = is_column_major ? Axes{2, 1, 0} : Axes{2, 0, 1};
    if (LikenessOf(array, axes) == Likeness::kNone) return std::nullopt;
    return Arrange(array, axes);
  }
  if (array.shape.size() != 3) return std::nullopt;
  const Axes slices = is_column_major ? Axes{0, 2, 1} : Axes{0, 1, 2};
  const Axes across = is_column_major ? Axes{2, 1, 0} : Axes{2, 0, 1};
  const Likeness as_slices = LikenessOf(array, slices), as_across = LikenessOf(array, across);
  if (as_slices == Likeness::kNone && as_across == Likeness::kNone) return std::nullopt;
  // A number of images may make any ratio by chance, but hardly the size of an upright camera.
  const bool is_upright = array.shape[across.column] >= array.shape[across.row];
  const bool is_camera = is_upright && as_across == Likeness::kSize && as_slices != Likeness::kSize;
  const bool is_across = as_slices == Likeness::kNone || is_camera;
  return Arrange(array, is_across ? across : slices);
}

ArrayStack ChooseStack(const std::vector<ArrayInfo>& arrays, const std::string& asked) {
  std::vector<ArrayStack> stacks = StacksOf(arrays);
  const auto named = std::find_if(stacks.begin(), stacks.end(),
                                  [&](const ArrayStack& stack) { return stack.name == asked; });
  if (!asked.empty() && named != stacks.end()) return *named;
  stacks = JoinSequences(std::move(stacks));
  if (stacks.empty()) {
    throw InputError(
        "expected depth images, arrays of 16 bits or more of 2 or 3 dimensions, found " +
        (arrays.empty()
             ? std::string("no array of numbers")
             : "none among its " + std::to_string(arrays.size()) + " arrays of numbers"));
  }
  if (!asked.empty()) {
    const auto sequence = std::find_if(stacks.begin(), stacks.end(), [&](const ArrayStack& stack) {
      return WithoutCounts(stack.name) == WithoutCounts(asked);
    });
    if (sequence != stacks.end()) return *sequence;
    throw InputError("expected images in '" + asked + "', found " + ListText(stacks));
  }
  Prefer(stacks, IsNamedAfterDepth);
  Prefer(stacks, [](const ArrayStack& stack) { return stack.count > 1; });
  if (stacks.size() == 1) return stacks.front();
  throw InputError("holds several that may be depth images: name one, as in FILE#" +
                   stacks.front().name + ": " + ListText(stacks));
}

std::vector<ArrayInfo> FindTimes(const std::vector<ArrayInfo>& arrays, size_t images) {
  std::map<std::string, std::vector<ArrayInfo>> numbers;
  for (const ArrayInfo& array : arrays) {
    if (!IsNamedAfterTime(LowerCase(array.name))) continue;
    if (array.shape == std::vector<size_t>{images}) return {array};
    if (array.shape.empty()) numbers[StripNumbers(array.name)].push_back(array);
  }
  for (auto& [name, each] : numbers) {
    if (each.size() != images) continue;
    std::stable_sort(each.begin(), each.end(), [](const ArrayInfo& a, const ArrayInfo& b) {
      return NaturalLess(a.name, b.name);
    });
    return each;
  }
  return {};
}

const ArrayInfo* FindCameraMatrix(const std::vector<ArrayInfo>& arrays) {
  constexpr std::array<std::string_view, 9> kNames = {
      "k",       "depth_k",         "intrinsics",          "intrinsic",    "depth_intrinsics",
      "k_depth", "depth_intrinsic", "depth_camera_matrix", "camera_matrix"};
  const auto found = std::find_if(arrays.begin(), arrays.end(), [&](const ArrayInfo& array) {
    const std::string name = LastPart(LowerCase(array.name));
    const bool is_named = std::find(kNames.begin(), kNames.end(), name) != kNames.end();
    return is_named && array.shape == std::vector<size_t>{3, 3};
  });
  return found == arrays.end() ? nullptr : &*found;
}

std::optional<Camera> CameraOfMatrix(const std::vector<double>& matrix, int width, int height) {
  if (matrix.size() != 9) return std::nullopt;
  const bool is_column_major = matrix[2] == 0 && matrix[5] == 0;
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = matrix[0];
  camera.fy = matrix[4];
  camera.cx = is_column_major ? matrix[6] : matrix[2];
  camera.cy = is_column_major ? matrix[7] : matrix[5];
  const auto is_inside = [](double at, int side) { return at > 0 && at < side; };
  const bool is_camera = std::isfinite(camera.fx) && camera.fx > 0 && std::isfinite(camera.fy) &&
                         camera.fy > 0 && is_inside(camera.cx, width) &&
                         is_inside(camera.cy, height) && matrix[8] == 1;
  return is_camera ? std::optional(camera) : std::nullopt;
}

}  // namespace ossa::depth
