#include "tools/learning/pair_recordings.h"

#include <map>

#include "depth/base/error.h"
#include "recon/methods/recorded_pairs.h"

namespace ossa::tools {
namespace {

/// Numbers people by the file and the folder in it that their recordings are from.
class People {
 public:
  int Of(const std::string& observed_path, const std::string& clip) {
    const std::string name = observed_path + "\n" + clip.substr(0, clip.find('/'));
    return numbers_.try_emplace(name, static_cast<int>(numbers_.size())).first->second;
  }

 private:
  std::map<std::string, int> numbers_;
};

// Clips of both sides by name; a single file on each side belongs together whatever its name.
void AddClips(const std::string& observed_path, const std::vector<recon::SkeletonClip>& observed,
              const std::vector<recon::SkeletonClip>& truth, People& people,
              std::vector<recon::PosturePair>& pairs) {
  if (observed.size() == 1 && truth.size() == 1) {
    recon::AddPairs(observed[0].sequence, truth[0].sequence, pairs, people.Of(observed_path, ""));
    return;
  }
  std::map<std::string, const recon::SkeletonClip*> by_name;
  for (const auto& clip : truth) by_name[clip.name] = &clip;
  for (const auto& clip : observed) {
    const auto it = by_name.find(clip.name);
    if (it == by_name.end()) continue;
    recon::AddPairs(clip.sequence, it->second->sequence, pairs,
                    people.Of(observed_path, clip.name));
  }
}

}  // namespace

std::vector<recon::PosturePair> PairRecordings(
    const std::vector<std::string>& observed, const std::vector<std::string>& truth,
    const recon::SkeletonReadOptions& reading,
    const std::function<bool(const std::vector<recon::SkeletonClip>&)>& read) {
  if (observed.size() != truth.size()) {
    throw InputError("observed and truth: expected as many files of one as of the other, found " +
                     std::to_string(observed.size()) + " and " + std::to_string(truth.size()));
  }
  std::vector<recon::PosturePair> pairs;
  People people;
  for (size_t i = 0; i < observed.size(); ++i) {
    const auto seen = recon::ReadSkeletonClips(observed[i], reading);
    const auto known = recon::ReadSkeletonClips(truth[i], reading);
    if (read && !(read(seen) && read(known))) return pairs;
    const size_t before = pairs.size();
    AddClips(observed[i], seen, known, people, pairs);
    if (pairs.size() == before) {
      throw InputError(observed[i] + ": no frame matches one of " + truth[i] +
                       "; expected recordings of the same names, the same frame numbers or times, "
                       "and at least 4 common joints less than 0.5 m apart (of other axes and "
                       "places nothing is learned)");
    }
  }
  return pairs;
}

}  // namespace ossa::tools
