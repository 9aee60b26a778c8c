#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace ossa::depth {

/// depth.txt as the data sets of TU München have it: a line a frame, seconds and file; `#` begins a
/// comment. Times in steps that no camera's seconds have are milli-, micro- or nanoseconds.
struct DepthList {
  struct Entry {
    double time_s = 0.0;  // from the first entry on
    std::string file;     // relative to the list's folder
    int line = 0;         // from 1
  };
  std::vector<Entry> entries;  // in order of time
  double unit_s = 1.0;         // of the times as they stand in it
  std::vector<int> bad_lines;  // that are none of these, from 1
};

DepthList ParseDepthList(std::string_view text);

/// The list in this folder; without entries if there is none, or something else of that name.
/// Throws InputError for one that cannot be read.
DepthList ReadDepthList(const std::filesystem::path& folder);

}  // namespace ossa::depth
