// The SDK's skeletons in recordings of Kinect Studio.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

#include "recon/files/skeleton_io.h"
#include "tests/depth/sensor/xef_writer.h"
#include "tests/recon/files/xef_bodies.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

using test::ExpectRefused;
using test::XefBodies;
using test::XefWriter;

constexpr uint64_t kSecond = 10'000'000;  // ticks

SkeletonSequence Read(const std::string& bytes) {
  std::istringstream stream(bytes);
  return ReadSkeletonStream(stream, "x.xef", {});
}

std::string Recording(bool is_archived) {
  XefBodies first, second;
  first.Set(4, 72057594037927999U, 0.5F);  // the fifth of six bodies
  second.Set(4, 72057594037927999U, 0.6F).Set(0, 72057594037928111U, 2.0F);
  XefWriter writer(is_archived);
  writer.AddStream(1, "Nui Body Frame", XefWriter::kBodies);
  writer.AddEvent(1, 7 * kSecond, 1, first.bytes());
  writer.AddUnknown(0x7000);
  writer.AddEvent(1, 7 * kSecond + kSecond / 2, 2, second.bytes());
  return writer.Finish();
}

TEST(KinectStudioSkeletons, HaveJointsStatesIdsAndTimes) {
  for (const bool is_archived : {false, true}) {
    const SkeletonSequence sequence = Read(Recording(is_archived));
    for (const std::string& warning : sequence.warnings) {
      EXPECT_EQ(warning.find("cut short"), std::string::npos) << warning;
      EXPECT_EQ(warning.find("damaged"), std::string::npos) << warning;
    }
    EXPECT_EQ(sequence.sensor, kKinectV2);
    ASSERT_EQ(sequence.frames.size(), 2u);
    EXPECT_NEAR(sequence.frames[1].time_s, 0.5, 1e-9);
    ASSERT_EQ(sequence.frames[0].bodies.size(), 1u);
    ASSERT_EQ(sequence.frames[1].bodies.size(), 2u);
    EXPECT_EQ(sequence.frames[0].bodies[0].id, 1);
    EXPECT_EQ(sequence.frames[1].bodies[0].id, 2) << "numbered as they appear";
    const BodyRecord& body = sequence.frames[0].bodies[0];
    // SpineShoulder is the 21st of SDK 2's joints, HandRight the 12th.
    EXPECT_TRUE(body.joints[Joint::kShoulderCenter]->position_m.isApprox(
        Eigen::Vector3d(0.5, 0.2, 2.0), 1e-6));
    EXPECT_TRUE(
        body.joints[Joint::kHandRight]->position_m.isApprox(Eigen::Vector3d(0.5, 0.11, 2.0), 1e-6));
    EXPECT_EQ(body.joints[Joint::kHandRight]->state, TrackingState::kInferred);
    EXPECT_EQ(body.joints[Joint::kHead]->state, TrackingState::kTracked);
    EXPECT_TRUE(body.joints[Joint::kHead]->orientation.has_value());
    EXPECT_FALSE(body.joints[Joint::kFootLeft]->orientation.has_value());
  }
}

TEST(KinectStudioSkeletons, OfAFileThatWasCutShortAreReadWithAWarning) {
  const std::string sound = Recording(false);
  const SkeletonSequence sequence = Read(sound.substr(0, sound.size() - 0x6b2 - 1));
  EXPECT_EQ(sequence.frames.size(), 1u);
  ASSERT_FALSE(sequence.warnings.empty());
  EXPECT_NE(sequence.warnings[0].find("cut short"), std::string::npos);
}

TEST(KinectStudioSkeletons, LackJointsWithoutAPosition) {
  XefBodies bodies;
  bodies.Set(0, 1, std::numeric_limits<float>::quiet_NaN()).Set(1, 2, 0.5F);
  XefWriter writer;
  writer.AddStream(1, "Nui Body Frame", XefWriter::kBodies).AddEvent(1, 0, 0, bodies.bytes());
  const SkeletonSequence sequence = Read(writer.Finish());
  ASSERT_EQ(sequence.frames[0].bodies.size(), 2u);
  EXPECT_FALSE(sequence.frames[0].bodies[0].joints[Joint::kHead].has_value());
  EXPECT_TRUE(sequence.frames[0].bodies[1].joints[Joint::kHead].has_value());
}

TEST(KinectStudioSkeletons, AreMissedByName) {
  XefWriter writer;
  writer.AddStream(1, "Nui Depth", XefWriter::kDepth);
  ExpectRefused([&] { Read(writer.Finish()); }, "none in its streams: Nui Depth");
}

}  // namespace
}  // namespace ossa::recon
