#pragma once
#include <filesystem>
#include <string>

#include "tools/synth/dataset.h"

namespace ossa::tools {

/// manifest.json as text: the same manifest gives the same bytes.
std::string ManifestToJson(const DatasetManifest& manifest);
DatasetManifest ReadManifest(const std::filesystem::path& folder);

/// What is kept in a data set's folder until it is finished, and in it what it is to be.
constexpr const char* kWorkFolder = ".work";
constexpr const char* kPlanFile = "plan.json";
/// The command in such a text, for messages; of any other text that it has none.
std::string CommandIn(const std::string& manifest_text);

/// One line of truth.jsonl (docs/architecture.md, "Data set") without the newline, and back;
/// `place` is for messages.
std::string TruthLine(const LabelledFrame& frame);
/// Fills index, time, floor and bodies of a frame.
void ParseTruthLine(const std::string& line, const std::string& place, LabelledFrame* frame);

}  // namespace ossa::tools
