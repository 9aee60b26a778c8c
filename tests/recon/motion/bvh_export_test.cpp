// Skeletons written as BVH: whose motion, at which times, and how much of it.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "recon/files/skeleton_io.h"
#include "recon/motion/bvh.h"
#include "tests/recon/synthetic_motion.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

// Six decimals of a degree over at most 1 m of chain, and of a centimetre.
constexpr double kTolerance_m = 1e-6;

void Add(SkeletonFrame& frame, int id, double size) {
  BodyRecord body;
  body.id = id;
  const Posture posture = test::InFrontOfCamera(test::Motion(frame.time_s), size);
  for (size_t j = 0; j < kJointCount; ++j) {
    body.joints[j].emplace().position_m = posture.position_m[j];
  }
  frame.bodies.push_back(body);
}

/// Three seconds from 5 s on; -3 is there all the time, 7 from the second second to its end.
SkeletonSequence TwoPeople() {
  SkeletonSequence sequence{"two.jsonl", {}};
  for (int f = 0; f < 90; ++f) {
    SkeletonFrame& frame = sequence.frames.emplace_back();
    frame.frame = f;
    frame.time_s = 5.0 + f / 30.0;
    if (f >= 30 && f < 60) Add(frame, 7, 0.8);
    Add(frame, -3, 1.0);
  }
  return sequence;
}

/// One person at these times.
SkeletonSequence SeenAt(const std::vector<double>& times_s) {
  SkeletonSequence sequence{"gap.jsonl", {}};
  for (const double time_s : times_s) {
    SkeletonFrame& frame = sequence.frames.emplace_back();
    frame.frame = static_cast<int64_t>(sequence.frames.size());
    frame.time_s = time_s;
    Add(frame, 1, 1.0);
  }
  return sequence;
}

double Apart_m(const BodyRecord& a, const BodyRecord& b) {
  double worst_m = 0.0;
  for (size_t j = 0; j < kJointCount; ++j) {
    worst_m = std::max(worst_m, (a.joints[j]->position_m - b.joints[j]->position_m).norm());
  }
  return worst_m;
}

std::string TextOf(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// All files start with the recording, not with each person's first sighting.
TEST(BvhExport, FilesOfSeveralPeopleShareTheRecordingsFrames) {
  const ossa::test::TemporaryFolder folder;
  const SkeletonSequence truth = TwoPeople();
  WriteSkeletons(folder / "two.bvh", truth);
  const SkeletonSequence all = ReadSkeletons(folder / "two.bvh");
  const SkeletonSequence late = ReadSkeletons(folder / "two_7.bvh");
  ASSERT_EQ(all.frames.size(), 90u);
  ASSERT_EQ(late.frames.size(), 60u);
  for (size_t f = 0; f < 90; ++f) {
    EXPECT_LT(Apart_m(all.frames[f].bodies[0], truth.frames[f].bodies.back()), kTolerance_m) << f;
  }
  for (size_t f = 0; f < 60; ++f) {
    const BodyRecord& held = truth.frames[std::max<size_t>(f, 30)].bodies[0];
    EXPECT_LT(Apart_m(late.frames[f].bodies[0], held), kTolerance_m) << f;
  }
}

// Joints outside the image are not tracked, whatever their position in a file; a method that places
// them states their reliability.
TEST(BvhExport, KeepsUntrackedJointsThatAMethodPlaced) {
  for (const bool placed : {false, true}) {
    SkeletonSequence sequence = SeenAt({0.0, 1 / 30.0, 2 / 30.0});
    for (size_t f = 1; f < 3; ++f) {
      JointRecord& hand = *sequence.frames[f].bodies[0].joints[7];
      hand.state = TrackingState::kNotTracked;
      if (placed) hand.reliability = 0.1;
      if (!placed) hand.position_m.setZero();
    }
    const SkeletonSequence made = BvhToSkeleton(SkeletonToBvh(sequence), "made.bvh");
    SkeletonSequence held = SeenAt({0.0, 1 / 30.0, 2 / 30.0});
    const auto bone = [](const BodyRecord& body) -> Eigen::Vector3d {
      return (body.joints[7]->position_m - body.joints[6]->position_m).normalized();
    };
    for (size_t f = 0; f < 3; ++f) {
      const Eigen::Vector3d expected = bone(held.frames[placed ? f : 0].bodies[0]);
      EXPECT_LT((bone(made.frames[f].bodies[0]) - expected).norm(), 1e-5) << placed << f;
    }
  }
}

// `Frame Time: 0.033333` of other files must not lose the last frame when it is written again.
TEST(BvhExport, KeepsTheLastFrameWhereTimesAreRounded) {
  std::vector<double> times_s;
  for (int f = 0; f < 2000; ++f) times_s.push_back(f * 0.033333);
  EXPECT_EQ(SkeletonToBvh(SeenAt(times_s)).FrameCount(), 2000u);
}

TEST(BvhExport, RecordingWithoutBodiesIsRefused) {
  const ossa::test::TemporaryFolder folder;
  SkeletonSequence nobody = SeenAt({0.0, 0.1});
  for (SkeletonFrame& frame : nobody.frames) frame.bodies.clear();
  ossa::test::ExpectRefused([&] { WriteSkeletons(folder / "x.bvh", nobody); },
                            "x.bvh: expected a person");
  WriteSkeletons(folder / "x.trc", nobody);
  EXPECT_TRUE(std::filesystem::exists(folder / "x.trc"));
}

// Otherwise the result would be a T-pose at the camera.
TEST(BvhExport, BodyWithoutJointsIsRefused) {
  const ossa::test::TemporaryFolder folder;
  SkeletonSequence unseen = SeenAt({0.0, 0.1});
  for (SkeletonFrame& frame : unseen.frames) frame.bodies[0].joints = {};
  ossa::test::ExpectRefused([&] { WriteSkeletons(folder / "x.bvh", unseen); },
                            "x.bvh: expected a person");
  SkeletonSequence two = SeenAt({0.0, 0.1});
  for (SkeletonFrame& frame : two.frames) {
    frame.bodies.insert(frame.bodies.begin(), BodyRecord{});
    frame.bodies[0].id = 12;
  }
  WriteSkeletons(folder / "two.bvh", two);
  const SkeletonSequence read = ReadSkeletons(folder / "two.bvh");
  EXPECT_GT(read.frames[0].bodies[0].joints[0]->position_m.z(), 0.5) << "who was seen";
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

// Negative ids are valid and do not mean "the body in most frames".
TEST(BvhExport, ExportsTheRequestedBody) {
  SkeletonSequence sequence = TwoPeople();
  for (SkeletonFrame& frame : sequence.frames) {
    for (BodyRecord& body : frame.bodies) body.id = body.id == 7 ? -7 : body.id;
  }
  BvhExportOptions options;
  EXPECT_EQ(SkeletonToBvh(sequence, options).FrameCount(), 90u);
  options.body_id = -7;
  EXPECT_EQ(SkeletonToBvh(sequence, options).FrameCount(), 60u);
  options.body_id = -1;
  ossa::test::ExpectRefused([&] { SkeletonToBvh(sequence, options); }, "expected body -1");
}

TEST(BvhExport, StreamedFileEqualsTheOneMadeInMemory) {
  const ossa::test::TemporaryFolder folder;
  const SkeletonSequence sequence = SeenAt({3.0, 3.1, 3.3, 13.0});
  WriteSkeletonAsBvh(sequence, folder / "x.bvh");
  const std::string text = TextOf(folder / "x.bvh");
  EXPECT_EQ(text, FormatBvh(SkeletonToBvh(sequence)));
  EXPECT_NE(text.find("\nFrames: 301\nFrame Time: 0.0333333333\n"), std::string::npos)
      << "a step with too few digits is another rate";
}

// A gap of a day would need gigabytes of memory and give an unreadable file.
TEST(BvhExport, TooLongGapsAreRefusedAndTheLongestIsNamed) {
  const ossa::test::TemporaryFolder folder;
  BvhExportOptions options;
  options.most_bytes = size_t{1} << 20;
  const std::string path = folder / "x.bvh";
  const auto write = [&] { WriteSkeletonAsBvh(SeenAt({2, 2.5, 100.5, 103.5}), path, options); };
  ossa::test::ExpectRefused(
      write, path +
                 ": expected a BVH of at most 1 MiB, as ossa reads them, found 3046 "
                 "frames of 0.03333 s, the longest gap without the body being of 98 s "
                 "after time_s 2.500: .jsonl has no such limit");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  options.most_bytes = size_t{4} << 20;
  EXPECT_NO_THROW(write());
}

TEST(BvhExport, TooManyFramesAreRefusedInAdvance) {
  const ossa::test::TemporaryFolder folder;
  const SkeletonSequence days = SeenAt({0, 86400, 2 * 86400, 3 * 86400});
  ossa::test::ExpectRefused([&] { WriteSkeletons(folder / "x.bvh", days); },
                            "at most 512 MiB, as ossa reads them, found 7776001 frames");
  ossa::test::ExpectRefused([&] { SkeletonToBvh(days); },
                            "gap.jsonl: expected a BVH of at most 512 MiB");
  EXPECT_NO_THROW(WriteSkeletons(folder / "x.jsonl", days));
}

// As in all other single-person formats.
TEST(BvhExport, IsReadBackAsBodyOne) {
  const SkeletonSequence read = BvhToSkeleton(SkeletonToBvh(TwoPeople()), "back");
  for (const SkeletonFrame& frame : read.frames) EXPECT_EQ(frame.bodies.at(0).id, 1);
}

}  // namespace
}  // namespace ossa::recon
