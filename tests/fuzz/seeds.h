#pragma once
#include <string>
#include <vector>

namespace ossa::fuzz {

/// Valid inputs of the thing a target tries, made in code: what a fuzzer that starts from nothing
/// would need hours to find. Each target defines its own; written to the folder that the
/// environment names in OSSA_FUZZ_SEEDS before the run begins.
std::vector<std::string> Seeds();

/// The bytes of a file, then the file is gone.
std::string TakeFile(const std::string& path);

/// Of a checksummed container, what lies under the seal; then the file is gone.
std::string TakePayload(const std::string& path);

/// A path of this process for files of a run, in memory where there is such a folder.
std::string ScratchPath(const std::string& name);

}  // namespace ossa::fuzz
