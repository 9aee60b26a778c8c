#pragma once
#include <filesystem>
#include <memory>
#include <span>

namespace ossa::recon {

/// What is packed in a .gz, piece by piece, its checksums and lengths verified: libarchive's own
/// filter passes over them.
class GzipBytes {
 public:
  /// Throws InputError when the file cannot be opened.
  explicit GzipBytes(const std::filesystem::path& path);
  ~GzipBytes();

  /// The next piece, good until the next call; empty at the end. Throws InputError, naming the
  /// byte, for what is damaged or cut short and for anything behind the end but zeros, with which
  /// tapes are filled up.
  std::span<const char> Next();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ossa::recon
