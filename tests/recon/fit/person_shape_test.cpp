#include <filesystem>
#include <functional>

#include "depth/base/checksummed_container.h"
#include "depth/base/error.h"
#include "tests/recon/fit/posed_person.h"

namespace ossa::recon {
namespace {

std::filesystem::path TemporaryFile() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  return std::filesystem::temp_directory_path() /
         (std::string("ossa_person_") + test->name() + ".ossaperson");
}

/// The shape learned from `frames` frames of a moving person, each fitted with the result so far.
PersonShape ToldBy(const ShapeVector& shape, int frames, PersonShape person = {}) {
  SurfaceFitter fitter(Surface());
  for (int i = 0; i < frames; ++i) {
    SurfacePose pose = RandomPose(static_cast<unsigned>(40 + i));
    pose.shape = shape;
    const SeenSurface seen(pose);
    SurfaceFitInput input = seen.Input(Disturbed(seen.joints_m, 0.03, static_cast<unsigned>(i)));
    input.shape = person.shape;
    input.shape_frames = person.frames;
    const auto fit = fitter.Fit(input);
    if (fit) person.Add(*fit);
  }
  return person;
}

ShapeVector SomeShape() { return RandomPose(5).shape; }

TEST(PersonShape, ImprovesWithMoreFrames) {
  const PersonShape one = ToldBy(SomeShape(), 1), many = ToldBy(SomeShape(), 8);
  EXPECT_LT((many.Likeliest() - SomeShape()).norm(), (one.Likeliest() - SomeShape()).norm());
  EXPECT_EQ(many.frames, 8);
}

// Images of the model itself: stature is within its error bars.
TEST(PersonShape, StatureIsWithinItsStandardDeviations) {
  for (const double tall : {-1.5, 0.0, 1.5}) {
    const ShapeVector shape = tall * Surface().stature_by_shape_m.normalized();
    const Stature said = MeasureStature(ToldBy(shape, 6), Surface());
    EXPECT_NEAR(said.stature_m, Surface().Stature_m(shape), 2 * said.sigma_m);
    EXPECT_LT(said.sigma_m, 0.1);
  }
}

TEST(PersonShape, StartsWithThePriorOfThePopulation) {
  const Stature said = MeasureStature({}, Surface());
  EXPECT_EQ(said.stature_m, Surface().stature_mean_m);
  EXPECT_GE(said.sigma_m, Surface().stature_by_shape_m.norm());
}

// A frame without legs does not reduce the uncertainty of their length.
TEST(PersonShape, FrameWithoutInformationChangesNothing) {
  PersonShape person = ToldBy(SomeShape(), 3);
  const PersonShape before = person;
  SurfaceFit blind;
  blind.score = 1.0;
  person.Add(blind);
  EXPECT_LT((person.Likeliest() - before.Likeliest()).norm(), 1e-9);
}

TEST(PersonShape, IgnoresPoorFits) {
  PersonShape person = ToldBy(SomeShape(), 1);
  SurfaceFit poor;
  poor.score = -0.2;
  person.Add(poor);
  EXPECT_EQ(person.frames, 1);
}

TEST(PersonFile, IsReadAsWrittenAndCanBeUpdated) {
  const auto path = TemporaryFile();
  const PersonShape person = ToldBy(SomeShape(), 3);
  person.Save(path, Surface());
  EXPECT_TRUE(PersonShape::IsFile(path));
  const PersonShape read = PersonShape::Load(path, Surface());
  EXPECT_EQ(read.shape, person.shape);
  EXPECT_EQ(ToldBy(SomeShape(), 2, read).shape, ToldBy(SomeShape(), 2, person).shape);
  std::filesystem::remove(path);
}

void ExpectRefused(const std::function<void()>& read, const std::string& text) {
  try {
    read();
    FAIL() << text;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

TEST(PersonFile, FileOfAnotherBodyIsRefused) {
  const auto path = TemporaryFile();
  PersonShape().Save(path, Surface());
  BodySurface other = Surface();
  other.stature_mean_m += 0.01;
  ExpectRefused([&] { PersonShape::Load(path, other); }, path.string() + ": byte");
  std::filesystem::remove(path);
}

std::vector<std::byte> PayloadOf(const PersonShape& person) {
  const auto path = TemporaryFile();
  person.Save(path, Surface());
  auto payload = ReadContainer(path, {{'O', 'S', 'S', 'A', 'P', 'E', '0', '0'}, 1, "person file"});
  std::filesystem::remove(path);
  return payload;
}

TEST(PersonFile, EveryTruncationIsRefused) {
  const auto payload = PayloadOf({});
  for (const size_t kept : {size_t{0}, size_t{50}, payload.size() / 2, payload.size() - 1}) {
    ExpectRefused(
        [&] { PersonShape::FromBytes(std::span(payload).first(kept), "p.ossaperson", Surface()); },
        "p.ossaperson: byte");
  }
}

TEST(PersonFile, InvalidCovarianceIsRefused) {
  PersonShape person;
  person.information(2, 2) = -5.0;
  const auto payload = PayloadOf(person);
  ExpectRefused([&] { PersonShape::FromBytes(payload, "p.ossaperson", Surface()); }, "information");
}

TEST(PersonFile, ImplausibleShapeIsRefused) {
  PersonShape person;
  person.shape[3] = std::nan("");
  const auto payload = PayloadOf(person);
  ExpectRefused([&] { PersonShape::FromBytes(payload, "p.ossaperson", Surface()); }, "shape");
}

}  // namespace
}  // namespace ossa::recon
