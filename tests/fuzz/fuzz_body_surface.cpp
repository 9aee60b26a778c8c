// Body surfaces (.ossasurface) and person files (.ossaperson): any payload is a value or an
// InputError; what is read can be posed and measured.
#include <cmath>
#include <cstdint>

#include "recon/fit/posed_surface.h"
#include "recon/fit/surface_fit.h"
#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"
#include "tests/support/places.h"

namespace {

namespace recon = ossa::recon;
using recon::BodySurface;
using recon::PersonShape;

const BodySurface& Shipped() {
  static const BodySurface surface = BodySurface::Load(
      ossa::test::SourceFolder() / "tools/tracker/shipped" / recon::kShippedSurface);
  return surface;
}

void ReadSurface(std::span<const std::byte> bytes) {
  const BodySurface surface = BodySurface::FromBytes(bytes, "x.ossasurface");
  recon::PosedSurface posed(surface);
  posed.PosePoints();
  for (const Eigen::Vector3d& at_m : posed.at_m()) {
    if (!at_m.allFinite()) abort();
  }
}

void ReadPerson(std::span<const std::byte> bytes) {
  const PersonShape person = PersonShape::FromBytes(bytes, "x.ossaperson", Shipped());
  const recon::Stature stature = recon::MeasureStature(person, Shipped());
  if (!std::isfinite(stature.stature_m) || !std::isfinite(stature.sigma_m)) abort();
}

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  BodySurface few = Shipped();
  few.points.resize(2);
  const std::string path = ScratchPath("surface");
  few.Save(path);
  const std::string surface = TakePayload(path);
  PersonShape person;
  person.shape[0] = 1.0;
  person.information(0, 0) = 3.0;
  person.weight = 2.0;
  person.frames = 2;
  person.Save(path, Shipped());
  return {surface, TakePayload(path)};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  ossa::fuzz::ExpectValueOrOneLine([&] { ReadSurface(bytes); });
  ossa::fuzz::ExpectValueOrOneLine([&] { ReadPerson(bytes); });
  return 0;
}
