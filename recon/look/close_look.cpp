#include "recon/look/close_look.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "depth/clones.h"
#include "recon/look/bone_measure.h"

namespace ossa::recon {
namespace {

constexpr double kMostBehind_mm = 300.0;
constexpr double kNearer_mm = 30.0;  // by so much, something that is not the person is before it

// Where on the two grids the samples of a joint are, by grid, row and column.
struct Grids {
  std::array<double, kLookSamples> x_m{}, y_m{};
};

constexpr Grids MakeGrids() {
  Grids grids;
  size_t next = 0;
  for (const double step_m : kLookSteps_m) {
    for (int row = 0; row < kLookGrid; ++row) {
      for (int column = 0; column < kLookGrid; ++column, ++next) {
        grids.x_m[next] = (column - kLookGrid / 2) * step_m;
        grids.y_m[next] = (row - kLookGrid / 2) * step_m;
      }
    }
  }
  return grids;
}

// The samples of a joint as the camera has them.
struct Samples {
  std::array<double, kLookSamples> u{}, v{}, z_m{};  // in the image, and how far along its axis
  std::array<double, kLookSamples> slant{};          // way along the ray, for each metre of z
};

// As depth::Project, side by side.
OSSA_CLONES void Place(const depth::Camera& camera, const Eigen::Vector3d& joint_m,
                       const Eigen::Matrix3d& camera_from_frame, Samples* samples) {
  static constexpr Grids kGrids = MakeGrids();
  const double x_m = joint_m.x(), y_m = joint_m.y(), z_m = joint_m.z();
  const double xx = camera_from_frame(0, 0), xy = camera_from_frame(0, 1);
  const double yx = camera_from_frame(1, 0), yy = camera_from_frame(1, 1);
  const double zx = camera_from_frame(2, 0), zy = camera_from_frame(2, 1);
  const double fx = camera.fx, fy = camera.fy, cx = camera.cx, cy = camera.cy;
  for (size_t i = 0; i < kLookSamples; ++i) {
    const double right_m = kGrids.x_m[i], down_m = kGrids.y_m[i];
    const double z = z_m + zx * right_m + zy * down_m;
    const double tangent_x = (x_m + xx * right_m + xy * down_m) / z;
    const double tangent_y = (y_m + yx * right_m + yy * down_m) / z;
    samples->u[i] = cx - fx * tangent_x;
    samples->v[i] = cy - fy * tangent_y;
    samples->z_m[i] = z;
    samples->slant[i] = std::sqrt(1.0 + tangent_x * tangent_x + tangent_y * tangent_y);
  }
}

// The neighbourhood of places in an image.
class Sampler {
 public:
  Sampler(const LookInput& input, const Eigen::Matrix3d& frame_from_camera)
      : frame_(*input.depth),
        is_person_(input.is_person),
        camera_from_frame_(frame_from_camera.transpose()) {}

  std::array<int16_t, kLookSamples> Around(const Eigen::Vector3d& joint_m) {
    Place(frame_.camera, joint_m, camera_from_frame_, &samples_);
    std::array<int16_t, kLookSamples> behind_mm{};
    for (size_t i = 0; i < kLookSamples; ++i) behind_mm[i] = At(i);
    return behind_mm;
  }

 private:
  int16_t At(size_t sample) const {
    constexpr double kNearest_m = 0.2;  // what is nearer is beside the sensor
    const double z_m = samples_.z_m[sample];
    if (z_m < kNearest_m) return LookDescription::kHidden;
    const double right = samples_.u[sample], down = samples_.v[sample];
    const depth::DepthView view = frame_.view();
    // Compared as they are: a place far aside is a number that no int holds.
    if (!(right > -0.5 && right < view.width - 0.5 && down > -0.5 && down < view.height - 0.5)) {
      return LookDescription::kHidden;
    }
    const auto u = static_cast<int>(right + 0.5);
    const auto v = static_cast<int>(down + 0.5);
    const uint16_t depth_mm = view.at(u, v);
    if (depth_mm == 0) return LookDescription::kBeside;
    const double behind_mm = (depth_mm - 1e3 * z_m) * samples_.slant[sample];
    const auto index = static_cast<size_t>(v) * static_cast<size_t>(view.width);
    if (is_person_[index + static_cast<size_t>(u)] != 0) {
      return static_cast<int16_t>(std::clamp(behind_mm, -kMostBehind_mm, kMostBehind_mm));
    }
    return behind_mm < -kNearer_mm ? LookDescription::kHidden : LookDescription::kBeside;
  }

  const depth::DepthFrame& frame_;
  std::span<const uint8_t> is_person_;
  Eigen::Matrix3d camera_from_frame_;
  Samples samples_;
};

// The mean of the proposals, those of little confidence less.
Eigen::Vector3d MiddleOf(const LookInput& input) {
  constexpr double kLeastWeight = 0.05;
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  double whole = 0.0;
  for (size_t j = 0; j < kJointCount; ++j) {
    const double weight = std::max(kLeastWeight, input.confidence[j]);
    sum_m += weight * input.proposed.position_m[j];
    whole += weight;
  }
  return sum_m / whole;
}

bool CanBeLookedAt(const LookInput& input) {
  const depth::DepthFrame* frame = input.depth;
  if (frame == nullptr || frame->camera.width <= 0 || frame->camera.height <= 0 ||
      input.is_person.size() != frame->depth_mm.size() ||
      frame->depth_mm.size() !=
          static_cast<size_t>(frame->camera.width) * static_cast<size_t>(frame->camera.height)) {
    return false;
  }
  constexpr double kFarthest_m = 100.0;
  for (size_t j = 0; j < kJointCount; ++j) {
    if (!(input.proposed.position_m[j].norm() < kFarthest_m)) return false;
    if (!(input.moved.position_m[j].norm() < kFarthest_m)) return false;
    if (!(input.confidence[j] >= 0.0 && input.confidence[j] <= 1.0)) return false;
  }
  return true;
}

// Of a body at all, however small or large.
bool AreBones(const BoneLengths& lengths_m) {
  constexpr double kShortest_m = 1e-3, kLongest_m = 10.0;
  return std::all_of(lengths_m.begin() + 1, lengths_m.end(), [](double length_m) {
    return length_m >= kShortest_m && length_m <= kLongest_m;
  });
}

}  // namespace

LookInput LookInput::MovedTo(const Posture& joints_m) const {
  LookInput out = *this;
  for (size_t j = 0; j < kJointCount; ++j) {
    out.moved.position_m[j] += joints_m.position_m[j] - proposed.position_m[j];
  }
  out.proposed = joints_m;
  return out;
}

std::optional<ProposedPerson> ProposedPerson::Of(const LookInput& input) {
  if (!CanBeLookedAt(input)) return std::nullopt;
  ProposedPerson out;
  out.middle_m = MiddleOf(input);
  const Eigen::Vector3d z = out.middle_m.normalized();
  const Eigen::Vector3d level = Eigen::Vector3d::UnitY().cross(z);
  constexpr double kLeast = 1e-3;  // right above, below or behind the sensor nobody is seen
  if (!(out.middle_m.z() > 0.0 && level.norm() > kLeast)) return std::nullopt;
  const Eigen::Vector3d x = level.normalized();
  out.frame_from_camera << x.transpose(), z.cross(x).transpose(), z.transpose();
  for (size_t j = 0; j < kJointCount; ++j) {
    const Eigen::Vector3d& joint_m = input.proposed.position_m[j];
    out.place.position_m[j] = out.frame_from_camera * (joint_m - out.middle_m);
    out.moved.position_m[j] = out.frame_from_camera * input.moved.position_m[j];
  }
  out.confidence = input.confidence;
  out.seen = input.seen;
  return out;
}

ProposedPerson ProposedPerson::Mirrored() const {
  const Eigen::Vector3d mirror(-1.0, 1.0, 1.0);
  ProposedPerson out = *this;
  out.middle_m = mirror.cwiseProduct(middle_m);
  out.frame_from_camera = mirror.asDiagonal() * frame_from_camera * mirror.asDiagonal();
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto other = static_cast<size_t>(kMirroredJoint[j]);
    out.place.position_m[other] = mirror.cwiseProduct(place.position_m[j]);
    out.moved.position_m[other] = mirror.cwiseProduct(moved.position_m[j]);
    out.confidence[other] = confidence[j];
    out.seen[other] = seen[j];
  }
  return out;
}

std::optional<LookDescription> LookDescription::Of(const LookInput& input,
                                                   const JointSet& looked_at) {
  const auto person = ProposedPerson::Of(input);
  if (!person) return std::nullopt;
  LookDescription out{*person};
  Sampler sampler(input, out.frame_from_camera);
  for (size_t j = 0; j < kJointCount; ++j) {
    if (looked_at[j]) out.behind_mm[j] = sampler.Around(input.proposed.position_m[j]);
  }
  return out;
}

LookDescription LookDescription::Mirrored() const {
  LookDescription out{ProposedPerson::Mirrored()};
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto other = static_cast<size_t>(kMirroredJoint[j]);
    for (size_t row = 0; row < kLookSamples; row += kLookGrid) {
      std::reverse_copy(behind_mm[j].begin() + static_cast<std::ptrdiff_t>(row),
                        behind_mm[j].begin() + static_cast<std::ptrdiff_t>(row + kLookGrid),
                        out.behind_mm[other].begin() + static_cast<std::ptrdiff_t>(row));
    }
  }
  return out;
}

Eigen::VectorXf NumbersOf(const LookDescription& description, Joint joint) {
  Eigen::VectorXf numbers(kLookInputs);
  float* next = numbers.data();
  const auto& behind_mm = description.behind_mm[static_cast<size_t>(Index(joint))];
  const auto is_surface = [](int16_t mm) {
    return mm != LookDescription::kBeside && mm != LookDescription::kHidden;
  };
  for (const int16_t mm : behind_mm) *next++ = is_surface(mm) ? 1e-3F * static_cast<float>(mm) : 0;
  for (const int16_t mm : behind_mm) *next++ = mm == LookDescription::kBeside ? 1.0F : 0.0F;
  for (const int16_t mm : behind_mm) *next++ = mm == LookDescription::kHidden ? 1.0F : 0.0F;
  for (const Eigen::Vector3d& place_m : description.place.position_m) {
    const Eigen::Vector3f from_m = (place_m - description.place[joint]).cast<float>();
    next = std::copy(from_m.begin(), from_m.end(), next);
  }
  for (const Eigen::Vector3d& moved_m : description.moved.position_m) {
    const Eigen::Vector3f by_m = moved_m.cast<float>();
    next = std::copy(by_m.begin(), by_m.end(), next);
  }
  for (const double confidence : description.confidence) *next++ = static_cast<float>(confidence);
  for (const bool seen : description.seen) *next++ = seen ? 1.0F : 0.0F;
  const Eigen::Vector3f middle_m = description.middle_m.cast<float>();
  std::copy(middle_m.begin(), middle_m.end(), next);
  return numbers;
}

Looker::Looker(const CloseLook& look) {
  std::vector<const RectifiedNetwork*> networks;
  const auto add = [&networks](const std::vector<Glance>& glances) {
    for (const Glance& glance : glances) {
      for (const RectifiedNetwork& network : glance) networks.push_back(&network);
    }
  };
  add(look.glances);
  before_bones_ = networks.size();
  if (!look.bones.empty()) {
    networks.push_back(&look.bones);
    add(look.told);
  }
  networks_ = NetworkRunner::Of(networks);
}

// Each joint that is looked at moved by what its network says of it; of a pair both at once, the
// right one mirrored.
Posture Looker::Moved(Networks of_joints, const LookInput& input, const LookDescription& seen,
                      const JointSet& looked_at) {
  Posture joints_m = input.proposed;
  const LookDescription mirrored = seen.Mirrored();
  const Eigen::Vector3d mirror(-1.0, 1.0, 1.0);
  const Eigen::Matrix3d camera_from_frame = seen.frame_from_camera.transpose();
  for (size_t k = 0; k < kLookJoints.size(); ++k) {
    const Joint joint = kLookJoints[k];
    const auto index = static_cast<size_t>(Index(joint));
    const auto other = static_cast<size_t>(kMirroredJoint[index]);
    const bool one = looked_at[index], two = other != index && looked_at[other];
    if (!one && !two) continue;
    Eigen::MatrixXf numbers(input.bones_m ? kToldInputs : kLookInputs, one && two ? 2 : 1);
    numbers.col(0).head(kLookInputs) = NumbersOf(one ? seen : mirrored, joint);
    if (one && two) numbers.col(1).head(kLookInputs) = NumbersOf(mirrored, joint);
    if (input.bones_m) {
      numbers.bottomRows(kToldInputs - kLookInputs).colwise() = BoneOutputsOf(*input.bones_m);
    }
    const Eigen::MatrixXd offsets_m = CloseLook::kStep_m * of_joints[k].Run(numbers).cast<double>();
    for (Eigen::Index column = 0; column < offsets_m.cols(); ++column) {
      const bool is_mirrored = !one || column == 1;
      Eigen::Vector3d offset_m = offsets_m.col(column);
      offset_m *= std::min(1.0, CloseLook::kFarthest_m / std::max(offset_m.norm(), 1e-9));
      if (is_mirrored) offset_m = mirror.cwiseProduct(offset_m);
      joints_m.position_m[is_mirrored ? other : index] += camera_from_frame * offset_m;
    }
  }
  return joints_m;
}

// As far as there is something to see.
LookInput Looker::Glanced(Networks networks, LookInput input) {
  JointSet looked_at = kAllJoints;
  for (size_t first = 0; first < networks.size(); first += kLookJoints.size()) {
    const auto seen = LookDescription::Of(input, looked_at);
    if (!seen) break;
    const Networks of_joints = networks.subspan(first, kLookJoints.size());
    const Posture next_m = Moved(of_joints, input, *seen, looked_at);
    for (size_t j = 0; first > 0 && j < kJointCount; ++j) {
      const double moved_m = (next_m.position_m[j] - input.proposed.position_m[j]).norm();
      if (moved_m < CloseLook::kAtRest_m) looked_at[j] = false;
    }
    input = input.MovedTo(next_m);
  }
  return input;
}

std::optional<Looked> Looker::Look(const LookInput& input) const {
  if (!ProposedPerson::Of(input)) return std::nullopt;
  const Networks all = networks_;
  LookInput now = input;
  now.bones_m.reset();
  now = Glanced(all.first(before_bones_), std::move(now));
  Looked out{now.proposed, std::nullopt};
  const auto person = ProposedPerson::Of(now);
  if (all.size() == before_bones_ || !person) return out;
  out.bones_m = MeasuredBones(all[before_bones_], *person);
  now.bones_m = input.bones_m && AreBones(*input.bones_m) ? input.bones_m : out.bones_m;
  out.joints_m = Glanced(all.subspan(before_bones_ + 1), std::move(now)).proposed;
  return out;
}

}  // namespace ossa::recon
