#pragma once
#include <filesystem>
#include <string>

#include "tools/synth/dataset.h"

namespace ossa::tools {

/// Text of manifest.json; equal manifests give equal bytes.
std::string ManifestToJson(const DatasetManifest& manifest);
DatasetManifest ReadManifest(const std::filesystem::path& folder);

/// Sub-folder of an unfinished data set, and the file in it with the manifest to be.
constexpr const char* kWorkFolder = ".work";
constexpr const char* kPlanFile = "plan.json";
/// The command in a manifest's text, for messages; a remark if the text has none.
std::string CommandIn(const std::string& manifest_text);

/// One line of truth.jsonl (docs/architecture.md, "Data set") without the newline.
std::string TruthLine(const LabelledFrame& frame);
/// Reads such a line: fills index, time, floor and bodies of a frame. Throws InputError that begins
/// with `place`.
void ParseTruthLine(const std::string& line, const std::string& place, LabelledFrame* frame);

}  // namespace ossa::tools
