#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "recon/motion/acclaim_internal.h"
#include "recon/motion/text_scanner_internal.h"

namespace ossa::recon {
namespace {

using Words = std::vector<std::string_view>;

constexpr size_t kMaxBones = 2000;  // a damaged file must not fill the memory; a bound, by hand
constexpr double kMetresPerInch = 0.0254;
constexpr std::array<std::string_view, 7> kDofNames = {"rx", "ry", "rz", "tx", "ty", "tz", "l"};

/// An ASF is a list of sections, each a line ":name" and the lines after it.
class AsfParser {
 public:
  AsfParser(std::string text, const std::string& source) : scan_(std::move(text), source) {
    skeleton_.source = source;
    skeleton_.bones.push_back({});
    skeleton_.bones[0].name = "root";
  }

  AcclaimSkeleton Run() {
    Next();
    while (!line_.empty()) {
      const std::string section = LowerCase(line_.front());
      if (!section.starts_with(':')) scan_.Fail("a section such as :bonedata", line_.front());
      Next();
      if (section == ":units") {
        ReadUnits();
      } else if (section == ":root") {
        ReadRoot();
      } else if (section == ":bonedata") {
        ReadBones();
      } else if (section == ":hierarchy") {
        ReadHierarchy();
      } else {  // :version, :name, :documentation, :skin
        while (!AtSection()) Next();
      }
    }
    if (skeleton_.bones.size() < 2) scan_.Fail("bones in :bonedata", "");
    if (!has_hierarchy_) scan_.Fail("a section :hierarchy", "");
    return Ordered();
  }

 private:
  bool AtSection() const { return line_.empty() || line_.front().starts_with(':'); }

  void Next() {
    do {
      line_ = scan_.ReadWordsOfLine();
    } while (!line_.empty() && line_.front().starts_with('#'));
  }

  void Need(size_t words, const std::string& form) {
    if (line_.size() < words) scan_.Fail(form, line_.back());
  }

  Eigen::Vector3d Vector(const std::string& form) {
    Need(4, form);
    return {scan_.ToNumber(line_[1], form), scan_.ToNumber(line_[2], form),
            scan_.ToNumber(line_[3], form)};
  }

  void ReadUnits() {
    for (; !AtSection(); Next()) {
      const std::string key = LowerCase(line_.front());
      if (key == "length") {
        Need(2, "length SCALE");
        const double scale = scan_.ToNumber(line_[1], "the length scale");
        if (scale <= 0.0) scan_.Fail("a length scale above 0", line_[1]);
        // CMU's convention: file lengths are inches times `length` (0.45).
        skeleton_.metres_per_unit = kMetresPerInch / scale;
      } else if (key == "angle") {
        Need(2, "angle deg or rad");
        skeleton_.degrees = IsDegrees(line_[1]);
      }
    }
  }

  bool IsDegrees(std::string_view word) {
    const std::string unit = LowerCase(word);
    if (!unit.starts_with("deg") && !unit.starts_with("rad")) scan_.Fail("angle deg or rad", word);
    return unit.starts_with("deg");
  }

  double Radians(double angle) const {
    return skeleton_.degrees ? angle * std::numbers::pi / 180.0 : angle;
  }

  /// Angles about fixed axes, applied in the order written: "XYZ" is Rz Ry Rx.
  Eigen::Quaterniond AxisRotation(const Eigen::Vector3d& angles, std::string_view order) {
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    const std::string axes = LowerCase(order);
    for (size_t i = 0; i < axes.size(); ++i) {
      if (axes.size() != 3 || axes[i] < 'x' || axes[i] > 'z') scan_.Fail("axes such as XYZ", order);
      rotation = Eigen::Quaterniond(Eigen::AngleAxisd(Radians(angles[static_cast<Eigen::Index>(i)]),
                                                      Eigen::Vector3d::Unit(axes[i] - 'x'))) *
                 rotation;
    }
    return rotation;
  }

  void ReadDofs(AcclaimBone& bone) {
    for (size_t w = 1; w < line_.size(); ++w) {
      const auto name = std::find(kDofNames.begin(), kDofNames.end(), LowerCase(line_[w]));
      if (name == kDofNames.end()) scan_.Fail("rx, ry, rz, tx, ty, tz or l", line_[w]);
      const auto dof = static_cast<AcclaimDof>(name - kDofNames.begin());
      if (std::count(bone.dofs.begin(), bone.dofs.end(), dof) > 0) {
        scan_.Fail("each degree of freedom once", line_[w]);
      }
      bone.dofs.push_back(dof);
    }
  }

  void ReadRoot() {
    AcclaimBone& root = skeleton_.bones[0];
    Eigen::Vector3d orientation = Eigen::Vector3d::Zero();
    std::string axes = "XYZ";
    for (; !AtSection(); Next()) {
      const std::string key = LowerCase(line_.front());
      if (key == "order") {
        ReadDofs(root);
      } else if (key == "axis") {
        Need(2, "axis ORDER");
        axes = line_[1];
      } else if (key == "orientation") {
        orientation = Vector("orientation x y z");
      } else if (key == "position") {
        Vector("position x y z");  // every frame overrides it
      } else {
        scan_.Fail("order, axis, position or orientation", line_.front());
      }
    }
    root.axis = AxisRotation(orientation, axes);
  }

  void ReadBones() {
    while (!AtSection()) {
      if (LowerCase(line_.front()) != "begin") scan_.Fail("'begin' of a bone", line_.front());
      if (skeleton_.bones.size() == kMaxBones) scan_.Fail("at most 2000 bones", "begin");
      Next();
      skeleton_.bones.push_back(ReadBone());
    }
  }

  AcclaimBone ReadBone() {
    AcclaimBone bone;
    bone.parent = -2;  // set by :hierarchy
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    double length = 0.0;
    for (;; Next()) {
      if (line_.empty()) scan_.Fail("'end' of bone " + bone.name, "");
      const std::string key = LowerCase(line_.front());
      if (key == "end") break;
      if (key == "name") {
        Need(2, "name NAME");
        bone.name = line_[1];
        if (skeleton_.BoneNamed(bone.name) >= 0) scan_.Fail("every bone once", line_[1]);
      } else if (key == "direction") {
        direction = Vector("direction x y z");
      } else if (key == "length") {
        Need(2, "length L");
        length = scan_.ToNumber(line_[1], "a length");
      } else if (key == "axis") {
        Need(5, "axis x y z ORDER");
        bone.axis = AxisRotation(Vector("axis x y z ORDER"), line_[4]);
      } else if (key == "dof") {
        ReadDofs(bone);
      } else if (AtSection()) {
        scan_.Fail("'end' of bone " + bone.name, line_.front());
      }  // id, bodymass, cofmass, limits: not needed
    }
    if (bone.name.empty()) scan_.Fail("a name of the bone before 'end'", line_.front());
    if (direction.norm() > 0.0) direction.normalize();
    bone.segment = direction * length * skeleton_.metres_per_unit;
    Next();
    return bone;
  }

  int FindBone(std::string_view name) {
    const int bone = skeleton_.BoneNamed(name);
    if (bone < 0) scan_.Fail("a bone of :bonedata", name);
    return bone;
  }

  void ReadHierarchy() {
    has_hierarchy_ = true;
    for (; !AtSection(); Next()) {
      const std::string key = LowerCase(line_.front());
      if (key == "begin" || key == "end") continue;
      const int parent = FindBone(line_.front());
      for (size_t w = 1; w < line_.size(); ++w) {
        AcclaimBone& child = skeleton_.bones[static_cast<size_t>(FindBone(line_[w]))];
        if (child.parent != -2) scan_.Fail("one parent for each bone", line_[w]);
        child.parent = parent;
      }
    }
  }

  /// Sorts parents before children; refuses bones without a parent and cycles.
  AcclaimSkeleton Ordered() {
    AcclaimSkeleton ordered = skeleton_;
    ordered.bones.assign(1, skeleton_.bones[0]);
    std::map<int, int> place = {{0, 0}};
    for (size_t i = 0; i < ordered.bones.size(); ++i) {
      for (size_t b = 1; b < skeleton_.bones.size(); ++b) {
        const auto parent = place.find(skeleton_.bones[b].parent);
        if (parent == place.end() || parent->second != static_cast<int>(i)) continue;
        place[static_cast<int>(b)] = static_cast<int>(ordered.bones.size());
        ordered.bones.push_back(skeleton_.bones[b]);
        ordered.bones.back().parent = static_cast<int>(i);
      }
    }
    for (size_t b = 1; b < skeleton_.bones.size(); ++b) {
      if (!place.contains(static_cast<int>(b))) {
        throw InputError(skeleton_.source + ": :hierarchy: expected bone '" +
                         skeleton_.bones[b].name + "' to hang on the root, found it does not");
      }
    }
    return ordered;
  }

  TextScanner scan_;
  Words line_;
  AcclaimSkeleton skeleton_;
  bool has_hierarchy_ = false;
};

}  // namespace

int AcclaimSkeleton::BoneNamed(std::string_view name) const {
  const auto found = std::find_if(bones.begin(), bones.end(),
                                  [&](const AcclaimBone& bone) { return bone.name == name; });
  return found == bones.end() ? -1 : static_cast<int>(found - bones.begin());
}

AcclaimSkeleton ParseAsf(std::string text, const std::string& source) {
  return AsfParser(std::move(text), source).Run();
}

}  // namespace ossa::recon
