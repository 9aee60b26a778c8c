#pragma once
#include <string_view>

namespace ossa {

/// Counts how deep a JSON text nests, piece by piece, before it is parsed: the JSON library holds a
/// hundred bytes for each level of a file of brackets, and prints recursively. Brackets within
/// strings count, too.
class JsonNesting {
 public:
  /// Levels, a bound by hand: what ossa and the sensors' programs write nests six deep.
  static constexpr int kDeepest = 32;

  /// True when the text so far nests deeper than that.
  bool IsTooDeep(std::string_view piece) {
    for (const char c : piece) {
      if (c == '[' || c == '{') ++depth_;
      if (c == ']' || c == '}') --depth_;
      if (depth_ > kDeepest) return true;
    }
    return false;
  }

 private:
  int depth_ = 0;
};

}  // namespace ossa
