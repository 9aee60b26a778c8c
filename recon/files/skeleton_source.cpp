#include <algorithm>
#include <fstream>

#include "depth/base/error.h"
#include "recon/files/skeleton_source_internal.h"

namespace ossa::recon {
namespace {

// Columns may be given before or after the member; a member's name may contain '#'.
void ParseSelectors(std::string words, SkeletonPath& parts) {
  const size_t last = words.rfind('#') + 1;  // 0 without one
  const size_t first = std::min(words.find('#'), words.size());
  if (parts.columns = ParseColumns(words.substr(last)); !parts.columns.empty()) {
    words.resize(last > 0 ? last - 1 : 0);
  } else if (parts.columns = ParseColumns(words.substr(0, first)); !parts.columns.empty()) {
    words.erase(0, first + 1);
  }
  parts.member = std::move(words);
}

}  // namespace

std::string ParseColumns(const std::string& word) {
  for (const char* name : {"truth", "vicon", "G", "ground-truth"}) {
    if (word == name) return "truth";
  }
  for (const char* name : {"observed", "kinect", "estimate", "a2j", "K", "P"}) {
    if (word == name) return "observed";
  }
  return {};
}

SkeletonPath TakeApart(const std::filesystem::path& path) {
  const std::string text = path.string();
  for (size_t end = text.size(); end != std::string::npos && end > 0;
       end = text.rfind('#', end - 1)) {
    std::error_code unknown;
    const std::string left = text.substr(0, end);
    if (!std::filesystem::exists(left, unknown)) continue;
    SkeletonPath parts{left, {}, {}};
    if (end < text.size()) ParseSelectors(text.substr(end + 1), parts);
    return parts;
  }
  return {path, {}, {}};
}

}  // namespace ossa::recon
