#pragma once
#include <string>

namespace ossa::recon {

/// Appends a finite number with at most `digits` (1 to 20) after the point and no zeros at its end.
/// Fixed point keeps files small and diffable and loses nothing of large numbers, as seconds since
/// 1970 are; "-0" is written "0" so that equal values are equal bytes.
void AppendFixed(std::string& text, double value, int digits);

}  // namespace ossa::recon
