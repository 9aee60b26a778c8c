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

/// A checksummed container, the frame of all our binary files: 8 bytes of magic, byte-order mark,
/// format version, payload length and XXH3 checksum, then the payload (little-endian).
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

/// The payload's checksum in the header, which identifies a file regardless of its name. Throws
/// InputError if the file has no header.
uint64_t ReadContainerChecksum(const std::filesystem::path& path);

/// Reads and verifies the frame; returns the payload. Throws InputError that names the file and the
/// field when magic, byte order, version, length or checksum are not as expected.
std::vector<std::byte> ReadContainer(const std::filesystem::path& path,
                                     const ContainerFormat& format);

/// The format with the version of the file, if it is `oldest` or newer; `newest` for other files,
/// which ReadContainer then refuses.
ContainerFormat ReadContainerFormat(const std::filesystem::path& path,
                                    const ContainerFormat& newest, uint32_t oldest);
/// As above, for the bytes of a file.
ContainerFormat ReadContainerFormat(std::span<const std::byte> bytes, const ContainerFormat& newest,
                                    uint32_t oldest);

/// As ReadContainer, for bytes in memory (`name` stands for the file in messages).
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

/// Reads them back. Every count is checked against the remaining bytes before anything is
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
  /// A vector of bytes, as a view into the payload, which must outlive it.
  std::span<const uint8_t> GetBytes(std::string_view field);
  std::string GetString(std::string_view field);

  /// Throws unless the whole payload has been read.
  void ExpectEnd() const;
  /// Throws an InputError for the current position: "FILE: byte N: field: reason".
  [[noreturn]] void Fail(std::string_view field, const std::string& reason) const;

 private:
  std::span<const std::byte> Take(size_t size, std::string_view field);
  size_t TakeCount(size_t element_size, std::string_view field);

  std::span<const std::byte> payload_;
  size_t offset_ = 0;
  std::string file_;
};

}  // namespace ossa
