#include "tools/experiments/compare/sequence_text.h"

#include <sstream>

#include "recon/files/skeleton_jsonl.h"

namespace ossa::tools {

std::string TextOf(const recon::SkeletonSequence& sequence) {
  std::string text;
  for (const recon::SkeletonFrame& frame : sequence.frames) {
    text += recon::SkeletonJsonLine(frame);
    text += '\n';
  }
  return text;
}

recon::SkeletonSequence SequenceOf(const std::string& text, const std::string& name) {
  std::istringstream stream(text);
  return recon::ReadSkeletonJsonl(stream, name);
}

}  // namespace ossa::tools
