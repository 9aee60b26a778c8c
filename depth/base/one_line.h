#pragma once
#include <string>
#include <string_view>

namespace ossa {

/// `text` with control characters and what is no UTF-8 written as \xNN: it is one line of
/// characters whatever it quotes, and changes no terminal.
std::string OnOneLine(std::string_view text);

}  // namespace ossa
