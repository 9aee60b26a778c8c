#include "recon/fit/body_surface.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>

#include "depth/base/checksummed_container.h"
#include "depth/base/naming_the_file.h"
#include "recon/body/parts.h"

namespace ossa::recon {
namespace {

// Constants: bounds, by hand: no body is larger, and no rotation exceeds half a turn.

constexpr ContainerFormat kSurfaceFormat = {
    {'O', 'S', 'S', 'A', 'S', 'F', '0', '0'}, BodySurface::kVersion, "body surface"};
constexpr double kLargest_m = 3.0;
constexpr double kLargestTurn_rad = 3.15;
constexpr double kLargestInformation = 1e6;  // 1 / rad^2

// Stored as float: a hundredth of a millimetre is finer than any body is known.
template <typename Matrix>
void Put(PayloadWriter& out, const Matrix& values) {
  for (Eigen::Index i = 0; i < values.size(); ++i) out.Put(static_cast<float>(values(i)));
}

template <typename Matrix>
Matrix Get(PayloadReader& in, const char* field, double largest) {
  Matrix values;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values(i) = static_cast<double>(in.Get<float>(field));
    if (!(std::abs(values(i)) <= largest)) {
      in.Fail(field, fmt::format("expected a number within {}", largest));
    }
  }
  return values;
}

void Put(PayloadWriter& out, const ShapedPlace& place) {
  Put(out, place.mean_m);
  Put(out, place.by_shape_m);
}

ShapedPlace GetPlace(PayloadReader& in, const char* field) {
  ShapedPlace place;
  place.mean_m = Get<Eigen::Vector3d>(in, field, kLargest_m);
  place.by_shape_m = Get<ShapeBasis>(in, field, kLargest_m);
  return place;
}

uint8_t GetNumber(PayloadReader& in, const char* field, size_t least, size_t most) {
  const auto number = in.Get<uint8_t>(field);
  if (number < least || number > most) {
    in.Fail(field, fmt::format("expected {} to {}", least, most));
  }
  return number;
}

void GetTurns(PayloadReader& in, BodySurface& surface) {
  for (size_t s = 0; s < kSegmentCount; ++s) {
    surface.turn_mean[s] = Get<Eigen::Vector3d>(in, "mean turn", kLargestTurn_rad);
    const auto information =
        Get<Eigen::Matrix3d>(in, "information of the turn", kLargestInformation);
    surface.turn_information[s] = 0.5 * (information + information.transpose());
    if (Eigen::LLT<Eigen::Matrix3d>(surface.turn_information[s]).info() != Eigen::Success) {
      in.Fail("information of the turn", "expected a positive definite matrix");
    }
  }
}

void GetPoints(PayloadReader& in, BodySurface& surface) {
  const auto count = in.Get<uint32_t>("points");
  if (count < 1 || count > BodySurface::kMostPoints) {
    in.Fail("points", fmt::format("expected 1 to {}", BodySurface::kMostPoints));
  }
  for (uint32_t i = 0; i < count; ++i) {
    SurfacePoint point;
    point.segment = GetNumber(in, "segment of a point", 0, kSegmentCount - 1);
    point.part = GetNumber(in, "part of a point", 1, kPartCount);
    if (!surface.points.empty() && point.part < surface.points.back().part) {
      in.Fail("part of a point", "expected points in the order of their parts");
    }
    point.place = GetPlace(in, "place of a point");
    point.normal = Get<Eigen::Vector3d>(in, "normal of a point", 1.01);
    surface.points.push_back(point);
  }
}

}  // namespace

void BodySurface::Save(const std::filesystem::path& path) const {
  PayloadWriter out;
  for (const ShapedPlace& place : joint) Put(out, place);
  for (size_t s = 0; s < kSegmentCount; ++s) {
    Put(out, turn_mean[s]);
    Put(out, turn_information[s]);
  }
  for (size_t j = 0; j < kJointCount; ++j) {
    out.Put(landmark_segment[j]);
    Put(out, landmark[j]);
  }
  out.Put(static_cast<float>(stature_mean_m));
  Put(out, stature_by_shape_m);
  out.Put(static_cast<uint32_t>(points.size()));
  for (const SurfacePoint& point : points) {
    out.Put(point.segment);
    out.Put(point.part);
    Put(out, point.place);
    Put(out, point.normal);
  }
  WriteContainer(path, kSurfaceFormat, out.bytes());
}

bool BodySurface::IsFile(const std::filesystem::path& path) {
  return IsContainer(path, kSurfaceFormat);
}

BodySurface BodySurface::Load(const std::filesystem::path& path) {
  return NamingTheFile(
      path, [&] { return FromBytes(ReadContainer(path, kSurfaceFormat), path.string()); });
}

BodySurface BodySurface::FromBytes(std::span<const std::byte> bytes, const std::string& name) {
  PayloadReader in(bytes, name);
  BodySurface surface;
  for (ShapedPlace& place : surface.joint) place = GetPlace(in, "joint");
  GetTurns(in, surface);
  for (size_t j = 0; j < kJointCount; ++j) {
    surface.landmark_segment[j] = GetNumber(in, "segment of a landmark", 0, kSegmentCount - 1);
    surface.landmark[j] = GetPlace(in, "landmark");
  }
  surface.stature_mean_m = Get<Eigen::Matrix<double, 1, 1>>(in, "stature", kLargest_m)(0);
  surface.stature_by_shape_m = Get<ShapeVector>(in, "stature", kLargest_m);
  GetPoints(in, surface);
  in.ExpectEnd();
  return surface;
}

}  // namespace ossa::recon
