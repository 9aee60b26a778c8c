#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "depth/base/checksummed_container.h"
#include "depth/base/naming_the_file.h"
#include "recon/fit/surface_fit.h"

namespace ossa::recon {
namespace {

constexpr ContainerFormat kPersonFormat = {
    {'O', 'S', 'S', 'A', 'P', 'E', '0', '0'}, 1, "person file"};
// Constants: bounds of a file's values, by hand.
constexpr double kLargestShape = 10.0;  // standard deviations
constexpr double kLargestSum =
    1e12;  // of informations, 1 / standard deviations^2, and votes; by hand
constexpr int kMostFrames = 1'000'000'000;

// Standard deviation of stature errors that no number of frames reduces: hair, soles, and bodies
// outside the learned shape space. On rendered people of train shapes (`ossa experiment fit`,
// docs/benchmarks).
constexpr double kStatureModel_m = 0.02;

double GetNumber(PayloadReader& in, const char* field, double least, double most) {
  const auto value = in.Get<double>(field);
  if (!(value >= least && value <= most)) {
    in.Fail(field, fmt::format("expected a number from {} to {}", least, most));
  }
  return value;
}

template <typename Matrix>
Matrix GetNumbers(PayloadReader& in, const char* field, double largest) {
  Matrix values;
  for (double& value : values.reshaped()) value = GetNumber(in, field, -largest, largest);
  return values;
}

// Identifies a body surface: shape components are meaningful only with it.
std::array<float, 1 + kShapeCount> MarkOf(const BodySurface& surface) {
  std::array<float, 1 + kShapeCount> mark{};
  mark[0] = static_cast<float>(surface.stature_mean_m);
  for (size_t i = 1; i < mark.size(); ++i) {
    mark[i] = static_cast<float>(surface.stature_by_shape_m(static_cast<Eigen::Index>(i) - 1));
  }
  return mark;
}

void CheckInformation(PayloadReader& in, const ShapeMatrix& information) {
  const bool is_symmetric = (information - information.transpose()).norm() <=
                            1e-6 * (1.0 + information.norm());  // by hand, rounding
  const ShapeMatrix sure = information + ShapeMatrix::Identity();
  if (is_symmetric && Eigen::LLT<ShapeMatrix>(sure).info() == Eigen::Success) return;
  in.Fail("information", "expected a covariance's inverse");
}

}  // namespace

void PersonShape::Add(const SurfaceFit& fit) {
  constexpr double kMostWeight = 600.0;  // by hand, frames: a well-known shape changes little
  const double added = std::max(0.0, fit.score);
  if (!(added > 0.0)) return;
  const double kept = std::min(1.0, (kMostWeight - added) / std::max(added, weight));
  information = kept * information + added * fit.shape_information;
  vote = kept * vote + added * fit.shape_vote;
  weight = std::min(kMostWeight, weight + added);
  shape += added / weight * (fit.pose.shape - shape);
  ++frames;
}

ShapeVector PersonShape::Likeliest() const {
  // The shape prior (mean body) counts once.
  const Eigen::LLT<ShapeMatrix> solver(information + ShapeMatrix::Identity());
  return solver.info() == Eigen::Success ? ShapeVector(solver.solve(vote)) : shape;
}

ShapeMatrix PersonShape::Covariance() const {
  const ShapeMatrix of_one = information / std::max(1.0, weight);
  const Eigen::LLT<ShapeMatrix> solver(of_one + ShapeMatrix::Identity());
  return solver.solve(ShapeMatrix::Identity());
}

Stature MeasureStature(const PersonShape& person, const BodySurface& surface) {
  const ShapeVector& by_shape_m = surface.stature_by_shape_m;
  const double variance_m2 = by_shape_m.dot(person.Covariance() * by_shape_m);
  return {surface.Stature_m(person.Likeliest()),
          std::sqrt(kStatureModel_m * kStatureModel_m + variance_m2)};
}

void PersonShape::Save(const std::filesystem::path& path, const BodySurface& surface) const {
  PayloadWriter out;
  for (const float value : MarkOf(surface)) out.Put(value);
  for (const double value : shape) out.Put(value);
  for (const double value : information.reshaped()) out.Put(value);
  for (const double value : vote) out.Put(value);
  out.Put(weight);
  out.Put(static_cast<int32_t>(frames));
  WriteContainer(path, kPersonFormat, out.bytes());
}

bool PersonShape::IsFile(const std::filesystem::path& path) {
  return IsContainer(path, kPersonFormat);
}

PersonShape PersonShape::Load(const std::filesystem::path& path, const BodySurface& surface) {
  return NamingTheFile(
      path, [&] { return FromBytes(ReadContainer(path, kPersonFormat), path.string(), surface); });
}

PersonShape PersonShape::FromBytes(std::span<const std::byte> bytes, const std::string& name,
                                   const BodySurface& surface) {
  PayloadReader in(bytes, name);
  for (const float value : MarkOf(surface)) {
    if (in.Get<float>("body") != value) {
      in.Fail("body", "expected a person measured with this body surface, found another's");
    }
  }
  PersonShape person;
  person.shape = GetNumbers<ShapeVector>(in, "shape", kLargestShape);
  person.information = GetNumbers<ShapeMatrix>(in, "information", kLargestSum);
  CheckInformation(in, person.information);
  person.vote = GetNumbers<ShapeVector>(in, "vote", kLargestSum);
  person.weight = GetNumber(in, "weight", 0.0, kLargestSum);
  person.frames = in.Get<int32_t>("frames");
  if (person.frames < 0 || person.frames > kMostFrames) {
    in.Fail("frames", fmt::format("expected 0 to {}", kMostFrames));
  }
  in.ExpectEnd();
  return person;
}

}  // namespace ossa::recon
