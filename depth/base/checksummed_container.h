#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace ossa {

/// A checksummed container, the frame around every binary file ossa owns: 8 bytes of magic, a
/// byte-order mark, the format's version, the payload's length and its XXH3 checksum, then the
/// payload (little-endian).
struct ContainerFormat {
  std::array<char, 8> magic{};
  uint32_t version = 1;
  std::string_view what;  // for messages, e.g. "forest model"
};

/// Writes the payload atomically.
void WriteContainer(const std::filesystem::path& path, const ContainerFormat& format,
                    std::span<const std::byte> payload);

/// True when the file begins with the format's magic; its version and the rest may still be wrong.
bool IsContainer(const std::filesystem::path& path, const ContainerFormat& format);

/// The payload's checksum as the header has it, by which a file is known again whatever it is
/// called. Throws InputError where the file has no header.
uint64_t ReadContainerChecksum(const std::filesystem::path& path);

/// Reads and verifies the frame; returns the payload. Throws InputError that names the file and the
/// field when magic, byte order, version, length or checksum are not as expected.
std::vector<std::byte> ReadContainer(const std::filesystem::path& path,
                                     const ContainerFormat& format);

/// The format as it was when the file was written, where files of versions from `oldest` on are
/// still read; `newest` where the file says anything else, for ReadContainer to refuse.
ContainerFormat ReadContainerFormat(const std::filesystem::path& path,
                                    const ContainerFormat& newest, uint32_t oldest);
/// The same, of a file's bytes.
ContainerFormat ReadContainerFormat(std::span<const std::byte> bytes, const ContainerFormat& newest,
                                    uint32_t oldest);

/// As ReadContainer, of bytes already in memory (`name` stands for the file in messages).
std::vector<std::byte> ReadContainerBytes(std::span<const std::byte> bytes, const std::string& name,
                                          const ContainerFormat& format);

/// Appends plain values, strings and vectors to a payload.
class PayloadWriter {
 public:
  template <typename T>
  void Put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* bytes = reinterpret_cast<const std::byte*>(&value);
    bytes_.insert(bytes_.end(), bytes, bytes + sizeof(T));
  }
  void PutString(std::string_view text) {
    PutArray(std::span<const char>(text.data(), text.size()));
  }
  /// Count (uint64), then the elements.
  template <typename T>
  void PutArray(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    Put<uint64_t>(values.size());
    const auto bytes = std::as_bytes(values);
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  template <typename T>
  void PutVector(const std::vector<T>& values) {
    PutArray(std::span<const T>(values));
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// Takes them out again. Every count is checked against the bytes left before anything is
/// allocated; throws InputError with file, byte offset and field.
class PayloadReader {
 public:
  PayloadReader(std::span<const std::byte> payload, std::string file)
      : payload_(payload), file_(std::move(file)) {}

  template <typename T>
  T Get(std::string_view field) {
    static_assert(std::is_trivially_copyable_v<T>);
    T value{};
    const auto bytes = Take(sizeof(T), field);
    std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }
  template <typename T>
  std::vector<T> GetVector(std::string_view field) {
    static_assert(std::is_trivially_copyable_v<T>);
    const size_t count = TakeCount(sizeof(T), field);
    const auto bytes = Take(count * sizeof(T), field);
    std::vector<T> values(count);
    if (count > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
  /// A vector of bytes as it lies in the payload, which must stay.
  std::span<const uint8_t> GetBytes(std::string_view field);
  std::string GetString(std::string_view field);

  /// Throws unless the payload is used up.
  void ExpectEnd() const;
  /// An InputError at the present place: "FILE: byte N: field: reason".
  [[noreturn]] void Fail(std::string_view field, const std::string& reason) const;

 private:
  std::span<const std::byte> Take(size_t size, std::string_view field);
  size_t TakeCount(size_t element_size, std::string_view field);

  std::span<const std::byte> payload_;
  size_t offset_ = 0;
  std::string file_;
};

}  // namespace ossa
