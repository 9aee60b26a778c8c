// Which format a skeleton recording has.
#include <algorithm>
#include <istream>
#include <vector>

#include "depth/base/error.h"
#include "recon/files/foreign_recording_internal.h"
#include "recon/files/skeleton_formats_internal.h"
#include "recon/files/skeleton_io.h"

namespace ossa::recon {
namespace {

// Read for detection, by hand.
constexpr size_t kSampleBytes = size_t{1} << 16;
constexpr size_t kSampleLines = 64;  // at most

std::string ReadSample(std::istream& stream) {
  std::string head(kSampleBytes, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<size_t>(stream.gcount()));
  stream.clear();
  stream.seekg(0);
  return head;
}

SkeletonSample MakeSample(std::string_view head, std::string_view name) {
  SkeletonSample sample{name, head, {}};
  if (head.starts_with("\xEF\xBB\xBF")) head.remove_prefix(3);
  const bool may_be_cut = head.size() >= kSampleBytes - 3;
  while (!head.empty() && sample.lines.size() < kSampleLines) {
    const size_t end = head.find_first_of("\r\n");
    if (end == std::string_view::npos && may_be_cut && !sample.lines.empty()) break;
    const std::string_view line = Trimmed(head.substr(0, end));
    if (!line.empty()) sample.lines.push_back(line);
    if (end == std::string_view::npos) break;
    head.remove_prefix(end + 1);
  }
  return sample;
}

}  // namespace

std::span<const SkeletonFormat> AllSkeletonFormats() {
  static const std::vector<SkeletonFormat> kAll = [] {
    std::vector<SkeletonFormat> all;
    // Azure before ours: both are JSON with "bodies", and only Azure's other keys are unambiguous.
    // Generic tables last: they have the fewest marks of their own.
    for (const auto formats : {AzureFormats(), PlainFormats(), PairedFormats(), UiPrmdFormats(),
                               KinectV2Formats(), KinectV1Formats(), DataSetFormats(), C3dFormats(),
                               XefFormats(), StreamSaverFormats(), TableFormats()}) {
      all.insert(all.end(), formats.begin(), formats.end());
    }
    return all;
  }();
  return kAll;
}

const SkeletonFormat& FormatNamed(const std::string& format) {
  const auto formats = AllSkeletonFormats();
  const auto found = std::find_if(formats.begin(), formats.end(),
                                  [&](const SkeletonFormat& f) { return f.name == format; });
  if (found != formats.end()) return *found;
  std::string known;
  for (const SkeletonFormat& f : formats) known.append(" ").append(f.name);
  throw InputError("format " + Quoted(format) + ": expected one of" + known);
}

const SkeletonFormat& DetectFormat(std::istream& stream, const std::string& name) {
  const std::string head = ReadSample(stream);
  if (head.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw InputError(name + ": line 1: expected a skeleton recording, found an empty file");
  }
  if (head.starts_with("\xFF\xFE") || head.starts_with("\xFE\xFF")) {
    throw InputError(name + ": line 1: expected text in UTF-8, found UTF-16: save it as UTF-8");
  }
  const SkeletonSample sample = MakeSample(head, name);
  for (const SkeletonFormat& format : AllSkeletonFormats()) {
    if (format.recognises(sample)) return format;
  }
  const std::string foreign = DescribeForeignRecording(head);
  throw InputError(
      name + ": line 1: expected a skeleton recording that ossa knows, found " +
      (!foreign.empty() ? foreign : Quoted(sample.lines.empty() ? sample.head : sample.lines[0])));
}

std::vector<std::string> SkeletonFormats() {
  std::vector<std::string> names;
  for (const SkeletonFormat& format : AllSkeletonFormats()) names.emplace_back(format.name);
  return names;
}

}  // namespace ossa::recon
