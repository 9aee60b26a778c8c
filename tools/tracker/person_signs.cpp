#include "tools/tracker/person_signs.h"

#include "forest/forest.h"
#include "tools/tracker/choose_posture_internal.h"
#include "tools/tracker/perceive_internal.h"
#include "tools/tracker/shipped.h"

namespace ossa::tracker {

struct SignCollector::State {
  forest::ForestModel model;
  recon::JointArray<int> targets;
};

std::span<const std::string_view> PersonSignNames() { return kSignNames; }
size_t SurfaceSignCount() { return static_cast<size_t>(Sign::kTrust); }

SignCollector::SignCollector(const std::filesystem::path& model) {
  const auto path = model.empty() ? ShippedFile("body.ossa") : model;
  forest::ForestModel read = forest::ReadForestModel(path);
  const auto targets = JointTargets(read, path);
  state_ = std::make_unique<State>(State{std::move(read), targets});
}
SignCollector::~SignCollector() = default;

std::vector<CandidateSigns> SignCollector::Look(const depth::DepthFrame& frame) const {
  const depth::SceneState nothing_before;
  depth::SceneState next;
  depth::Scene scene = depth::FindCandidates(frame, nothing_before, next);
  PerceiveOptions perceive;
  perceive.least_score = -1;  // propose for everything
  std::vector<CandidateSigns> all;
  for (depth::Candidate& candidate : scene.candidates) {
    const Perception seen = Perceive(state_->model, state_->targets, frame, candidate, perceive);
    all.push_back(
        {std::move(candidate.pixels), {seen.sign.begin(), seen.sign.end()}, seen.person_score});
  }
  return all;
}

}  // namespace ossa::tracker
