#include "recon/fuse/extrinsics.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/json_nesting.h"
#include "depth/base/open_file.h"

namespace ossa::recon {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr auto kReplaceBadText = Json::error_handler_t::replace;

[[noreturn]] void Refuse(const std::string& place, const std::string& expected, const Json& found) {
  constexpr size_t kMostShown_bytes = 60;  // of the quoted text; by hand
  std::string text = found.dump(-1, ' ', true, kReplaceBadText);
  if (text.size() > kMostShown_bytes) text = text.substr(0, kMostShown_bytes) + "...";
  throw InputError(fmt::format("{}: expected {}, found {}", place, expected, text));
}

const Json& Member(const Json& object, const char* key, const std::string& place) {
  const auto found = object.find(key);
  if (found == object.end()) Refuse(place, fmt::format("\"{}\"", key), object);
  return *found;
}

double NumberWithin(double most, const Json& json, const std::string& place) {
  if (!json.is_number() || !(std::abs(json.get<double>()) <= most)) {
    Refuse(place, fmt::format("a number within {:g}", most), json);
  }
  return json.get<double>();
}

Eigen::Matrix4d ReadMatrix(const Json& rows, const std::string& place) {
  const auto has_four = [](const Json& json) { return json.is_array() && json.size() == 4; };
  if (!has_four(rows) || !std::all_of(rows.begin(), rows.end(), has_four)) {
    Refuse(place, "4 rows of 4 numbers", rows);
  }
  constexpr double kFarthest_m = 1e6;  // by hand: no sensor sees as far
  Eigen::Matrix4d matrix;
  for (size_t r = 0; r < 4; ++r) {
    for (size_t c = 0; c < 4; ++c) {
      const std::string where = fmt::format("{}[{}][{}]", place, r, c);
      matrix(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
          NumberWithin(kFarthest_m, rows[r][c], where);
    }
  }
  return matrix;
}

Eigen::Isometry3d ReadTransform(const Json& rows, const std::string& place) {
  constexpr double kTolerance = 1e-3;  // no unit; numbers may have few digits; by hand
  const Eigen::Matrix4d matrix = ReadMatrix(rows, place);
  const Eigen::Matrix3d turn = matrix.topLeftCorner<3, 3>();
  const double off = (turn.transpose() * turn - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off < kTolerance) || turn.determinant() < 0.0) {
    Refuse(place, "a rotation (orthonormal, determinant 1) and a translation", rows);
  }
  if (!matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), kTolerance)) {
    Refuse(place, "0 0 0 1 as its last row", rows[3]);
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(turn, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = svd.matrixU() * svd.matrixV().transpose();
  transform.translation() = matrix.topRightCorner<3, 1>();
  return transform;
}

CameraExtrinsics ReadCamera(const Json& json, const std::string& place) {
  if (!json.is_object()) Refuse(place, "an object", json);
  const Json& name = Member(json, "name", place);
  if (!name.is_string() || name.get_ref<const std::string&>().empty()) {
    Refuse(place + ".name", "a name", name);
  }
  constexpr double kMost_s = 1e12;  // a bound: microseconds since 1970 taken for seconds are more
  CameraExtrinsics camera;
  camera.name = name.get<std::string>();
  camera.from_camera_0 =
      ReadTransform(Member(json, "from_camera_0", place), place + ".from_camera_0");
  camera.clock_offset_s =
      NumberWithin(kMost_s, Member(json, "clock_offset_s", place), place + ".clock_offset_s");
  return camera;
}

void CheckFirst(const CameraExtrinsics& first, const std::string& place) {
  constexpr double kSame = 1e-3;  // metres, radians and seconds; by hand
  if (first.from_camera_0.isApprox(Eigen::Isometry3d::Identity(), kSame) &&
      std::abs(first.clock_offset_s) < kSame) {
    return;
  }
  throw InputError(place + ": expected camera 0 first, with the identity and clock_offset_s 0");
}

std::string ReadText(const fs::path& path) {
  constexpr size_t kMostBytes = size_t{1} << 20;  // some hundred per camera; a bound by hand
  std::ifstream file = OpenFile(path);
  if (!file) throw InputError(path.string() + ": cannot be opened for reading");
  std::string text(kMostBytes, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<size_t>(file.gcount()));
  return text;
}

Json ParseObject(const std::string& text, const std::string& place) {
  if (JsonNesting().IsTooDeep(text)) {
    throw InputError(place + ": expected JSON nested at most 32 deep");
  }
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) {
    throw InputError(place + ": expected a JSON object with \"cameras\", found other text");
  }
  return json;
}

/// Formats with microseconds, however far apart the clocks are: the nine digits that suffice for
/// positions would round a clock that counts from 1970 to whole seconds.
std::string OffsetJson(double offset_s) {
  constexpr double kFinest_per_s = 1e6;  // by hand: microseconds, finer than cameras' clocks
  return fmt::format("{}", std::round(offset_s * kFinest_per_s) / kFinest_per_s + 0.0);
}

std::string RowJson(const Eigen::RowVector4d& row) {
  return fmt::format("[{:.9g}, {:.9g}, {:.9g}, {:.9g}]", row[0] + 0.0, row[1] + 0.0, row[2] + 0.0,
                     row[3] + 0.0);
}

/// Checks recordings that are assigned by order: if one is named like a camera, it must be that
/// camera.
void CheckOrder(const Extrinsics& cameras, std::span<const std::string> names,
                const std::string& place) {
  for (size_t k = 0; k < names.size(); ++k) {
    for (size_t c = 0; c < cameras.size(); ++c) {
      if (c == k || cameras[c].name != names[k]) continue;
      throw InputError(fmt::format(
          "{}: cameras[{}]: expected the camera of recording {}, {}, found {}, and that one is "
          "cameras[{}]: name all recordings as their cameras, or none",
          place, k, k + 1, names[k], cameras[k].name, c));
    }
  }
}

Extrinsics RelativeToFirst(Extrinsics cameras) {
  const Eigen::Isometry3d camera_0_from_first = cameras.front().from_camera_0.inverse();
  const double first_offset_s = cameras.front().clock_offset_s;
  for (CameraExtrinsics& camera : cameras) {
    camera.from_camera_0 = camera.from_camera_0 * camera_0_from_first;
    camera.clock_offset_s -= first_offset_s;
  }
  cameras.front().from_camera_0 = Eigen::Isometry3d::Identity();
  return cameras;
}

}  // namespace

Extrinsics ReadExtrinsics(const fs::path& path) {
  return ExtrinsicsFromJson(ReadText(path), path.string());
}

Extrinsics ExtrinsicsFromJson(const std::string& text, const std::string& file) {
  const Json json = ParseObject(text, file);
  const std::string place = file + ": cameras";
  const Json& list = Member(json, "cameras", file);
  if (!list.is_array() || list.empty()) Refuse(place, "a list of cameras", list);
  Extrinsics cameras;
  std::set<std::string> names;
  for (size_t k = 0; k < list.size(); ++k) {
    const std::string where = fmt::format("{}[{}]", place, k);
    cameras.push_back(ReadCamera(list[k], where));
    if (!names.insert(cameras.back().name).second) {
      Refuse(where + ".name", "a name of its own", cameras.back().name);
    }
  }
  CheckFirst(cameras.front(), place + "[0]");
  cameras.front() = {.name = cameras.front().name};
  return cameras;
}

std::string ExtrinsicsJson(const Extrinsics& cameras) {
  std::string text = "{\n  \"cameras\": [";
  for (const CameraExtrinsics& camera : cameras) {
    if (&camera != &cameras.front()) text += ",";
    text += fmt::format("\n    {{\n      \"name\": {},\n      \"from_camera_0\": [",
                        Json(camera.name).dump(-1, ' ', false, kReplaceBadText));
    const Eigen::Matrix4d matrix = camera.from_camera_0.matrix();
    for (Eigen::Index row = 0; row < 4; ++row) {
      text += (row == 0 ? "" : ",\n                        ") + RowJson(matrix.row(row));
    }
    text +=
        fmt::format("],\n      \"clock_offset_s\": {}\n    }}", OffsetJson(camera.clock_offset_s));
  }
  return text + "\n  ]\n}\n";
}

void WriteExtrinsics(const fs::path& path, const Extrinsics& cameras) {
  AtomicFile file(path);
  file.stream() << ExtrinsicsJson(cameras);
  file.Commit();
}

Extrinsics SelectCameras(const Extrinsics& cameras, std::span<const std::string> names,
                         const std::string& place) {
  Extrinsics named;
  for (const std::string& name : names) {
    const auto found = std::find_if(cameras.begin(), cameras.end(),
                                    [&name](const auto& camera) { return camera.name == name; });
    if (found != cameras.end()) named.push_back(*found);
  }
  if (!names.empty() && named.size() == names.size()) return RelativeToFirst(std::move(named));
  if (cameras.size() != names.size()) {
    throw InputError(
        fmt::format("{}: cameras: expected as many as there are recordings, {}, found {}", place,
                    names.size(), cameras.size()));
  }
  CheckOrder(cameras, names, place);
  return cameras;
}

std::vector<std::string> CameraNames(std::span<const std::string> sources) {
  std::vector<std::string> names;
  for (const std::string& source : sources) {
    // A path may end with '/', after which there is no name.
    const fs::path path(source);
    names.push_back((path.has_filename() ? path : path.parent_path()).stem().string());
  }
  const std::set<std::string> different(names.begin(), names.end());
  if (different.size() == names.size() && !different.contains("")) return names;
  for (size_t k = 0; k < names.size(); ++k) names[k] = fmt::format("camera_{}", k);
  return names;
}

}  // namespace ossa::recon
