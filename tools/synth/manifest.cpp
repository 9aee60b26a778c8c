#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "depth/base/error.h"
#include "depth/base/json_nesting.h"
#include "depth/base/one_line.h"
#include "depth/base/open_file.h"
#include "depth/image/camera_io.h"
#include "tools/json/json_text.h"
#include "tools/synth/manifest_internal.h"

namespace ossa::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kFormat = "ossa data set";
constexpr int kVersion = 1;

template <typename T>
T Field(const Json& json, const std::string& place, const char* name) {
  try {
    return json.at(name).get<T>();
  } catch (const Json::exception&) {
    throw InputError(place + ": " + name + ": missing or not of the expected kind");
  }
}

DatasetManifest ManifestFromJson(const Json& json, const std::filesystem::path& path) {
  const std::string place = path.string();
  if (!json.is_object() || json.value("format", "") != kFormat) {
    throw InputError(place + ": format: expected \"" + std::string(kFormat) + "\"");
  }
  const int version = Field<int>(json, place, "version");
  if (version != kVersion) {
    throw InputError(fmt::format("{}: version: expected {}, found {}", place, kVersion, version));
  }
  DatasetManifest manifest;
  manifest.frames = Field<int64_t>(json, place, "frames");
  manifest.camera = depth::ReadManifestCamera(path);
  manifest.seed = Field<uint64_t>(json, place, "seed");
  manifest.command = Field<std::string>(json, place, "command");
  manifest.split = Field<std::string>(json, place, "split");
  manifest.view = Field<std::string>(json, place, "view");
  manifest.sources = Field<std::vector<std::string>>(json, place, "sources");
  manifest.motion = json.contains("motion") ? Field<std::string>(json, place, "motion") : "";
  manifest.ossa = json.contains("ossa") ? Field<std::string>(json, place, "ossa") : "";
  manifest.terms = Field<std::vector<std::string>>(json, place, "terms");
  manifest.png = Field<bool>(json, place, "png");
  manifest.packed = Field<bool>(json, place, "packed");
  manifest.frames_per_shard = Field<int64_t>(json, place, "frames_per_shard");
  if (manifest.frames < 0 || (!manifest.png && !manifest.packed) ||
      (manifest.packed && manifest.frames_per_shard < 1)) {
    throw InputError(place + ": frames: expected a count of frames in png or packed form");
  }
  return manifest;
}

std::string JointJson(const TruthBody& body, size_t joint) {
  const Eigen::Vector3d& p = body.joints_m.position_m[joint];
  return fmt::format(R"("{}":{{"p":[{:.5f},{:.5f},{:.5f}],"state":"tracked","visible":{}}})",
                     recon::kJointNames[joint], p.x(), p.y(), p.z(), body.visible[joint]);
}

TruthBody ParseBody(const Json& json, const std::string& place) {
  TruthBody body;
  body.id = Field<int>(json, place, "id");
  const auto joints = Field<Json>(json, place, "joints");
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const std::string name(recon::kJointNames[j]);
    const auto joint = Field<Json>(joints, place, name.c_str());
    const auto p = Field<std::array<double, 3>>(joint, place + ": " + name, "p");
    body.joints_m.position_m[j] = Eigen::Vector3d(p[0], p[1], p[2]);
    body.visible[j] = Field<bool>(joint, place + ": " + name, "visible");
  }
  return body;
}

Json ParseJson(const std::string& text, const std::string& place) {
  if (JsonNesting().IsTooDeep(text)) {
    throw InputError(place + ": expected JSON that nests at most 32 deep");
  }
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) throw InputError(place + ": expected a JSON object, found other text");
  return json;
}

}  // namespace

std::string ManifestToJson(const DatasetManifest& manifest) {
  Json json;
  json["format"] = kFormat;
  json["version"] = kVersion;
  json["frames"] = manifest.frames;
  json["camera"] = Json::parse(depth::CameraToJson(manifest.camera));
  json["seed"] = manifest.seed;
  json["command"] = manifest.command;
  json["split"] = manifest.split;
  json["view"] = manifest.view;
  json["sources"] = manifest.sources;
  json["motion"] = manifest.motion;
  json["ossa"] = manifest.ossa;
  json["terms"] = manifest.terms;
  json["png"] = manifest.png;
  json["packed"] = manifest.packed;
  json["frames_per_shard"] = manifest.frames_per_shard;
  return JsonText(json) + "\n";
}

std::string CommandIn(const std::string& manifest_text) {
  try {
    return OnOneLine(
        Field<std::string>(ParseJson(manifest_text, "manifest"), "manifest", "command"));
  } catch (const InputError&) {
    return "a text without a command";
  }
}

DatasetManifest ReadManifest(const std::filesystem::path& folder) {
  const auto path = folder / "manifest.json";
  std::ifstream file = OpenFile(path);
  if (!file && IsUnfinishedDataset(folder)) {
    throw InputError(folder.string() +
                     ": the data set is not finished: expected the command that " +
                     "makes it to be given again, it goes on from where it was");
  }
  if (!file) throw InputError(path.string() + ": cannot be read: expected a data set's manifest");
  constexpr size_t kMostBytes = size_t{16}
                                << 20;  // a manifest has a few kilobytes; a bound by hand
  std::string text(kMostBytes, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<size_t>(file.gcount()));
  return ManifestFromJson(ParseJson(text, path.string()), path);
}

std::string TruthLine(const LabelledFrame& frame) {
  std::string line =
      fmt::format(R"({{"frame":{},"time_s":{:.6f},)", frame.depth.index, frame.depth.time_s);
  if (frame.floor) {
    const Eigen::Vector4d& f = *frame.floor;
    line += fmt::format(R"("floor":[{:.6f},{:.6f},{:.6f},{:.6f}],)", f[0], f[1], f[2], f[3]);
  }
  line += R"("bodies":[)";
  for (size_t b = 0; b < frame.bodies.size(); ++b) {
    const TruthBody& body = frame.bodies[b];
    line += fmt::format(R"({}{{"id":{},"joints":{{)", b > 0 ? "," : "", body.id);
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      if (j > 0) line += ',';
      line += JointJson(body, j);
    }
    line += "}}";
  }
  return line + "]}";
}

void ParseTruthLine(const std::string& line, const std::string& place, LabelledFrame* frame) {
  const Json json = ParseJson(line, place);
  frame->depth.index = Field<int64_t>(json, place, "frame");
  frame->depth.time_s = Field<double>(json, place, "time_s");
  if (json.contains("floor")) {
    frame->floor = Eigen::Vector4d(Field<std::array<double, 4>>(json, place, "floor").data());
  }
  for (const Json& body : Field<Json>(json, place, "bodies")) {
    frame->bodies.push_back(ParseBody(body, place));
  }
}

}  // namespace ossa::tools
