#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "recon/refine/pose_network.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/outputs.h"

namespace ossa::commands {
namespace {

[[noreturn]] void Refuse(const std::string& path, const char* expected) {
  throw InputError(fmt::format("{}: expected {}", path, expected));
}

// Format 1.0 of .npy files: magic number and version, then the header's length (uint16, little
// endian) and the header, a Python dictionary.
constexpr std::array<char, 8> kNpyStart = {'\x93', 'N', 'U', 'M', 'P', 'Y', 1, 0};

std::string ReadNpyHeader(std::ifstream& file, const std::string& path) {
  std::array<char, kNpyStart.size() + 2> start{};
  file.read(start.data(), start.size());
  if (!file || std::memcmp(start.data(), kNpyStart.data(), kNpyStart.size()) != 0) {
    Refuse(path, "a NumPy file (.npy, 1.0)");
  }
  const size_t length = static_cast<uint8_t>(start[8]) + 256U * static_cast<uint8_t>(start[9]);
  std::string header(length, '\0');
  file.read(header.data(), static_cast<std::streamsize>(header.size()));
  if (!file) Refuse(path, "float32 numbers of one dimension");
  return header;
}

// The length of a one-dimensional float32 array.
size_t ParseArrayLength(const std::string& header, const std::string& path) {
  constexpr size_t kMost = size_t{1} << 26U;  // numbers; by hand: forty times the shipped network
  constexpr std::string_view kShape = "'shape': (";
  const size_t shape = header.find(kShape);
  size_t count = 0;
  std::string_view rest;
  if (header.find("'<f4'") != std::string::npos && shape != std::string::npos) {
    const char* const end = header.data() + header.size();
    const auto read = std::from_chars(header.data() + shape + kShape.size(), end, count);
    if (read.ec == std::errc()) rest = std::string_view(read.ptr, end);
  }
  if (!rest.starts_with(",)") || count > kMost) Refuse(path, "float32 numbers of one dimension");
  return count;
}

std::vector<float> ReadNumbers(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be read: expected a NumPy file (.npy)");
  const std::string header = ReadNpyHeader(file, path);
  const size_t count = ParseArrayLength(header, path);
  const size_t begin = kNpyStart.size() + 2 + header.size();
  if (std::filesystem::file_size(path) != begin + count * sizeof(float)) {
    Refuse(path, "as many numbers as its head says");
  }
  std::vector<float> numbers(count);
  file.read(reinterpret_cast<char*>(numbers.data()),
            static_cast<std::streamsize>(count * sizeof(float)));
  if (!file) throw InputError(path + ": cannot be read: expected a NumPy file (.npy)");
  return numbers;
}

}  // namespace

int PackNetwork(int argc, char** argv) {
  CLI::App app("Convert trained weights to the file of a pose network");
  std::string weights, out;
  uint64_t people = 0;
  app.add_option("WEIGHTS", weights, "the .npy of tools/learning/train_pose_network.py")
      ->required();
  app.add_option("--out", out, "the .ossanet file to write")->required();
  app.add_option("--people", people, "number of people it was trained on, shown by `ossa info`");
  Parse(app, argc, argv);
  CheckNotOtherKind("--out", out, ".ossanet");
  CheckOutputs({out}, {weights});
  AtomicFile::CheckWritable(out);
  recon::PoseNetwork::FromNumbers(ReadNumbers(weights), people, weights).Save(out);
  return 0;
}

}  // namespace ossa::commands
