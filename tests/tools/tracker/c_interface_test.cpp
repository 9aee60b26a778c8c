// The tracker through its C header.
#include "ossa/ossa_c.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "depth/image/depth_png.h"
#include "recon/refine/refinement_cascade.h"
#include "tests/support/depth_examples.h"
#include "tests/support/perceptrons.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/tracker/walk_in_c.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {
namespace {

using test::ImageOf;
using test::PlainOptionsInC;
using test::Says;
using test::WalkInC;
using tests::CapsuleRender;

TEST(CInterface, CProgramTracksAndChoosesUsers) {
  OSSA_NEEDS_MODEL();
  WalkInC walk;
  ASSERT_NE(walk.tracker, nullptr) << ossa_last_error();
  const ossa_body body = walk.Next();
  EXPECT_EQ(body.state, OSSA_FULLY_TRACKED);
  EXPECT_EQ(body.joints[OSSA_HEAD].state, OSSA_TRACKED);
  EXPECT_EQ(walk.frame.has_floor, 1);
  const auto* const users_end = walk.frame.users + 320 * 240;
  EXPECT_NE(std::find(walk.frame.users, users_end, body.id), users_end);
  const int32_t nobody = 0;
  EXPECT_EQ(ossa_tracker_choose_users(walk.tracker, &nobody, 1), OSSA_OK);
  EXPECT_EQ(walk.Next().state, OSSA_POSITION_ONLY);
}

TEST(CInterface, ReturnsJointNamesAndVersion) {
  EXPECT_STREQ(ossa_joint_name(OSSA_WRIST_RIGHT), "WristRight");
  EXPECT_EQ(ossa_joint_parent(OSSA_WRIST_RIGHT), OSSA_ELBOW_RIGHT);
  EXPECT_EQ(ossa_joint_parent(OSSA_HIP_CENTER), -1);
  EXPECT_EQ(ossa_joint_name(OSSA_JOINT_COUNT), nullptr);
  EXPECT_STREQ(ossa_version(), Version());
}

TEST(CInterface, ResetDeletesAllPeople) {
  OSSA_NEEDS_MODEL();
  WalkInC walk;
  walk.Next();
  const CapsuleRender two = Rendered({PersonAt(-0.6, 2.5), PersonAt(0.6, 2.8)});
  ossa_depth_image image = ImageOf(two.frame);
  EXPECT_EQ(ossa_tracker_reset(walk.tracker), OSSA_OK);
  ossa_body body{};
  body.struct_size = sizeof body;
  EXPECT_EQ(ossa_tracker_body(walk.tracker, 0, &body), OSSA_FAILED) << "nobody is left";
  // Time goes back and two people are there at once, as at the beginning of any recording.
  ASSERT_EQ(ossa_tracker_track(walk.tracker, &image, &walk.frame), OSSA_OK) << ossa_last_error();
  EXPECT_EQ(walk.frame.body_count, 2);
}

TEST(CInterface, SeatedModeAndSmoothingChangeWhileRunning) {
  OSSA_NEEDS_MODEL();
  WalkInC walk;
  ASSERT_NE(walk.tracker, nullptr) << ossa_last_error();
  EXPECT_NE(walk.SpineState(), OSSA_NOT_TRACKED);
  EXPECT_EQ(ossa_tracker_set_seated(walk.tracker, 1), OSSA_OK);
  EXPECT_EQ(walk.SpineState(), OSSA_NOT_TRACKED);
  EXPECT_EQ(ossa_tracker_set_seated(walk.tracker, 0), OSSA_OK);
  EXPECT_NE(walk.SpineState(), OSSA_NOT_TRACKED);
  EXPECT_EQ(walk.SmoothedBy_m(), 0.0F);
  EXPECT_EQ(ossa_tracker_set_smoothing(walk.tracker, "verysmooth"), OSSA_OK);
  walk.SmoothedBy_m();  // the filter starts with what it sees
  EXPECT_GT(walk.SmoothedBy_m(), 1e-4F);
  // The SDK's parameters: never farther off than the last of them (single precision).
  const ossa_smooth_parameters near_raw = {
      sizeof(ossa_smooth_parameters), 0.7F, 0.3F, 1.0F, 1.0F, 0.001F};
  EXPECT_EQ(ossa_tracker_set_smooth_parameters(walk.tracker, &near_raw), OSSA_OK);
  const float moved_m = walk.SmoothedBy_m();
  EXPECT_GT(moved_m, 0.0F);
  EXPECT_LT(moved_m, 0.00101F);
  EXPECT_EQ(ossa_tracker_set_smoothing(walk.tracker, "none"), OSSA_OK);
  EXPECT_EQ(walk.SmoothedBy_m(), 0.0F);
}

TEST(CInterface, InvalidModesAndSmoothingHaveMessages) {
  OSSA_NEEDS_MODEL();
  WalkInC walk;
  EXPECT_EQ(ossa_tracker_set_smoothing(walk.tracker, "treacle"), OSSA_FAILED);
  EXPECT_TRUE(Says("treacle")) << ossa_last_error();
  const ossa_smooth_parameters stuck = {
      sizeof(ossa_smooth_parameters), 1.0F, 0.5F, 0.5F, 0.05F, 0.04F};
  EXPECT_EQ(ossa_tracker_set_smooth_parameters(walk.tracker, &stuck), OSSA_FAILED);
  EXPECT_TRUE(Says("smoothing = 1")) << ossa_last_error();
  walk.SmoothedBy_m();
  EXPECT_EQ(walk.SmoothedBy_m(), 0.0F) << "as it was";
  EXPECT_EQ(ossa_tracker_set_seated(nullptr, 1), OSSA_FAILED);
  EXPECT_EQ(ossa_tracker_set_smoothing(walk.tracker, nullptr), OSSA_FAILED);
  EXPECT_EQ(ossa_tracker_set_smooth_parameters(walk.tracker, nullptr), OSSA_FAILED);
  EXPECT_TRUE(Says("ossa_tracker_set_smooth_parameters: expected parameters, found NULL"));
}

TEST(CInterface, InvalidCameraIsRefused) {
  OSSA_NEEDS_MODEL();
  WalkInC walk;
  depth::DepthFrame frame = Rendered({}).frame;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double f : {0.0, -287.5, kNan, std::numeric_limits<double>::infinity(), 1e-300}) {
    frame.camera.fx = f;
    const ossa_depth_image image = ImageOf(frame);
    EXPECT_EQ(ossa_tracker_track(walk.tracker, &image, &walk.frame), OSSA_FAILED) << f;
    EXPECT_TRUE(Says("\"fx\"")) << ossa_last_error();
  }
}

TEST(CInterface, FailuresHaveMessages) {
  ossa_options options{};
  options.struct_size = sizeof options;
  options.model = "/nowhere/model.ossa";
  EXPECT_EQ(ossa_tracker_create(&options), nullptr);
  EXPECT_TRUE(Says("/nowhere/model.ossa")) << ossa_last_error();
  EXPECT_EQ(ossa_tracker_track(nullptr, nullptr, nullptr), OSSA_FAILED);
  EXPECT_EQ(ossa_source_open("/nowhere.oni", nullptr), nullptr);
  EXPECT_TRUE(Says("/nowhere.oni")) << ossa_last_error();
}

TEST(CInterface, FileThatTheMethodDoesNotReadIsRefused) {
  ossa_options options = PlainOptionsInC();
  options.struct_size = sizeof options;
  options.method = "holt";
  options.prior = "none";
  options.database = "/nowhere/x.ossadb";
  EXPECT_EQ(ossa_tracker_create(&options), nullptr);
  EXPECT_TRUE(Says("ossa_options.database: expected a method that reads it, found 'holt'"))
      << ossa_last_error();
}

TEST(CInterface, UnknownStructSizeIsRefused) {
  for (const uint32_t size :
       {0U, 4U, static_cast<uint32_t>(sizeof(ossa_options) - 1), 0xcdcdcdcdU}) {
    ossa_options options{};
    options.struct_size = size;
    EXPECT_EQ(ossa_tracker_create(&options), nullptr) << size;
    EXPECT_TRUE(Says("ossa_options.struct_size: expected")) << ossa_last_error();
  }
}

// Structs of earlier versions, without later members: those have their default, and nothing is
// written beyond the size that the program knows.
class EarlierOptions : public testing::TestWithParam<size_t> {};

TEST_P(EarlierOptions, AreAcceptedByTheirStructSize) {
  OSSA_NEEDS_MODEL();
  ossa_options options = PlainOptionsInC();
  options.struct_size = static_cast<uint32_t>(GetParam());
  std::memset(reinterpret_cast<char*>(&options) + GetParam(), 0x77, sizeof options - GetParam());
  ossa_tracker* tracker = ossa_tracker_create(&options);
  EXPECT_NE(tracker, nullptr) << ossa_last_error();
  EXPECT_EQ(ossa_tracker_rotation(tracker), 0);
  ossa_tracker_destroy(tracker);
}

// By sizeof in programs that were compiled then, x86-64.
INSTANTIATE_TEST_SUITE_P(Sizes, EarlierOptions, testing::Values(80, 96));

TEST(CInterface, ProgramOfAnEarlierVersionRuns) {
  OSSA_NEEDS_MODEL();
  constexpr size_t kFrame = 48, kBody = 1868;  // bytes, likewise
  WalkInC walk;
  walk.Next();
  const CapsuleRender render = Rendered({PersonAt(0.03, 2.5)}, 1);
  const ossa_depth_image image = ImageOf(render.frame);
  ossa_frame frame;
  std::memset(&frame, 0x77, sizeof frame);
  frame.struct_size = kFrame;
  ASSERT_EQ(ossa_tracker_track(walk.tracker, &image, &frame), OSSA_OK) << ossa_last_error();
  EXPECT_EQ(frame.body_count, 1);
  EXPECT_EQ(frame.index, 0x7777777777777777);
  ossa_body body;
  std::memset(&body, 0x77, sizeof body);
  body.struct_size = kBody;
  ASSERT_EQ(ossa_tracker_body(walk.tracker, 0, &body), OSSA_OK) << ossa_last_error();
  EXPECT_GT(body.joints[OSSA_HEAD].position_m[2], 1.0F);
  EXPECT_EQ(body.has_bones, 0x77777777);
}

// A camera that lies on its side: joints stay in its own space.
TEST(CInterface, RotatedImagesAreTracked) {
  OSSA_NEEDS_MODEL();
  ossa_options options = PlainOptionsInC();
  options.rotate = "90";
  WalkInC walk(options);
  ASSERT_NE(walk.tracker, nullptr) << ossa_last_error();
  EXPECT_EQ(ossa_tracker_rotation(walk.tracker), 90);
  for (const char* wrong : {"45", ""}) {
    options.rotate = wrong;
    EXPECT_EQ(ossa_tracker_create(&options), nullptr);
    EXPECT_TRUE(Says("ossa_options.rotate: expected 0, 90, 180, 270, auto, found '"))
        << ossa_last_error();
  }
  options.rotate = nullptr;
  options.mount = "wall";
  EXPECT_EQ(ossa_tracker_create(&options), nullptr);
  EXPECT_TRUE(Says("ossa_options.mount: expected auto, level, ceiling, found 'wall'"));
}

// A struct of a program that was compiled with the header of a later version.
template <typename T>
struct Later {
  T known{};
  uint64_t added = 0;
};

TEST(CInterface, UnknownMembersMustBeZero) {
  OSSA_NEEDS_MODEL();
  Later<ossa_options> options{PlainOptionsInC(), 0};
  options.known.struct_size = sizeof options;
  ossa_tracker* tracker = ossa_tracker_create(&options.known);
  EXPECT_NE(tracker, nullptr) << ossa_last_error();
  ossa_tracker_destroy(tracker);
  options.added = 1;
  EXPECT_EQ(ossa_tracker_create(&options.known), nullptr);
  EXPECT_TRUE(Says("ossa_options: a member behind byte")) << ossa_last_error();
}

TEST(CInterface, WritesNothingBeyondTheStructSize) {
  OSSA_NEEDS_MODEL();
  WalkInC walk;
  walk.Next();
  Later<ossa_body> body{{}, 77};
  body.known.struct_size = sizeof body;
  EXPECT_EQ(ossa_tracker_body(walk.tracker, 0, &body.known), OSSA_OK) << ossa_last_error();
  EXPECT_GT(body.known.joints[OSSA_HEAD].position_m[2], 1.0F);
  EXPECT_EQ(body.known.struct_size, sizeof body);
  EXPECT_EQ(body.added, 77U);
}

TEST(CInterface, SourceIsReadToItsEnd) {
  const std::string clip = test::SourceFolder() / "tests/golden/clips/one";
  ossa_source* source = ossa_source_open(clip.c_str(), nullptr);
  ASSERT_NE(source, nullptr) << ossa_last_error();
  ossa_depth_image image{};
  image.struct_size = sizeof image;
  int frames = 0;
  double time_s = -1.0;
  ossa_status status = OSSA_OK;
  while ((status = ossa_source_read(source, 1000, &image)) == OSSA_OK) {
    ++frames;
    EXPECT_GT(image.time_s, time_s);
    time_s = image.time_s;
    ASSERT_NE(image.depth_mm, nullptr);
  }
  EXPECT_EQ(status, OSSA_END) << ossa_last_error();
  EXPECT_GT(frames, 10);
  EXPECT_GT(image.fx, 100.0);
  ossa_source_close(source);
}

// The same text as the command prints on stderr.
TEST(CInterface, SourceReturnsItsNotes) {
  const test::TemporaryFolder folder;
  test::WriteExampleFolder(folder.path(), 2, 64, 48);
  depth::WriteDepthPng(folder / "x.png", test::ExampleFrame(1, 32, 24).view());
  ossa_source* source = ossa_source_open(folder.path().c_str(), nullptr);
  ASSERT_NE(source, nullptr) << ossa_last_error();
  EXPECT_EQ(ossa_source_frame_count(source), 3);
  int32_t kind = -1;
  const char* note = ossa_source_take_note(source, &kind);
  ASSERT_NE(note, nullptr);
  EXPECT_NE(std::string(note).find("camera"), std::string::npos) << note;
  EXPECT_EQ(kind, OSSA_NOTE_INFO);
  ossa_depth_image image{};
  image.struct_size = sizeof image;
  while (ossa_source_read(source, 1000, &image) == OSSA_OK) {
  }
  std::string last;
  while ((note = ossa_source_take_note(source, &kind)) != nullptr) last = note;
  EXPECT_NE(last.find("skipped 1 of 3 frames"), std::string::npos) << last;
  EXPECT_EQ(kind, OSSA_NOTE_WARNING);
  EXPECT_EQ(ossa_source_dropped(source), 1);
  ossa_source_close(source);
}

TEST(CInterface, TrackerReturnsWarningsOfItsModels) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const std::string file = folder / "other.ossarefine";
  recon::RefinementCascade other;
  other.stages.emplace_back().fill(test::SilentPerceptron({recon::kStageFeatures, 3}));
  other.forest_checksum = 1;
  other.Save(file);
  ossa_options options = PlainOptionsInC();
  options.refinement = file.c_str();
  ossa_tracker* tracker = ossa_tracker_create(&options);
  ASSERT_NE(tracker, nullptr) << ossa_last_error();
  int32_t kind = -1;
  const char* note = ossa_tracker_take_note(tracker, &kind);
  ASSERT_NE(note, nullptr);
  EXPECT_NE(std::string(note).find("other.ossarefine: learned at"), std::string::npos) << note;
  EXPECT_EQ(kind, OSSA_NOTE_WARNING);
  EXPECT_EQ(ossa_tracker_take_note(tracker, nullptr), nullptr);
  EXPECT_EQ(ossa_tracker_take_note(nullptr, nullptr), nullptr);
  ossa_tracker_destroy(tracker);
}

TEST(CInterface, SourceAcceptsANamedCamera) {
  const std::string clip = test::SourceFolder() / "tests/golden/clips/one/depth";
  ossa_source_options options{};
  options.struct_size = sizeof options;
  options.camera = "301,302,160,120";
  ossa_source* source = ossa_source_open(clip.c_str(), &options);
  ASSERT_NE(source, nullptr) << ossa_last_error();
  ossa_depth_image image{};
  image.struct_size = sizeof image;
  EXPECT_EQ(ossa_source_read(source, 1000, &image), OSSA_OK) << ossa_last_error();
  EXPECT_EQ(image.fx, 301.0);
  ossa_source_close(source);
  options.depth_scale = -1.0;
  EXPECT_EQ(ossa_source_open(clip.c_str(), &options), nullptr);
  EXPECT_TRUE(Says("depth_scale")) << ossa_last_error();
  options.camera = "no-such-camera";
  EXPECT_EQ(ossa_source_open(clip.c_str(), &options), nullptr);
  EXPECT_TRUE(Says("no-such-camera")) << ossa_last_error();
}

}  // namespace
}  // namespace ossa::tracker
