#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

namespace ossa {

/// numbers[i] * times, rounded to integers; the products must be within int16_t.
void RoundNumbers(const float* numbers, float times, size_t count, int16_t* rounded);

/// Number of lines for a layer's outputs, `in_a_line` each.
inline size_t CountLines(Eigen::Index outputs, size_t in_a_line) {
  return (static_cast<size_t>(outputs) + in_a_line - 1) / in_a_line;
}

}  // namespace ossa
