#include <zlib.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>

#include "depth/base/error.h"
#include "depth/base/open_file.h"
#include "recon/files/gzip_bytes_internal.h"

namespace ossa::recon {
namespace {

constexpr int kGzipOnly = 16 + MAX_WBITS;   // by zlib.h: this format alone
constexpr size_t kPiece = size_t{1} << 16;  // bytes, by hand

}  // namespace

struct GzipBytes::State {
  explicit State(const std::filesystem::path& path) : name(path.string()), file(OpenFile(path)) {
    if (!file) throw InputError(name + ": cannot be opened for reading");
    if (inflateInit2(&stream, kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  ~State() { inflateEnd(&stream); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  // Reads more compressed bytes. False at the end of the file.
  bool NeedInput() {
    if (stream.avail_in > 0) return true;
    file.read(packed.data(), static_cast<std::streamsize>(packed.size()));
    stream.next_in = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_in = static_cast<uInt>(file.gcount());
    read += static_cast<uint64_t>(file.gcount());
    return stream.avail_in > 0;
  }

  [[noreturn]] void Fail(const std::string& found) const {
    throw InputError(name + ": byte " + std::to_string(read - stream.avail_in) +
                     ": expected a whole archive, found " + found);
  }

  // Skips to the next gzip member; trailing zeros are allowed. False if there is none.
  bool NextMember() {
    while (NeedInput() && *stream.next_in == 0) {
      ++stream.next_in;
      --stream.avail_in;
      filled_up = true;
    }
    if (stream.avail_in == 0) return false;
    if (filled_up || inflateReset(&stream) != Z_OK) Fail("bytes behind its end");
    return true;
  }

  std::string name;
  std::ifstream file;
  z_stream stream{};
  std::array<char, kPiece> packed;
  std::array<char, kPiece> unpacked;
  uint64_t read = 0;  // compressed bytes read
  bool filled_up = false;
  bool ended = false;  // whether the current member has ended
};

GzipBytes::GzipBytes(const std::filesystem::path& path) : state_(std::make_unique<State>(path)) {}
GzipBytes::~GzipBytes() = default;

std::span<const char> GzipBytes::Next() {
  State& s = *state_;
  s.stream.next_out = reinterpret_cast<Bytef*>(s.unpacked.data());
  s.stream.avail_out = static_cast<uInt>(s.unpacked.size());
  while (s.stream.avail_out == s.unpacked.size()) {
    if (s.ended && !s.NextMember()) return {};
    s.ended = false;
    if (!s.NeedInput()) s.Fail("its end: it is cut short");
    const int status = inflate(&s.stream, Z_NO_FLUSH);
    if (status == Z_MEM_ERROR) throw std::bad_alloc();
    if (status != Z_OK && status != Z_STREAM_END) {
      s.Fail(std::string("damage (") + (s.stream.msg != nullptr ? s.stream.msg : "gzip") + ")");
    }
    s.ended = status == Z_STREAM_END;
  }
  return std::span(s.unpacked).first(s.unpacked.size() - s.stream.avail_out);
}

}  // namespace ossa::recon
