#include "tools/experiments/compare/recordings.h"

#include <fmt/format.h>

#include <map>

#include "depth/base/error.h"
#include "recon/files/skeleton_io.h"

namespace ossa::tools {
namespace {

namespace fs = std::filesystem;

fs::path FindRecordings(const fs::path& shared, const char* inside) {
  if (shared.empty()) {
    throw InputError("--shared: expected the folder of real recordings, found none given");
  }
  const fs::path path = shared / inside;
  if (!fs::exists(path)) {
    throw InputError(path.string() + ": no such recordings: is --shared the right folder?");
  }
  return path;
}

std::vector<const char*> FoldersOf(RecordingSet set) {
  switch (set) {
    case RecordingSet::kUiPrmd:
      return {"real/uiprmd_kinect_vicon/derived"};
    case RecordingSet::kItop:
      return {"real/itop_a2j/itop_side_truth_and_a2j.csv.gz"};
    case RecordingSet::kKeraal:
      return {"real/keraal_kinect_vicon/pairs"};
    case RecordingSet::kWithoutTruth:
      break;
  }
  return {"real/keraal_kinect_vicon/kinect_only", "real/sdk_skeletons/labanotation_v2_csv",
          "real/sdk_skeletons/kinectgait_v1_txt"};
}

fs::path FindRecordings(const fs::path& shared, RecordingSet set) {
  return FindRecordings(shared, FoldersOf(set).front());
}

std::vector<RecordedPair> PairsIn(const fs::path& path) {
  recon::SkeletonReadOptions options;
  options.columns = "observed";
  auto observed = recon::ReadSkeletonClips(path, options);
  options.columns = "truth";
  auto truth = recon::ReadSkeletonClips(path, options);
  std::vector<RecordedPair> pairs;
  for (size_t i = 0; i < observed.size(); ++i) {
    RecordedPair pair;
    pair.clip = observed[i].name;
    pair.subject = pair.clip.substr(0, pair.clip.find('/'));
    pair.observed = std::move(observed[i].sequence);
    pair.truth = std::move(truth[i].sequence);
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

}  // namespace

void RequireRecordings(const fs::path& shared, const std::vector<RecordingSet>& wanted) {
  for (const RecordingSet set : wanted) {
    for (const char* inside : FoldersOf(set)) FindRecordings(shared, inside);
  }
}

std::vector<RecordedPair> LoadUiPrmd(const fs::path& shared, bool incorrect) {
  auto pairs = PairsIn(FindRecordings(shared, RecordingSet::kUiPrmd));
  std::erase_if(pairs,
                [&](const RecordedPair& pair) { return pair.clip.ends_with("_inc") != incorrect; });
  return pairs;
}

std::vector<RecordedPair> LoadItop(const fs::path& shared) {
  auto pairs = PairsIn(FindRecordings(shared, RecordingSet::kItop));
  for (RecordedPair& pair : pairs) pair.clip = pair.subject = "itop_side";
  return pairs;
}

std::vector<RecordedPair> LoadKeraal(const fs::path& shared) {
  std::map<std::string, RecordedPair> pairs;
  for (auto& clip : recon::ReadSkeletonClips(FindRecordings(shared, RecordingSet::kKeraal))) {
    const bool vicon = clip.name.find("-Vicon-") != std::string::npos;
    std::string name = clip.name;
    const std::string mark = vicon ? "-Vicon-" : "-Kinect-";
    if (const size_t place = name.find(mark); place != std::string::npos) {
      name.erase(place, mark.size() - 1);
    }
    RecordedPair& pair = pairs[name];
    pair.clip = pair.subject = name;
    (vicon ? pair.truth : pair.observed) = std::move(clip.sequence);
  }
  std::vector<RecordedPair> list;
  for (auto& [name, pair] : pairs) {
    if (!pair.truth.frames.empty() && !pair.observed.frames.empty()) {
      list.push_back(std::move(pair));
    }
  }
  return list;
}

std::vector<RecordedPair> LoadWithoutTruth(const fs::path& shared) {
  std::vector<RecordedPair> all;
  for (const char* inside : FoldersOf(RecordingSet::kWithoutTruth)) {
    const fs::path folder = FindRecordings(shared, inside);
    for (auto& clip : recon::ReadSkeletonClips(folder)) {
      RecordedPair recorded;
      recorded.clip = fmt::format("{}/{}", folder.filename().string(), clip.name);
      recorded.subject = clip.name;
      recorded.observed = std::move(clip.sequence);
      all.push_back(std::move(recorded));
    }
  }
  return all;
}

}  // namespace ossa::tools
