// A scene file: TOML tables [[object]], [[object.part]], [[grab]], [[release]], [[throw]], [dodge],
// [floor].
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "depth/base/angles.h"
#include "depth/base/error.h"
#include "depth/base/one_line.h"
#include "depth/base/open_file.h"
#include "depth/base/toml_shape.h"
#include "tools/tracker/scene.h"

namespace ossa::tracker {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// One table of the file. Remembers the keys that were read, so that unknown ones are reported.
class TableReader {
 public:
  TableReader(const std::string& file, std::string name, const toml::table& table)
      : file_(file), name_(std::move(name)), table_(table) {}

  [[noreturn]] void Fail(int line, const std::string& expected) const {
    throw InputError(fmt::format("{}: line {}: expected {}", file_, line, expected));
  }
  [[noreturn]] void Fail(const char* key, const std::string& expected) const {
    Fail(LineOf(key), fmt::format("{} as {}", key, expected));
  }
  int line() const { return static_cast<int>(table_.source().begin.line); }
  int LineOf(const char* key) const {
    const toml::node* node = table_.get(key);
    return node != nullptr ? static_cast<int>(node->source().begin.line) : line();
  }

  const toml::node* Find(const char* key) {
    known_.insert(key);
    return table_.get(key);
  }
  std::string Text(const char* key, const std::string& usual) {
    const toml::node* node = Find(key);
    if (node == nullptr) return usual;
    if (!node->is_string()) Fail(key, "a text");
    return *node->value<std::string>();
  }
  bool Flag(const char* key, bool usual) {
    const toml::node* node = Find(key);
    if (node == nullptr) return usual;
    if (!node->is_boolean()) Fail(key, "true or false");
    return *node->value<bool>();
  }
  /// From `least` to `most`.
  double Number(const char* key, double usual, double least, double most) {
    const toml::node* node = Find(key);
    if (node == nullptr) return usual;
    if (!node->is_number()) Fail(key, "a number");
    const double value = *node->value<double>();
    if (!(value >= least && value <= most)) Fail(key, fmt::format("{:g} to {:g}", least, most));
    return value;
  }
  int Count(const char* key, int usual, int most) {
    const double value = Number(key, usual, 1, most);
    if (value != std::floor(value)) Fail(key, "a whole number");
    return static_cast<int>(value);
  }
  /// Nothing if the key is absent.
  template <size_t kCount>
  std::optional<Eigen::Matrix<double, kCount, 1>> Numbers(const char* key, double most) {
    const toml::node* node = Find(key);
    if (node == nullptr) return std::nullopt;
    const std::string wanted = fmt::format("{} numbers of -{:g} to {:g}", kCount, most, most);
    const toml::array* const list = node->as_array();
    if (list == nullptr || list->size() != kCount) Fail(key, wanted);
    Eigen::Matrix<double, kCount, 1> values;
    for (size_t i = 0; i < kCount; ++i) {
      const toml::node& item = *list->get(i);
      const double value = item.is_number() ? *item.value<double>() : std::nan("");
      if (!(std::abs(value) <= most)) Fail(key, wanted);
      values[static_cast<Eigen::Index>(i)] = value;
    }
    return values;
  }
  std::vector<std::string> Texts(const char* key) {
    std::vector<std::string> texts;
    const toml::node* node = Find(key);
    if (node == nullptr) return texts;
    const toml::array* const list = node->as_array();
    if (list == nullptr || list->empty()) Fail(key, "a list of texts");
    for (const toml::node& item : *list) {
      if (!item.is_string()) Fail(key, "a list of texts");
      texts.push_back(*item.value<std::string>());
    }
    return texts;
  }
  /// One of several words.
  template <typename Value>
  Value Word(const char* key, const std::vector<std::pair<std::string, Value>>& words,
             Value usual) {
    const std::string text = Text(key, "");
    if (text.empty() && table_.get(key) == nullptr) return usual;
    std::vector<std::string> names;
    for (const auto& [name, value] : words) {
      if (name == text) return value;
      names.push_back(name);
    }
    Fail(key, fmt::format("one of {}; found '{}'", fmt::join(names, ", "), OnOneLine(text)));
  }
  void ExpectNothingElse() const {
    for (const auto& [key, node] : table_) {
      if (known_.contains(std::string(key.str()))) continue;
      Fail(static_cast<int>(node.source().begin.line),
           fmt::format("one of {} in {}; found '{}'", fmt::join(known_, ", "), name_,
                       OnOneLine(key.str())));
    }
  }
  /// Calls `read` for each table of a list, [[key]].
  template <typename Read>
  void ForEach(const char* key, const Read& read) {
    const toml::node* node = Find(key);
    if (node == nullptr) return;
    const toml::array* const list = node->as_array();
    for (size_t i = 0; list != nullptr && i < list->size(); ++i) {
      if (!list->get(i)->is_table()) Fail(key, fmt::format("[[{}]]", key));
    }
    if (list == nullptr) Fail(key, fmt::format("[[{}]]", key));
    for (const toml::node& item : *list) {
      TableReader reader(file_, fmt::format("[[{}]]", key), *item.as_table());
      read(reader);
      reader.ExpectNothingElse();
    }
  }

 private:
  const std::string& file_;
  std::string name_;
  const toml::table& table_;
  std::set<std::string> known_;
};

// Constants: bounds of what is read: those of physics::ObjectOptions::Check, and by hand.

constexpr double kFarthest_m = 100.0, kFastest_m_s = 50.0;
constexpr double kHeaviest_kg = 1e5, kLightest_kg = 1e-3;
constexpr double kSmallest_m = 0.005;
constexpr double kLongest_s = 1e5;

/// Rotations about x, y, z, in this order, degrees.
Quaterniond TurnOf(TableReader& table) {
  constexpr double kWhole_deg = 360.0;
  const Vector3d turn =
      table.Numbers<3>("turn_deg", kWhole_deg).value_or(Vector3d::Zero()) * kDegree;
  return Eigen::AngleAxisd(turn.z(), Vector3d::UnitZ()) *
         Eigen::AngleAxisd(turn.y(), Vector3d::UnitY()) *
         Eigen::AngleAxisd(turn.x(), Vector3d::UnitX());
}

physics::Shape ShapeOf(TableReader& table) {
  return table.Word<physics::Shape>("shape",
                                    {{"box", physics::Shape::kBox},
                                     {"ball", physics::Shape::kBall},
                                     {"capsule", physics::Shape::kCapsule}},
                                    physics::Shape::kBox);
}

/// A ball has a diameter, a capsule a diameter and a length, a box three edges.
Vector3d SizeOf(TableReader& table, physics::Shape shape) {
  if (table.Find("size_m") == nullptr) table.Fail(table.line(), "size_m in this table");
  Vector3d size = Vector3d::Zero();
  if (shape == physics::Shape::kBall) {
    size.setConstant(table.Number("size_m", 0.0, kSmallest_m, kFarthest_m));
  } else if (shape == physics::Shape::kCapsule) {
    const Eigen::Vector2d two = *table.Numbers<2>("size_m", kFarthest_m);
    size = {two.x(), two.y(), two.x()};
  } else {
    size = *table.Numbers<3>("size_m", kFarthest_m);
  }
  if (size.minCoeff() < kSmallest_m) {
    table.Fail("size_m", fmt::format("{:g} m or more", kSmallest_m));
  }
  return size;
}

SceneObject ObjectOf(TableReader& table) {
  SceneObject object;
  object.name = table.Text("name", "");
  if (object.name.empty()) table.Fail(table.line(), "a name in [[object]]");
  physics::ObjectOptions& body = object.body;
  body.shape = ShapeOf(table);
  body.size_m = SizeOf(table, body.shape);
  body.mass_kg = table.Number("mass_kg", body.mass_kg, kLightest_kg, kHeaviest_kg);
  body.friction = table.Number("friction", body.friction, 0.0, 10.0);
  body.bounce = table.Number("bounce", body.bounce, 0.0, 0.99);
  body.kind =
      table.Flag("static", false) ? physics::BodyKind::kStatic : physics::BodyKind::kDynamic;
  object.origin = table.Word<SceneObject::Origin>(
      "from", {{"floor", SceneObject::Origin::kFloor}, {"person", SceneObject::Origin::kPerson}},
      SceneObject::Origin::kFloor);
  object.person = table.Count("person", 1, 1000);
  body.position_m = table.Numbers<3>("at_m", kFarthest_m).value_or(Vector3d::Zero());
  body.orientation = TurnOf(table);
  body.velocity_m_s = table.Numbers<3>("velocity_m_s", kFastest_m_s).value_or(Vector3d::Zero());
  object.after_s = table.Number("after_s", 0.0, 0.0, kLongest_s);
  object.again_s = table.Number("again_s", 0.0, 0.0, kLongest_s);
  table.ForEach("part", [&body](TableReader& part_table) {
    physics::ObjectPart& part = body.parts.emplace_back();
    part.shape = ShapeOf(part_table);
    part.size_m = SizeOf(part_table, part.shape);
    part.position_m = part_table.Numbers<3>("at_m", kFarthest_m).value_or(Vector3d::Zero());
    part.orientation = TurnOf(part_table);
  });
  return object;
}

/// Names of defined objects.
std::vector<std::string> ObjectsOf(TableReader& table, const SceneOptions& scene) {
  const std::vector<std::string> names = table.Texts("objects");
  for (const std::string& name : names) {
    if (std::any_of(scene.objects.begin(), scene.objects.end(),
                    [&name](const SceneObject& object) { return object.name == name; })) {
      continue;
    }
    table.Fail("objects", fmt::format("names of [[object]]; found '{}'", OnOneLine(name)));
  }
  return names;
}

GrabRule GrabOf(TableReader& table, const SceneOptions& scene) {
  GrabRule rule;
  rule.objects = ObjectsOf(table, scene);
  const std::vector<std::string> joints = table.Texts("joints");
  if (!joints.empty()) rule.joints.clear();
  for (const std::string& name : joints) {
    const auto known = std::find(recon::kJointNames.begin(), recon::kJointNames.end(), name);
    if (known == recon::kJointNames.end()) {
      table.Fail("joints",
                 fmt::format("names of joints, as HandLeft; found '{}'", OnOneLine(name)));
    }
    rule.joints.push_back(static_cast<recon::Joint>(known - recon::kJointNames.begin()));
  }
  rule.near_m = table.Number("near_m", rule.near_m, 1e-3, 2.0);
  rule.slower_m_s = table.Number("slower_m_s", rule.slower_m_s, 1e-3, kFastest_m_s);
  rule.hands = table.Count("hands", rule.hands, 12);
  rule.people = table.Count("people", rule.people, 6);
  rule.strength_n = table.Number("strength_n", rule.strength_n, 1.0, 1e5);
  rule.shared_torque_nm = table.Number("shared_torque_nm", rule.shared_torque_nm, 1e-3, 1e5);
  return rule;
}

ReleaseRule ReleaseOf(TableReader& table, const SceneOptions& scene) {
  ReleaseRule rule;
  rule.objects = ObjectsOf(table, scene);
  rule.away_m = table.Number("away_m", rule.away_m, 1e-3, 2.0);
  rule.for_s = table.Number("for_s", rule.for_s, 0.0, kLongest_s);
  return rule;
}

ThrowRule ThrowOf(TableReader& table, const SceneOptions& scene) {
  ThrowRule rule;
  rule.objects = ObjectsOf(table, scene);
  rule.faster_m_s = table.Number("faster_m_s", rule.faster_m_s, 1e-3, kFastest_m_s);
  return rule;
}

void ReadDodge(TableReader& top, SceneOptions& scene, const std::string& file) {
  const toml::node* node = top.Find("dodge");
  if (node == nullptr) return;
  if (!node->is_table()) top.Fail("dodge", "[dodge]");
  TableReader table(file, "[dodge]", *node->as_table());
  scene.dodge.emplace();
  scene.dodge->lean = table.Flag("lean", true);
  scene.dodge->cover = table.Flag("cover", true);
  table.ExpectNothingElse();
}

void ReadFloor(TableReader& top, SceneOptions& scene) {
  const auto plane = top.Numbers<4>("floor", 1e4);
  if (!plane) return;
  if (!(std::abs(plane->head<3>().norm() - 1.0) < 0.01)) {
    top.Fail("floor", "a, b, c, d of a plane, a unit normal up before its place");
  }
  scene.floor = *plane / plane->head<3>().norm();
}

void ExpectOnce(const TableReader& table, const SceneObject& object, const SceneOptions& scene) {
  for (const SceneObject& other : scene.objects) {
    if (other.name != object.name) continue;
    table.Fail(table.line(),
               fmt::format("each name once; found '{}' again", OnOneLine(object.name)));
  }
}

toml::table Parse(const std::string& file) {
  std::ifstream stream = OpenFile(file);
  if (!stream) throw InputError(file + ": cannot be read: expected a scene file (TOML)");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  CheckTomlShape(text, file, TomlTables::kAllowed);
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}: line {}: expected TOML: {}", file, error.source().begin.line,
                                 OnOneLine(error.description())));
  }
}

}  // namespace

SceneOptions LoadScene(const std::filesystem::path& path) {
  const std::string file = path.string();
  const toml::table parsed = Parse(file);
  TableReader top(file, "a scene", parsed);
  SceneOptions scene;
  ReadFloor(top, scene);
  top.ForEach("object", [&scene](TableReader& table) {
    const SceneObject object = ObjectOf(table);
    ExpectOnce(table, object, scene);
    scene.objects.push_back(object);
  });
  top.ForEach("grab", [&](TableReader& table) { scene.grabs.push_back(GrabOf(table, scene)); });
  top.ForEach("release",
              [&](TableReader& table) { scene.releases.push_back(ReleaseOf(table, scene)); });
  top.ForEach("throw", [&](TableReader& table) { scene.throws.push_back(ThrowOf(table, scene)); });
  ReadDodge(top, scene, file);
  top.ExpectNothingElse();
  return scene;
}

}  // namespace ossa::tracker
