#include "recon/files/skeleton_jsonl.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "depth/base/error.h"
#include "tests/recon/files/skeleton_examples.h"

namespace ossa::recon {
namespace {

TEST(SkeletonJsonl, WritesExactlyTheDocumentedLine) {
  SkeletonFrame frame;
  frame.frame = 3;
  frame.time_s = 0.1;
  frame.floor = Eigen::Vector4d(0, 1, 0, 0.75);
  BodyRecord body;
  body.id = 2;
  JointRecord head;
  head.position_m = {-0.25, 0.5, 2.125};
  head.state = TrackingState::kInferred;
  head.confidence = 0.93;
  head.reliability = 0.88;
  head.orientation = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
  head.visible = false;
  head.sigma_m = Eigen::Vector3d(0.01, 0.02, 0.03);
  body.joints[Joint::kHead] = head;
  frame.bodies.push_back(body);
  EXPECT_EQ(SkeletonJsonLine(frame),
            R"({"frame":3,"time_s":0.1,"floor":[0,1,0,0.75],"bodies":[{"id":2,"joints":{"Head":)"
            R"({"p":[-0.25,0.5,2.125],"state":"inferred","confidence":0.93,"reliability":0.88,)"
            R"("q":[0.5,-0.5,0.5,0.5],"visible":false,"sigma":[0.01,0.02,0.03]}}}]})");
}

TEST(SkeletonJsonl, ReadsBackEveryField) {
  SkeletonSequence written = ExampleSequence(5, 2);
  written.frames[1].floor.reset();
  written.frames[2].bodies.clear();
  BoneLengths& bones_m = written.frames[3].bodies[0].bones_m.emplace();
  for (size_t i = 1; i < kJointCount; ++i) bones_m[i] = 0.1 + 0.01 * static_cast<double>(i);
  written.frames[3].bodies[0].joints[Joint::kHead]->sigma_m = Eigen::Vector3d(0.01, 0.02, 0.03);
  std::stringstream stream;
  SkeletonJsonlWriter writer(stream);
  for (const SkeletonFrame& frame : written.frames) writer.Write(frame);
  const SkeletonSequence read = ReadSkeletonJsonl(stream, "x");
  ASSERT_EQ(read.frames.size(), written.frames.size());
  for (size_t f = 0; f < read.frames.size(); ++f) {
    // Equal text means equal to the seventh digit of a metre in every field.
    EXPECT_EQ(SkeletonJsonLine(read.frames[f]), SkeletonJsonLine(written.frames[f]));
  }
  EXPECT_EQ(read.frames[3].bodies[0].joints[Joint::kHead]->sigma_m,
            Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_FALSE(read.frames[3].bodies[1].bones_m);
  ASSERT_TRUE(read.frames[3].bodies[0].bones_m);
  EXPECT_NEAR(read.frames[3].bodies[0].bones_m->back(), bones_m.back(), 1e-7);
}

TEST(SkeletonJsonl, RequiresUnitNormalsOfFloors) {
  const auto floor_of = [](const std::string& numbers) {
    std::istringstream text("{\"frame\":0,\"time_s\":0,\"floor\":" + numbers + ",\"bodies\":[]}\n");
    return ReadSkeletonJsonl(text, "x").frames[0].floor;
  };
  EXPECT_EQ(floor_of("[0,2,0,1.5]"), Eigen::Vector4d(0, 1, 0, 0.75));
  EXPECT_EQ(floor_of("[0,0.99999,0,0.75]"), Eigen::Vector4d(0, 0.99999, 0, 0.75));  // few digits
  EXPECT_FALSE(floor_of("[0,0,0,0]"));
}

TEST(SkeletonJsonl, NeverWritesUnreadableNumbers) {
  SkeletonFrame frame;
  frame.time_s = std::nan("");
  EXPECT_THROW(SkeletonJsonLine(frame), std::invalid_argument);
}

TEST(SkeletonJsonl, MayHaveObjectsBesidePeople) {
  std::istringstream text(
      R"({"frame":0,"time_s":0,"bodies":[{"id":1,"joints":{"Head":{"p":[0,1,2]}}}],)"
      R"("objects":[{"name":"p","p":[0,0,1],"q":[1,0,0,0]}]})"
      "\n");
  EXPECT_EQ(ReadSkeletonJsonl(text, "x").frames.size(), 1u);
}

std::string WithJoint(const std::string& joint) {
  return R"({"frame":0,"time_s":0,"bodies":[]})"
         "\n"
         R"({"frame":1,"time_s":0.1,"bodies":[{"id":1,"joints":{)" +
         joint + "}}]}\n";
}

struct BadLine {
  std::string text;
  std::string named;
};

class BadJsonl : public testing::TestWithParam<BadLine> {};

TEST_P(BadJsonl, IsRefusedInOneLineWithLineAndExpectation) {
  SkeletonReadOptions options;
  options.format = "jsonl";
  const std::string complaint = ComplaintAbout(GetParam().text, options, "walk.jsonl");
  EXPECT_TRUE(complaint.starts_with("walk.jsonl: line ")) << complaint;
  EXPECT_NE(complaint.find("expected"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find(GetParam().named), std::string::npos) << complaint;
  EXPECT_EQ(complaint.find('\n'), std::string::npos);
  EXPECT_LT(complaint.size(), 250u);
}

INSTANTIATE_TEST_SUITE_P(
    EveryRule, BadJsonl,
    testing::Values(
        BadLine{WithJoint(R"("Head":{"p":[1,2,3],"sigma":[0.1,-0.1,0.1]})"),
                "lengths of 0 m to 1000 km in Head.sigma"},
        BadLine{WithJoint(R"("Head":{"p":[1,2,3],"sigma":[0.1,1e160,0.1]})"),
                "lengths of 0 m to 1000 km in Head.sigma"},
        BadLine{R"({"frame":18446744073709551615,"time_s":1,"bodies":[]})",
                "a whole number in \"frame\""},
        BadLine{WithJoint(R"("Head":{"p":[1,2,3],"sigma":[0.1]})"), "3 numbers in Head.sigma"},
        BadLine{WithJoint(R"("Head":{"p":[1,2,NaN]})"),
                "line 2: expected one whole JSON object, found 'NaN]}}}]}' at byte 70"},
        BadLine{WithJoint(R"("Head":{"p":[1,2,1e999]})"), "line 2: expected numbers of at most"},
        BadLine{R"({"frame":0,"time_s":)", "found the end of the line at byte 21"},
        BadLine{WithJoint(R"("Head":{"p":[1,2,3]},"Head":{"p":[1,2,4]})"),
                "line 2: expected each key of an object once, found 'Head'"},
        BadLine{WithJoint(R"("Head":{"p":[1,2,3],"p":[1,2,4]})"), "each key of an object once"},
        BadLine{WithJoint(R"("Head":{"p":[1,2]})"), "3 numbers in Head.p"},
        BadLine{WithJoint(R"("Head":{"p":[1,2,"3"]})"), "finite number in Head.p"},
        BadLine{WithJoint(R"("Head":{"state":"tracked"})"), "\"p\" in Head"},
        BadLine{WithJoint(R"("SpineBase":{"p":[1,2,3]})"), "one of the 20 SDK joint names"},
        BadLine{WithJoint(R"("Head":{"p":[1,2,3],"state":"lost"})"), "Head.state"},
        BadLine{WithJoint(R"("Head":{"p":[1,2,3],"confidence":1.5})"), "Head.confidence"},
        BadLine{WithJoint(R"("Head":{"p":[1,2,3],"q":[2,0,0,0]})"), "unit quaternion"},
        BadLine{WithJoint(R"("Head":{"p":[1,2,3],"visible":1})"), "true or false"},
        BadLine{WithJoint(R"("Head":{"p":[1,2,3])"), "line 2"},
        BadLine{R"({"time_s":0,"bodies":[]})", "\"frame\""},
        BadLine{R"({"frame":0,"bodies":[]})", "\"time_s\""},
        BadLine{R"({"frame":0,"time_s":0})", "\"bodies\""},
        BadLine{R"({"frame":0,"time_s":0,"bodies":[{"id":1,"joints":{}},{"id":1,"joints":{}}]})",
                "used once"},
        BadLine{R"({"frame":0,"time_s":0,"bodies":[{"id":1,"joints":{},"bones":[1,2]}]})",
                "19 numbers in \"bones\""},
        BadLine{R"({"frame":0,"time_s":0,"bodies":[{"id":1,"joints":{},"bones":)"
                R"([1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,0]}]})",
                "lengths of 0 to 2 m"},
        BadLine{"[1,2]\n", "JSON object"}, BadLine{"", "end of the file"},
        BadLine{std::string(1000, '[') + std::string(1000, ']'), "32 deep"},
        BadLine{std::string((size_t{1} << 20) + 10, 'x'), "1 MiB"},
        BadLine{std::string("\x00\xff\x01\x02", 4), "JSON"}));

TEST(SkeletonJsonl, StreamsFramesAndSkipsUnknownKeys) {
  std::istringstream stream(
      "{\"frame\":0,\"time_s\":0,\"bodies\":[],\"later\":1}\n\n"
      "{\"frame\":1,\"time_s\":1,\"bodies\":[]}");
  SkeletonJsonlReader reader(stream, "x");
  SkeletonFrame frame;
  EXPECT_TRUE(reader.Next(frame));
  EXPECT_TRUE(reader.Next(frame));
  EXPECT_EQ(frame.frame, 1);
  EXPECT_FALSE(reader.Next(frame));
}

TEST(TrackedPostureOfABody, FillsStatesAndConfidencesAsDocumented) {
  BodyRecord body;
  body.joints[0] = JointRecord{};
  body.joints[1] = JointRecord{};
  body.joints[1]->state = TrackingState::kInferred;
  body.joints[2] = JointRecord{};
  body.joints[2]->confidence = 0.3;
  const TrackedPosture tracked = ToTrackedPosture(body);
  EXPECT_EQ(tracked.state[0], TrackingState::kTracked);
  EXPECT_EQ(tracked.confidence[0], 1.0);
  EXPECT_EQ(tracked.confidence[1], 0.5);
  EXPECT_EQ(tracked.confidence[2], 0.3);
  EXPECT_EQ(tracked.state[3], TrackingState::kNotTracked);
  EXPECT_EQ(tracked.confidence[3], 0.0);
}

}  // namespace
}  // namespace ossa::recon
