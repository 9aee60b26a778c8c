#pragma once
#include <string_view>

namespace ossa {

/// Measures the nesting depth of a JSON text, chunk by chunk, before it is parsed: the JSON library
/// needs a hundred bytes per level for a file of brackets, and prints recursively. Brackets within
/// strings are counted, too.
class JsonNesting {
 public:
  /// Levels, a bound by hand: files of ossa and of sensor software have six levels.
  static constexpr int kDeepest = 32;

  /// True if the text so far is nested more deeply.
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
