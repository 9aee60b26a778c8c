#include "tests/fuzz/seeds.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace ossa::fuzz {

std::string TakeFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), {});
  std::filesystem::remove(path);
  return bytes;
}

std::string TakePayload(const std::string& path) {
  constexpr size_t kSealSize = 32;  // magic, byte order, version, length and checksum
  return TakeFile(path).substr(kSealSize);
}

std::string ScratchPath(const std::string& name) {
  const char* memory = "/dev/shm";
  const std::string folder = std::filesystem::is_directory(memory) ? memory : "/tmp";
  return folder + "/ossa_fuzz_" + std::to_string(getpid()) + "_" + name;
}

}  // namespace ossa::fuzz

// libFuzzer calls it before it reads its corpus.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* folder = std::getenv("OSSA_FUZZ_SEEDS");
  if (folder == nullptr) return 0;
  int count = 0;
  for (const std::string& seed : ossa::fuzz::Seeds()) {
    std::ofstream(std::string(folder) + "/seed_" + std::to_string(count++), std::ios::binary)
        << seed;
  }
  return 0;
}
