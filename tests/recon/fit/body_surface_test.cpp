#include "recon/fit/body_surface.h"

#include <filesystem>

#include "depth/base/checksummed_container.h"
#include "depth/base/error.h"
#include "tests/recon/fit/posed_person.h"

namespace ossa::recon {
namespace {

std::filesystem::path TemporaryFile() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  return std::filesystem::temp_directory_path() /
         (std::string("ossa_body_surface_") + test->name() + ".ossasurface");
}

std::vector<std::byte> Payload(const std::filesystem::path& path) {
  return ReadContainer(path, {{'O', 'S', 'S', 'A', 'S', 'F', '0', '0'}, 1, "body surface"});
}

TEST(BodySurface, ShippedSurfaceIsSmallAndOfAnAdult) {
  const auto path = test::SourceFolder() / "tools/tracker/shipped" / kShippedSurface;
  EXPECT_LT(std::filesystem::file_size(path), 3'000'000U);
  EXPECT_NEAR(Surface().stature_mean_m, 1.65, 0.1);
  EXPECT_GE(Surface().points.size(), 400U);
}

TEST(BodySurface, IsReadAsWritten) {
  const auto path = TemporaryFile();
  Surface().Save(path);
  const BodySurface read = BodySurface::Load(path);
  ASSERT_EQ(read.points.size(), Surface().points.size());
  EXPECT_EQ(read.points.back().place.by_shape_m, Surface().points.back().place.by_shape_m);
  EXPECT_EQ(read.turn_mean, Surface().turn_mean);
  EXPECT_TRUE(BodySurface::IsFile(path));
  std::filesystem::remove(path);
}

// Wherever it is cut, the byte is named.
TEST(BodySurface, RefusesATruncatedFile) {
  const auto path = TemporaryFile();
  Surface().Save(path);
  const auto payload = Payload(path);
  for (const size_t kept : {size_t{0}, size_t{100}, payload.size() / 2, payload.size() - 1}) {
    try {
      BodySurface::FromBytes(std::span(payload).first(kept), "cut.ossasurface");
      FAIL() << kept;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("cut.ossasurface: byte"), std::string::npos);
    }
  }
  std::filesystem::remove(path);
}

TEST(BodySurface, RefusesNan) {
  const auto path = TemporaryFile();
  Surface().Save(path);
  auto payload = Payload(path);
  for (size_t k = 0; k < 4; ++k) payload[k] = std::byte{0xFF};  // a NaN
  EXPECT_THROW(BodySurface::FromBytes(payload, "nan.ossasurface"), InputError);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace ossa::recon
