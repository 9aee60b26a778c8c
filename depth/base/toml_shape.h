#pragma once
#include <string>
#include <string_view>

namespace ossa {

/// Whether a file may have [name] and [[name]] tables.
enum class TomlTables { kNone, kAllowed };

/// Throws InputError, `source` and the line named, for a text that is not of the plain TOML that
/// our files are written in: lines of name = value, a value being a number, a text of one line or a
/// list of those, and headers of tables where those are allowed. To be asked before toml++ reads
/// it, for toml++ 3 runs into what it declares unreachable at many a character that is not legal
/// where it stands (found by fuzzing).
void CheckTomlShape(std::string_view text, const std::string& source, TomlTables tables);

}  // namespace ossa
