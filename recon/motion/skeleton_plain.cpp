// The formats that are not an SDK's: our own JSONL and table, OpenSim's TRC.
#include "recon/motion/skeleton_formats_internal.h"
#include "recon/motion/skeleton_jsonl.h"

namespace ossa::recon {
namespace {

bool IsJsonl(const SkeletonSample& sample) {
  if (sample.lines.empty() || !Trimmed(sample.lines[0]).starts_with('{')) return false;
  // Azure Kinect's recordings are JSON too: an object over many lines with other keys.
  return sample.lines[0].find("\"bodies\"") != std::string_view::npos ||
         (sample.lines[0].size() > 1 && sample.name.ends_with(".jsonl"));
}

SkeletonSequence ReadJsonl(SkeletonInput& input) {
  return ReadSkeletonJsonl(input.stream, input.name);
}

bool IsCsv(const SkeletonSample& sample) {
  return !sample.lines.empty() && sample.lines[0].starts_with("frame,time_s,body,");
}

bool IsTrc(const SkeletonSample& sample) {
  return !sample.lines.empty() && sample.lines[0].starts_with("PathFileType");
}

constexpr SkeletonFormat kFormats[] = {
    {"trc", IsTrc, ReadTrc},
    {"csv", IsCsv, ReadSkeletonCsv},
    {"jsonl", IsJsonl, ReadJsonl},
};

}  // namespace

std::span<const SkeletonFormat> PlainFormats() { return kFormats; }

}  // namespace ossa::recon
