#include <stdlib.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "depth/base/error.h"
#include "recon/files/skeleton_jsonl.h"
#include "recon/files/skeleton_writer.h"
#include "recon/fit/body_mesh.h"
#include "tools/viewer/answer_internal.h"
#include "tools/viewer/page_files_internal.h"

namespace ossa::viewer {
namespace {

// Empty for text that is no number, or a number beyond any recording, so that sums do not overflow.
std::optional<int64_t> WholeNumber(const std::string& text) {
  constexpr int64_t kMost = int64_t{1} << 40;  // count, by hand
  int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool good = error == std::errc() && end == text.data() + text.size();
  return good && value >= 0 && value <= kMost ? std::optional(value) : std::nullopt;
}

int64_t Number(std::string_view target, std::string_view key, int64_t otherwise) {
  const std::string text = QueryValue(target, key);
  if (text.empty()) return otherwise;
  if (const auto value = WholeNumber(text)) return *value;
  throw InputError(std::string(key) + "=" + text + ": expected a whole number of 0 or more");
}

Answer Lines(std::string_view target, const SharedState& shared) {
  constexpr int64_t kMostLines = 500;  // count: 1.5 MB of one person, by hand
  const int64_t from = Number(target, "from", 0);
  const int64_t count = std::min(Number(target, "count", kMostLines), kMostLines);
  const std::string layer = QueryValue(target, "layer");
  Answer answer{.type = "application/x-ndjson"};
  if (layer.empty() || layer == "final") {
    answer.body = shared.FinalLines(from, count);
  } else if (const auto overlay = WholeNumber(layer)) {
    answer.body = shared.OverlayLines(static_cast<size_t>(*overlay), from, count);
  } else {
    throw InputError("layer=" + layer + ": expected final, or the number of one of --over");
  }
  return answer;
}

// A temporary folder, deleted with the object.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "ossa-export-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw InputError(name + ": expected a folder for temporary files (TMPDIR)");
    }
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string ContentOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void WriteSpan(const std::filesystem::path& path, const recon::SkeletonSequence& sequence,
               const SharedState& shared) {
  recon::SkeletonWriter writer(path, {.body = shared.options.body});
  for (const auto& [id, shape] : shared.store.shapes()) writer.SetShape(id, shape);
  for (const recon::SkeletonFrame& frame : sequence.frames) writer.Write(frame);
  writer.Finish();
}

// TRC and BVH hold one person per file: the first is exported.
Answer Export(std::string_view target, const SharedState& shared) {
  constexpr int64_t kMostFrames = 36000;  // count: 20 minutes at 30 Hz, by hand
  const std::string format = QueryValue(target, "format");
  const std::vector<std::string> formats = {"jsonl", "csv", "trc", "bvh", "glb"};
  if (std::find(formats.begin(), formats.end(), format) == formats.end()) {
    throw InputError("format=" + format + ": expected jsonl, csv, trc, bvh or glb");
  }
  const int64_t from = Number(target, "from", 0), to = Number(target, "to", kMostFrames);
  const int64_t count = std::min(to - from + 1, kMostFrames);
  std::istringstream lines(shared.FinalLines(from, count));
  if (lines.str().empty()) {
    throw InputError("from, to: expected frames of a recording that are there, found none");
  }
  const recon::SkeletonSequence sequence = recon::ReadSkeletonJsonl(lines, "the span");
  const ScratchFolder folder;
  const std::string name = "skeletons." + format;
  WriteSpan(folder.path() / name, sequence, shared);
  return {.type = "application/octet-stream",
          .body = ContentOf(folder.path() / name),
          .file_name = name};
}

Answer Mesh(const SharedState& shared) {
  Answer answer{.type = "application/octet-stream"};
  if (!shared.options.body) return answer;
  for (const recon::MeshTriangle& triangle : shared.options.body->triangles) {
    for (const uint32_t corner : triangle) {
      for (int shift = 0; shift < 32; shift += 8) {
        answer.body.push_back(static_cast<char>(corner >> shift));
      }
    }
  }
  return answer;
}

Answer File(std::string_view path) {
  const PageFile* file = FindPageFile(path == "/" ? "/page/index.html" : path);
  if (file == nullptr) return {.status = 404, .body = "not here\n"};
  return {.type = std::string(file->type), .body = std::string(file->gzipped), .gzipped = true};
}

}  // namespace

std::string QueryValue(std::string_view target, std::string_view key) {
  size_t at = target.find('?');
  while (at != std::string_view::npos) {
    target.remove_prefix(at + 1);
    at = target.find('&');
    const std::string_view pair = target.substr(0, at);
    const size_t equals = pair.find('=');
    if (pair.substr(0, equals) == key && equals != std::string_view::npos) {
      return std::string(pair.substr(equals + 1));
    }
  }
  return {};
}

Answer AnswerTo(std::string_view target, const SharedState& shared) {
  const std::string_view path = target.substr(0, target.find('?'));
  try {
    if (path == "/state") return {.type = "application/json", .body = shared.StateJson()};
    if (path == "/lines") return Lines(target, shared);
    if (path == "/mesh") return Mesh(shared);
    if (path == "/export") return Export(target, shared);
    return File(path);
  } catch (const InputError& error) {
    return {.status = 400, .body = std::string(error.what()) + "\n"};
  }
}

}  // namespace ossa::viewer
