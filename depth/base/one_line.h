#pragma once
#include <string>
#include <string_view>

namespace ossa {

/// `text` with control characters and invalid UTF-8 escaped as \xNN: a single line, whatever it
/// quotes, that does not affect the terminal.
std::string OnOneLine(std::string_view text);

}  // namespace ossa
