#pragma once
#include <array>
#include <vector>

#include "recon/normalise.h"

namespace ossa::recon {

/// An observation and the truth at one time, in the person's own frame: normalised, and divided by
/// body size so that everyone is a standard adult. Departure from Liu 2016 sec. 3.1: one scale
/// factor instead of retargeting bone by bone, because the truth often lacks joints (13 from
/// Vicon), and because a wrong bone length is itself an error to learn. The truth is placed and
/// rotated like the observation, so the root has an offset, too.
struct PosturePair {
  Posture observed;      // complete
  Posture residual;      // truth minus observed; eq. 19: m = y + x
  JointWeights known{};  // 1 if the joint is in the truth and was observed
  int group = 0;         // index of the person, for cross-validation
  double worst_m = 0.0;  // largest residual of the frame, including unusable ones
  // Camera from normalised: placement of scale times normalised.
  Placement placement;
  double scale = 1.0, time_s = 0.0;
  int clip = 0;  // pairs of a clip are consecutive: one person's, in order of time
};

/// At most `most` pairs, evenly spread.
std::vector<PosturePair> Thinned(const std::vector<PosturePair>& pairs, size_t most);

/// Cross-validation folds: one fold number, from 0, per pair. With several people, whole people are
/// distributed over at most `most` folds. With one person, or if people are not distinguished,
/// folds are long blocks of time, because neighbouring frames are nearly equal and other people may
/// appear; pairs between two blocks are in no fold.
std::vector<int> AssignFolds(const std::vector<PosturePair>& pairs, int most);
constexpr int kNoFold = -1;  // by convention
/// Whether there is only one person, so none can be left out.
bool OfOnePerson(const std::vector<PosturePair>& pairs);

/// The mirrored pair: errors are symmetric, and pairs are scarce.
PosturePair Mirrored(const PosturePair& pair);

/// Liu 2016 sec. 4.1: concatenated positions of the joint and its neighbours (one bone away).
Eigen::VectorXd JointFeature(const Posture& scaled, size_t joint);

}  // namespace ossa::recon
