#pragma once
#include <filesystem>
#include <string>

#include "tools/synth/dataset.h"

namespace ossa::tools {

/// manifest.json as text: the same manifest gives the same bytes.
std::string ManifestToJson(const DatasetManifest& manifest);
DatasetManifest ReadManifest(const std::filesystem::path& folder);

/// One line of truth.jsonl (docs/architecture.md, "Data set") without the newline, and back;
/// `place` is for messages.
std::string TruthLine(const LabelledFrame& frame);
/// Fills index, time, floor and bodies of a frame.
void ParseTruthLine(const std::string& line, const std::string& place, LabelledFrame* frame);

}  // namespace ossa::tools
