#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "depth/base/error.h"
#include "recon/body/body_files_internal.h"

namespace ossa::recon {
namespace {

namespace fs = std::filesystem;

constexpr const char *kMeshFile = "base.obj", *kRigFile = "rig.cmu_mb.json",
                     *kWeightsFile = "weights.cmu_mb.json", *kTargetsFolder = "targets";

std::string ReadText(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || !fs::is_regular_file(path)) {
    throw InputError(path.string() + ": cannot be read: run tools/fetch_body");
  }
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

/// The fields of a line of numbers and words, one after the other.
class LineParser {
 public:
  LineParser(const fs::path& path, size_t line_number, std::string_view line)
      : path_(path), line_number_(line_number), rest_(line) {}

  std::string_view Word() {
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t'))
      rest_.remove_prefix(1);
    const size_t end = std::min(rest_.find_first_of(" \t\r"), rest_.size());
    const auto word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }
  float Float() {
    const float value = Number<float>(Word(), "a number");
    if (!std::isfinite(value)) Fail("expected a finite number");
    return value;
  }
  uint32_t Index(std::string_view word, size_t limit) {
    const auto index = Number<uint32_t>(word, "a vertex number");
    if (index >= limit) Fail("expected a vertex number below " + std::to_string(limit));
    return index;
  }
  [[noreturn]] void Fail(const std::string& reason) const {
    throw InputError(path_.string() + ": line " + std::to_string(line_number_) + ": " + reason);
  }

 private:
  template <typename T>
  T Number(std::string_view word, const char* what) {
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
      Fail("expected " + std::string(what) + ", found '" + std::string(word.substr(0, 20)) + "'");
    }
    return value;
  }
  const fs::path& path_;
  size_t line_number_;
  std::string_view rest_;
};

template <typename Visit>
void ForEachLine(const fs::path& path, const Visit& visit) {
  const std::string text = ReadText(path);
  size_t line_number = 0;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    visit(LineParser(path, ++line_number, std::string_view(text).substr(begin, end - begin)));
    begin = end + 1;
  }
}

void ReadMesh(const fs::path& path, BodyFiles* files) {
  std::string group;
  ForEachLine(path, [&](LineParser line) {
    const auto kind = line.Word();
    if (kind == "v") {
      const float x = line.Float(), y = line.Float(), z = line.Float();
      files->vertex_dm.emplace_back(x, y, z);
    } else if (kind == "g") {
      group = line.Word();
    } else if (kind == "f") {
      std::vector<uint32_t> polygon;
      for (auto word = line.Word(); !word.empty(); word = line.Word()) {
        const auto number = word.substr(0, word.find('/'));
        const uint32_t from_1 = line.Index(number, files->vertex_dm.size() + 1);
        if (from_1 == 0) line.Fail("expected a vertex number from 1 up, found 0");
        polygon.push_back(from_1 - 1);
      }
      if (polygon.size() < 3) line.Fail("expected a face of three vertices or more");
      files->faces[group].push_back(std::move(polygon));
    }
  });
  if (files->vertex_dm.empty()) throw InputError(path.string() + ": expected vertices, found none");
}

// A BodyModel holds them as thousandths in 16 bits; a bound of our format.
constexpr float kLargestDelta_dm = 32.0F;

BodyFiles::Target ReadTarget(const fs::path& path, size_t vertex_count) {
  BodyFiles::Target target;
  target.name = path.stem().string();
  ForEachLine(path, [&](LineParser line) {
    const auto word = line.Word();
    if (word.empty() || word.front() == '#') return;
    target.index.push_back(line.Index(word, vertex_count));
    const float x = line.Float(), y = line.Float(), z = line.Float();
    if (std::max({std::abs(x), std::abs(y), std::abs(z)}) > kLargestDelta_dm) {
      line.Fail("expected deltas of at most 32 decimetres");
    }
    target.delta_dm.emplace_back(x, y, z);
  });
  return target;
}

void ReadTargets(const fs::path& folder, BodyFiles* files) {
  std::vector<fs::path> paths;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) paths.push_back(entry.path());
  if (error) throw InputError(folder.string() + ": cannot be read: run tools/fetch_body");
  std::sort(paths.begin(), paths.end());
  for (const auto& path : paths) {
    if (path.extension() != ".target") continue;
    files->targets.push_back(ReadTarget(path, files->vertex_dm.size()));
  }
}

nlohmann::json ReadJson(const fs::path& path) {
  auto json = nlohmann::json::parse(ReadText(path), nullptr, false);
  if (json.is_discarded()) throw InputError(path.string() + ": expected JSON, found other text");
  return json;
}

VertexMean ParsePoint(const nlohmann::json& point, const BodyFiles& files) {
  if (point.at("strategy") == "CUBE") {
    return files.Vertices(point.at("cube_name").get<std::string>());
  }
  return point.at("vertex_indices").get<std::vector<uint32_t>>();
}

void ReadRig(const fs::path& path, BodyFiles* files) {
  const auto json = ReadJson(path);
  for (size_t b = 0; b < kRigBoneCount; ++b) {
    const std::string name(kRigBoneNames[b]);
    try {
      files->bone_head[b] = ParsePoint(json.at(name).at("head"), *files);
      files->bone_tail[b] = ParsePoint(json.at(name).at("tail"), *files);
    } catch (const nlohmann::json::exception&) {
      throw InputError(path.string() + ": bone " + name + ": missing, or its head or tail is");
    }
    for (const auto* mean : {&files->bone_head[b], &files->bone_tail[b]}) {
      const auto limit = static_cast<uint32_t>(files->vertex_dm.size());
      if (!mean->empty() && *std::max_element(mean->begin(), mean->end()) < limit) continue;
      throw InputError(path.string() + ": bone " + name + ": expected vertices of base.obj");
    }
  }
}

void ReadWeights(const fs::path& path, BodyFiles* files) {
  const auto json = ReadJson(path);
  files->weights.resize(files->vertex_dm.size());
  for (size_t b = 0; b < kRigBoneCount; ++b) {
    const std::string name(kRigBoneNames[b]);
    try {
      for (const auto& entry : json.at("weights").at(name)) {
        const float weight = entry.at(1).get<float>();
        if (!(weight >= 0.0F)) throw std::out_of_range("weight");
        files->weights.at(entry.at(0).get<size_t>()).emplace_back(static_cast<uint8_t>(b), weight);
      }
    } catch (const std::exception&) {
      throw InputError(path.string() + ": bone " + name +
                       ": expected [[vertex, weight], ...], weights from 0 up");
    }
  }
}

}  // namespace

VertexMean BodyFiles::Vertices(const std::string& group) const {
  const auto found = faces.find(group);
  if (found == faces.end()) throw InputError(mesh_file + ": expected a group " + group);
  std::set<uint32_t> vertices;
  for (const auto& polygon : found->second) vertices.insert(polygon.begin(), polygon.end());
  return {vertices.begin(), vertices.end()};
}

BodyFiles ReadBodyFiles(const fs::path& folder) {
  BodyFiles files;
  files.mesh_file = (folder / kMeshFile).string();
  ReadMesh(folder / kMeshFile, &files);
  ReadRig(folder / kRigFile, &files);
  ReadWeights(folder / kWeightsFile, &files);
  ReadTargets(folder / kTargetsFolder, &files);
  return files;
}

bool AreFilesNewer(const fs::path& folder, const fs::path& than) {
  std::error_code unknown;
  const auto time = fs::last_write_time(than, unknown);
  const auto is_newer = [&](const fs::path& path) {
    return fs::last_write_time(path, unknown) > time && !unknown;
  };
  for (const char* name : {kMeshFile, kRigFile, kWeightsFile, kTargetsFolder}) {
    if (is_newer(folder / name)) return true;
  }
  for (const auto& entry : fs::directory_iterator(folder / kTargetsFolder, unknown)) {
    if (is_newer(entry.path())) return true;
  }
  return false;
}

}  // namespace ossa::recon
