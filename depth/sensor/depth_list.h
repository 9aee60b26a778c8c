#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace ossa::depth {

/// depth.txt as in the data sets of TU München: one frame per line, seconds and file; `#` starts a
/// comment. Times whose steps cannot be seconds of a camera are milli-, micro- or nanoseconds.
struct DepthList {
  struct Entry {
    double time_s = 0.0;  // since the first entry
    std::string file;     // relative to the list's folder, up to the first blank,
    std::string rest;     // ... and to the line's end: names may have blanks
    int line = 0;         // from 1
  };
  std::vector<Entry> entries;  // in order of time
  double unit_s = 1.0;         // unit of the times in the file
  std::vector<int> bad_lines;  // line numbers of malformed lines, from 1
};

DepthList ParseDepthList(std::string_view text);

/// Reads the list in a folder; without entries if there is none, or the file is something else.
/// Throws InputError if it cannot be read, or is in UTF-16.
DepthList ReadDepthList(const std::filesystem::path& folder);

}  // namespace ossa::depth
