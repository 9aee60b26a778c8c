#pragma once
#include <string>

namespace ossa::recon {

/// Appends a finite number with at most `digits` (1 to 20) decimals and no trailing zeros. Fixed
/// point keeps files small and diffable and is exact for large numbers such as seconds since 1970.
/// "-0" is written as "0" so that equal values give equal bytes.
void AppendFixed(std::string& text, double value, int digits);

}  // namespace ossa::recon
