#pragma once
#include <array>
#include <vector>

#include "recon/normalise.h"

namespace ossa::recon {

/// What was observed and what was true at one moment, in the person's own frame: normalised, and
/// divided by the body's size so that everyone is a standard adult. Departure from Liu 2016
/// sec. 3.1: one factor instead of a bone-by-bone retargeting, because the truth often lacks joints
/// (13 from Vicon) and because a bone observed too short is itself an error to learn. The truth is
/// placed and turned as the observation is, so that the root, too, has an offset.
struct PosturePair {
  Posture observed;      // complete
  Posture residual;      // truth minus observed; eq. 19: m = y + x
  JointWeights known{};  // 1 where the truth has the joint and the observation saw it
  int group = 0;         // the person it is of: what is learned must hold for other groups
  double worst_m = 0.0;  // largest residual of the frame, those too large to be learned from too
  // Where and when it was seen: camera = placement of scale times normalised.
  Placement placement;
  double scale = 1.0, time_s = 0.0;
  int clip = 0;  // pairs of one clip follow each other: one person's, in the order of time
};

/// At most so many, evenly spread.
std::vector<PosturePair> Thinned(const std::vector<PosturePair>& pairs, size_t most);

/// What is left out in turn, to try what is learned on what it was not learned of: one number a
/// pair, from 0. Several people: each with all of its pairs, by turns, in at most so many folds. Of
/// one person, or where nobody was told apart: long blocks of time, because neighbours in time are
/// nearly the same, and others may come into view; between two blocks pairs are in no fold.
std::vector<int> AssignFolds(const std::vector<PosturePair>& pairs, int most);
constexpr int kNoFold = -1;  // by convention
/// Whether nobody can be left out.
bool OfOnePerson(const std::vector<PosturePair>& pairs);

/// Left and right exchanged: people's errors do not know sides, and pairs are dear.
PosturePair Mirrored(const PosturePair& pair);

/// Liu 2016 sec. 4.1: the joint and its neighbours (those a bone away), positions in order.
Eigen::VectorXd JointFeature(const Posture& scaled, size_t joint);

}  // namespace ossa::recon
