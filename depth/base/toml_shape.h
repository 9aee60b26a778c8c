#pragma once
#include <string>
#include <string_view>

namespace ossa {

/// Whether a file may have [name] and [[name]] tables.
enum class TomlTables { kNone, kAllowed };

/// Throws InputError, with `source` and line, unless the text is in the subset of TOML that our
/// files use: lines of name = value, where a value is a number, a single-line string or a list of
/// these, and table headers if allowed. Call it before toml++ parses the text: toml++ 3 reaches
/// code declared unreachable on many invalid characters (found by fuzzing).
void CheckTomlShape(std::string_view text, const std::string& source, TomlTables tables);

}  // namespace ossa
