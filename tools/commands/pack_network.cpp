#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "recon/refine/pose_network.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/outputs.h"

namespace ossa::commands {
namespace {

// The numbers of a NumPy file of one dimension, float32.
std::vector<float> ReadNumbers(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be read");
  const auto fail = [&](const char* expected) {
    throw InputError(fmt::format("{}: expected {}", path, expected));
  };
  // Of the format 1.0: magic, version, length of the head.
  std::array<char, 10> start{};
  constexpr std::array<char, 8> kStart = {'\x93', 'N', 'U', 'M', 'P', 'Y', 1, 0};
  file.read(start.data(), start.size());
  if (!file || std::memcmp(start.data(), kStart.data(), kStart.size()) != 0) {
    fail("a NumPy file (.npy, 1.0)");
  }
  const size_t length = static_cast<uint8_t>(start[8]) + 256U * static_cast<uint8_t>(start[9]);
  std::string head(length, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  const size_t shape = head.find("'shape': (");
  if (!file || head.find("'<f4'") == std::string::npos || shape == std::string::npos) {
    fail("float32 numbers of one dimension");
  }
  constexpr size_t kMost = size_t{1} << 26U;  // numbers; by hand: forty times what ours has
  size_t count = 0;
  const char* const digits = head.data() + shape + std::strlen("'shape': (");
  const auto read = std::from_chars(digits, head.data() + head.size(), count);
  const std::string_view rest(read.ptr, head.data() + head.size());
  if (read.ec != std::errc() || !rest.starts_with(",)") || count > kMost) {
    fail("float32 numbers of one dimension");
  }
  if (std::filesystem::file_size(path) != start.size() + length + count * sizeof(float)) {
    fail("as many numbers as its head says");
  }
  std::vector<float> numbers(count);
  file.read(reinterpret_cast<char*>(numbers.data()),
            static_cast<std::streamsize>(count * sizeof(float)));
  if (!file) throw InputError(path + ": cannot be read");
  return numbers;
}

}  // namespace

int PackNetwork(int argc, char** argv) {
  CLI::App app("Make the file of a pose network from the weights that a trainer wrote");
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
