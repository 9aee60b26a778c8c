#include "tools/commands/info_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/sensor/frame_source.h"
#include "forest/forest.h"
#include "tools/commands/command.h"
#include "tools/commands/outputs.h"
#include "tools/commands/process.h"
#include "tools/experiments/compare/svg_plot.h"
#include "tools/synth/contact_sheet.h"
#include "tools/synth/dataset.h"

namespace ossa::commands {
namespace {

// Constants: of the sheet, by eye.

constexpr int kTiles = 12, kColumns = 4;
constexpr int kTileWidth = 240;  // pixels

void Write(const std::string& path, std::string_view bytes) {
  AtomicFile file(path);
  file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.Commit();
}

tools::ContactSheet SheetFor(int64_t frames, const depth::Camera& camera) {
  const int count = static_cast<int>(std::clamp<int64_t>(frames, 1, kTiles));
  const int height = std::max(1, kTileWidth * camera.height / std::max(1, camera.width));
  return {count, std::min(count, kColumns), kTileWidth, height};
}

// Evenly spaced indices from first to last.
int64_t FrameOfTile(int tile, int64_t frames) {
  return frames <= kTiles ? tile : tile * (frames - 1) / (kTiles - 1);
}

tools::ContactSheet MakeDatasetSheet(const std::string& folder) {
  const tools::DatasetReader reader{std::filesystem::path(folder)};
  const int64_t frames = reader.frame_count();
  tools::ContactSheet sheet = SheetFor(frames, reader.manifest().camera);
  for (int tile = 0; tile < std::min<int64_t>(frames, kTiles); ++tile) {
    const auto frame =
        tools::Uncropped(reader.Read(FrameOfTile(tile, frames)), reader.manifest().camera);
    sheet.Draw(tile, frame.depth, frame.parts);
  }
  return sheet;
}

// Calls `take` with every frame and its index until it returns false. Returns the number of frames.
template <typename Take>
int64_t ForEachFrame(const SourceArguments& arguments, Take take) {
  const auto source = OpenSource(arguments, true);
  if (source->is_live()) {
    throw UsageError(
        "--picture: expected a recording, a data set or a model, found a device or a pipe");
  }
  int64_t frames = 0;
  Progress progress("looking", !CanMoveCursor());  // for who watches alone
  const auto known = static_cast<double>(source->frame_count().value_or(0));
  for (;;) {
    const depth::ReadResult read = source->Read(std::chrono::seconds(1));
    if (read.status == depth::ReadStatus::kEnd) return frames;
    if (read.status == depth::ReadStatus::kFrame) take(read.frame, frames++);
    if (known > 0) progress.Update(static_cast<double>(frames), known);
    if (Interrupted()) throw InputError("info: interrupted; nothing was written");
  }
}

// Read twice, because many recordings do not store their number of frames.
tools::ContactSheet MakeRecordingSheet(const SourceArguments& arguments) {
  const int64_t frames = ForEachFrame(arguments, [](const auto&, int64_t) {});
  if (frames == 0) throw InputError(arguments.name + ": no frame came");
  std::optional<tools::ContactSheet> sheet;
  int tile = 0;
  ForEachFrame(arguments, [&](const depth::DepthFrame& frame, int64_t index) {
    if (!sheet) sheet = SheetFor(frames, frame.camera);
    if (tile >= kTiles || index != FrameOfTile(tile, frames)) return;
    sheet->Draw(tile++, frame, {});
  });
  return std::move(*sheet);
}

// A bar chart of a measure stored by `ossa evaluate --card`, one series per data set.
std::string Bars(const nlohmann::ordered_json& accuracy, const char* measure,
                 const std::string& title) {
  std::vector<std::string> series, groups;
  std::vector<std::vector<std::optional<double>>> values;
  for (const auto& [name, numbers] : accuracy.items()) {
    if (!numbers.contains(measure)) continue;
    for (const auto& [group, value] : numbers[measure].items()) {
      if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
    }
  }
  for (const auto& [name, numbers] : accuracy.items()) {
    if (!numbers.contains(measure)) continue;
    series.push_back(name);
    auto& row = values.emplace_back();
    for (const std::string& group : groups) {
      const auto found = numbers[measure].find(group);
      const bool is_known = found != numbers[measure].end() && found->is_number();
      row.push_back(is_known ? std::optional(100 * found->template get<double>()) : std::nullopt);
    }
  }
  if (series.empty()) return {};
  return fmt::format("<h2>{}</h2>\n{}\n", title, tools::BarPlot(series, groups, values, "%"));
}

std::string FormatCard(const std::string& path) {
  const forest::ForestModel model = forest::ReadForestModel(path);
  const auto card = nlohmann::ordered_json::parse(model.manifest(), nullptr, false);
  size_t leaves = 0;
  for (const forest::Tree& tree : model.data().trees) leaves += tree.leaf_count();
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title><style>\n"
      "body{{font:15px/1.45 system-ui,sans-serif;max-width:920px;margin:2em auto}}pre{{white-space:"
      "pre-wrap}}svg text{{font:11px system-ui,sans-serif;fill:#444}}.grid{{stroke:#e4e4e4}}"
      ".plot{{width:100%}}</style></head><body>\n<h1>{0}</h1>\n<p>Forest model: {1} classes, {2} "
      "contexts, {3} trees with {4} leaves.</p>\n",
      tools::Escaped(std::filesystem::path(path).filename().string()), model.class_count(),
      model.context_count(), model.data().trees.size(), leaves);
  if (card.is_object() && card.contains("accuracy") && card["accuracy"].is_object()) {
    html += Bars(card["accuracy"], "per_class_accuracy", "Pixels right by part");
    html += Bars(card["accuracy"], "ap_10cm", "Average precision by joint, within 10 cm");
  }
  return html + fmt::format("<h2>Learned from</h2>\n<pre>{}</pre>\n</body></html>\n",
                            tools::Escaped(model.manifest()));
}

}  // namespace

void WriteInfoPicture(const SourceArguments& arguments, const std::string& path) {
  const bool is_model = forest::IsForestModel(arguments.name);
  CheckExtension("--picture", path, is_model ? ".html" : ".png");
  CheckOutputs({path}, {arguments.name});
  AtomicFile::CheckWritable(path);
  if (is_model) return Write(path, FormatCard(arguments.name));
  const bool is_dataset = tools::IsDataset(arguments.name);
  const bool is_depth =
      depth::IsRecording(arguments.name) || std::filesystem::is_directory(arguments.name);
  if (!is_dataset && !is_depth) {
    throw UsageError("--picture: expected depth images, a data set or a forest model, found " +
                     arguments.name);
  }
  const std::vector<uint8_t> png =
      (is_dataset ? MakeDatasetSheet(arguments.name) : MakeRecordingSheet(arguments)).EncodePng();
  Write(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

}  // namespace ossa::commands
