#pragma once
#include <filesystem>
#include <memory>
#include <span>

namespace ossa::recon {

/// Decompresses a .gz in chunks and verifies its checksums and lengths, which libarchive's own
/// filter ignores.
class GzipBytes {
 public:
  /// Throws InputError when the file cannot be opened.
  explicit GzipBytes(const std::filesystem::path& path);
  ~GzipBytes();

  /// The next chunk, valid until the next call; empty at the end. Throws InputError, naming the
  /// byte, for damaged or truncated data and for anything after the end other than zeros, with
  /// which tapes are padded.
  std::span<const char> Next();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ossa::recon
