#include "tools/learning/evaluate.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "depth/base/error.h"
#include "forest/classification/classify.h"
#include "forest/proposals/relabel.h"
#include "forest/targets.h"
#include "recon/body/parts.h"
#include "tools/learning/common_parts.h"
#include "tools/learning/evaluation_totals.h"
#include "tools/learning/labels_picture.h"
#include "tools/learning/person_source.h"

namespace ossa::tools {
namespace {

// Constants: Shotton 2011, section 4, the turn by hand.

constexpr double kHit_m = 0.1;
constexpr double kTurned_rad = std::numbers::pi / 3;

// Processor time of this thread: what others do on the machine does not count.
double Now_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// The relation of a model's classes and targets to ours.
struct Meaning {
  bool has_our_parts = false;        // else only common parts can be compared
  std::vector<uint8_t> common_part;  // of each class
  std::vector<size_t> target_of_joint;
};

void CountPixels(const forest::TrainingImage& image, const forest::Classification& result,
                 const std::vector<uint8_t>& labels, bool is_turned, EvaluationTotals* totals) {
  int64_t same_side = 0;
  int64_t other_side = 0;
  for (size_t i = 0; i < result.pixel.size(); ++i) {
    const uint8_t truth = image.label[static_cast<size_t>(result.pixel[i])];
    const uint8_t label = labels[i];
    ++totals->pixels[truth];
    ++totals->confusion[truth][std::min<size_t>(label, recon::kLabelCount - 1)];
    totals->right[truth] += truth == label ? 1 : 0;
    totals->right_first[truth] += truth == result.label[i] ? 1 : 0;
    if (recon::kMirroredPart[truth] == truth) continue;
    same_side += truth == label ? 1 : 0;
    other_side += recon::kMirroredPart[truth] == label ? 1 : 0;
  }
  const int64_t swapped = other_side > same_side ? 1 : 0;
  totals->swapped += swapped;
  totals->turned += is_turned ? 1 : 0;
  totals->turned_swapped += is_turned ? swapped : 0;
}

void CountCommonParts(const forest::TrainingImage& image, const forest::Classification& result,
                      const std::vector<uint8_t>& labels, const std::vector<uint8_t>& common_part,
                      EvaluationTotals* totals) {
  for (size_t i = 0; i < result.pixel.size(); ++i) {
    const uint8_t truth = ToCommonPart(image.label[static_cast<size_t>(result.pixel[i])]);
    if (truth == kNoCommonPart) continue;
    ++totals->common_pixels[truth];
    totals->common_right[truth] += common_part[labels[i]] == truth ? 1 : 0;
  }
}

// Shotton et al. 2011, sec. 4.2: the first proposal within 0.1 m is the true positive, all others
// are false positives; a joint without any lowers the recall.
void RateJoints(const forest::TrainingImage& image,
                const std::vector<std::vector<forest::Proposal>>& proposals,
                EvaluationTotals* totals) {
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const bool visible = image.target_visible[j] != 0;
    ++totals->joints[j];
    totals->joints_visible[j] += visible ? 1 : 0;
    const Eigen::Vector3d truth_m = image.target_m[j].cast<double>();
    const auto is_hit = [&](const forest::Proposal& proposal) {
      return (proposal.position_m - truth_m).norm() < kHit_m;
    };
    if (!proposals[j].empty()) {
      const forest::Proposal& best = proposals[j].front();
      (best.seen ? totals->seen_joints : totals->inferred_joints)
          .Count(best.confidence, is_hit(best));
    }
    bool found = false;
    for (const forest::Proposal& proposal : proposals[j]) {
      const bool is_near = is_hit(proposal);
      const RatedProposal rated{proposal.confidence, is_near && !found};
      found = found || is_near;
      totals->rated[j].push_back(rated);
      if (visible) totals->rated_visible[j].push_back(rated);
    }
  }
}

void AddPerson(const forest::ForestModel& model, const LabelledFrame& frame, const TruthBody& body,
               const Meaning& meaning, EvaluationTotals* totals) {
  const forest::TrainingImage image = PersonImage(frame, body);
  std::vector<int32_t> pixels;
  for (size_t i = 0; i < image.label.size(); ++i) {
    if (image.label[i] != 0) pixels.push_back(static_cast<int32_t>(i));
  }
  if (pixels.empty()) return;
  const int width = image.camera.width;
  const depth::DepthView view{image.depth_mm.data(), width, image.camera.height, width};
  const double start_ms = Now_ms();
  const forest::Classification result = forest::Classify(model, view, image.camera, pixels);
  const double classified_ms = Now_ms();
  const auto by_target = forest::Propose(model, view, image.camera, result);
  const double proposed_ms = Now_ms();
  const std::vector<uint8_t> labels = forest::Relabel(model, view, image.camera, result, by_target);
  totals->relabel_ms += Now_ms() - proposed_ms;
  totals->propose_ms += proposed_ms - classified_ms;
  totals->classify_ms += classified_ms - start_ms;
  std::vector<std::vector<forest::Proposal>> by_joint;
  for (const size_t target : meaning.target_of_joint) by_joint.push_back(by_target[target]);
  const bool is_turned = std::abs(YawRelativeToRay(body.joints_m)) > kTurned_rad;
  if (meaning.has_our_parts) CountPixels(image, result, labels, is_turned, totals);
  CountCommonParts(image, result, labels, meaning.common_part, totals);
  ++totals->people;
  totals->classified += static_cast<int64_t>(result.pixel.size());
  RateJoints(image, by_joint, totals);
}

Meaning MapToOurs(const forest::ForestModel& model, const std::string& name) {
  const std::vector<std::string>& names = model.data().class_names;
  Meaning meaning;
  meaning.target_of_joint = forest::FindTargets(model, recon::kJointNames, name);
  meaning.has_our_parts =
      std::equal(names.begin(), names.end(), recon::kPartNames.begin(), recon::kPartNames.end());
  const auto common = FindCommonParts(names);
  if (!common) {
    throw InputError(name + ": expected our 31 parts or those of PCL's people trees, found " +
                     std::to_string(names.size()) + " other classes");
  }
  meaning.common_part = *common;
  return meaning;
}

// Of the 31 parts so far.
struct PixelCount {
  int64_t all = 0;
  int64_t right = 0;
};

PixelCount PartPixels(const EvaluationTotals& totals) {
  PixelCount count;
  for (size_t part = 1; part <= recon::kPartCount; ++part) {
    count.all += totals.pixels[part];
    count.right += totals.right[part];
  }
  return count;
}

}  // namespace

Evaluation Evaluate(const forest::ForestModel& model, const std::string& name,
                    const DatasetReader& dataset, int64_t step,
                    const std::function<bool(int64_t, int64_t)>& progress) {
  const Meaning meaning = MapToOurs(model, name);
  EvaluationTotals totals;
  for (int64_t i = 0; i < dataset.frame_count(); i += step) {
    if (progress && !progress(i, dataset.frame_count())) break;
    const LabelledFrame frame = Uncropped(dataset.Read(i), dataset.manifest().camera);
    const auto before = PartPixels(totals);
    for (const TruthBody& body : frame.bodies) {
      AddPerson(model, frame, body, meaning, &totals);
    }
    const auto now = PartPixels(totals);
    if (now.all > before.all) {
      totals.by_frame.push_back({i,
                                 static_cast<double>(now.right - before.right) /
                                     static_cast<double>(now.all - before.all),
                                 {}});
    }
    ++totals.frames;
  }
  Evaluation evaluation = Summarise(std::move(totals));
  for (Evaluation::Frame& frame : evaluation.worst_frames) {
    frame.png = DrawPanels(model, Uncropped(dataset.Read(frame.index), dataset.manifest().camera));
  }
  return evaluation;
}

}  // namespace ossa::tools
