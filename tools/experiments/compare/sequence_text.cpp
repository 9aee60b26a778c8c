#include "tools/experiments/compare/sequence_text.h"

#include <sstream>

#include "recon/files/skeleton_jsonl.h"

namespace ossa::tools {

std::string FormatSequence(const recon::SkeletonSequence& sequence) {
  std::string text;
  for (const recon::SkeletonFrame& frame : sequence.frames) {
    text += recon::SkeletonJsonLine(frame);
    text += '\n';
  }
  return text;
}

recon::SkeletonSequence ParseSequence(const std::string& text, const std::string& name) {
  std::istringstream stream(text);
  return recon::ReadSkeletonJsonl(stream, name);
}

}  // namespace ossa::tools
