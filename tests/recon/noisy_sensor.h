#pragma once
#include "recon/methods/recorded_pairs.h"
#include "recon/models/learned_models.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon::test {

constexpr double kFrame_s = 1.0 / 30.0;

/// A person's motion, true and as observed by a sensor with jitter and a frame of latency. People
/// differ in size and motion.
struct SeenPerson {
  std::vector<Posture> truth, seen;
};

inline SeenPerson Seen(int person, int frames = 300) {
  std::mt19937_64 rng(static_cast<uint64_t>(100 + person));
  SeenPerson out;
  for (int f = 0; f < frames; ++f) {
    const auto at = [&](int frame) {
      return InFrontOfCamera(Motion(30.0 * person + frame * kFrame_s), 0.9 + 0.05 * person);
    };
    out.truth.push_back(at(f));
    out.seen.push_back(at(f - 1));
    AddNoise(out.seen.back(), 0.005, rng);
  }
  return out;
}

/// A person observed by a memoryless sensor: jitter of centimetres, and in one frame of twenty a
/// limb joint is 30 cm off.
inline SeenPerson SeenBadly(int person, int frames = 600) {
  std::mt19937_64 rng(static_cast<uint64_t>(200 + person));
  std::normal_distribution<double> normal(0.0, 1.0);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  SeenPerson out;
  for (int f = 0; f < frames; ++f) {
    out.truth.push_back(InFrontOfCamera(Motion(30.0 * person + f * kFrame_s), 0.9 + 0.05 * person));
    out.seen.push_back(out.truth.back());
    AddNoise(out.seen.back(), 0.02, rng);
    for (size_t i = 4; i < kJointCount; ++i) {
      if (unit(rng) > 0.05) continue;
      const Eigen::Vector3d away(normal(rng), normal(rng), normal(rng));
      out.seen.back().position_m[i] += 0.3 * away.normalized();
    }
  }
  return out;
}

inline SkeletonSequence SequenceOf(const std::vector<Posture>& postures) {
  SkeletonSequence sequence;
  for (size_t f = 0; f < postures.size(); ++f) {
    SkeletonFrame& frame = sequence.frames.emplace_back();
    frame.frame = static_cast<int64_t>(f);
    frame.time_s = static_cast<double>(f) * kFrame_s;
    frame.bodies.resize(1);
    for (size_t i = 0; i < kJointCount; ++i) {
      frame.bodies[0].joints[i].emplace().position_m = postures[f].position_m[i];
    }
  }
  return sequence;
}

inline std::vector<PosturePair> PairsOfPeople(int people) {
  std::vector<PosturePair> pairs;
  for (int person = 0; person < people; ++person) {
    const SeenPerson seen = Seen(person);
    AddPairs(SequenceOf(seen.seen), SequenceOf(seen.truth), pairs, person);
  }
  return pairs;
}

/// One recording of one person by that sensor.
inline std::vector<PosturePair> PairsOfABadSensor() {
  const SeenPerson seen = SeenBadly(0);
  std::vector<PosturePair> pairs;
  AddPairs(SequenceOf(seen.seen), SequenceOf(seen.truth), pairs, 0);
  return pairs;
}

}  // namespace ossa::recon::test
