// Formats that belong to no SDK: our own JSONL and table, OpenSim's TRC.
#include <algorithm>
#include <array>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "recon/files/csv_fields_internal.h"
#include "recon/files/skeleton_formats_internal.h"
#include "recon/files/skeleton_jsonl.h"
#include "recon/motion/bvh.h"
#include "recon/motion/text_scanner_internal.h"

namespace ossa::recon {
namespace {

bool IsJsonl(const SkeletonSample& sample) {
  if (sample.lines.empty() || !Trimmed(sample.lines[0]).starts_with('{')) return false;
  // Azure Kinect's recordings are JSON, too: one object over many lines, with other keys.
  return sample.lines[0].find("\"bodies\"") != std::string_view::npos ||
         (sample.lines[0].size() > 1 && HasEnding(sample.name, ".jsonl"));
}

SkeletonSequence ReadJsonl(SkeletonInput& input) {
  return ReadSkeletonJsonl(input.stream, input.name);
}

bool IsCsv(const SkeletonSample& sample) {
  if (sample.lines.empty()) return false;
  const std::vector<std::string> names = ReadCsvHeader(sample.lines[0]);
  return names.size() > 3 && names[0] == "frame" && names[1] == "time_s" && names[2] == "body";
}

bool IsTrc(const SkeletonSample& sample) {
  return !sample.lines.empty() && sample.lines[0].starts_with("PathFileType");
}

bool IsBvh(const SkeletonSample& sample) {
  return !sample.lines.empty() && LowerCase(sample.lines[0].substr(0, 9)) == "hierarchy";
}

// The BVH reader needs the whole text.
SkeletonSequence ReadBvhSkeleton(SkeletonInput& input) {
  std::string text;
  std::array<char, 1 << 16> block{};
  while (input.stream.read(block.data(), block.size()) || input.stream.gcount() > 0) {
    text.append(block.data(), static_cast<size_t>(input.stream.gcount()));
    if (text.size() > kMostBvhBytes)
      throw InputError(input.name + ": expected at most 512 MiB of BVH");
  }
  SkeletonSequence sequence =
      BvhToSkeleton(ParseBvh(std::move(text), input.name), input.name, input.mapping);
  RequireFrames(sequence);
  return sequence;
}

constexpr SkeletonFormat kPlainFormats[] = {
    {"trc", IsTrc, ReadTrc},
    {"csv", IsCsv, ReadSkeletonCsv},
    {"bvh", IsBvh, ReadBvhSkeleton},
    {"jsonl", IsJsonl, ReadJsonl},
};

}  // namespace

std::optional<TrackingState> FindState(std::string_view name) {
  const auto found = std::find(kStateNames.begin(), kStateNames.end(), name);
  if (found == kStateNames.end()) return std::nullopt;
  return static_cast<TrackingState>(found - kStateNames.begin());
}

std::span<const SkeletonFormat> PlainFormats() { return kPlainFormats; }

}  // namespace ossa::recon
