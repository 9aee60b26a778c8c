#include "depth/base/checksummed_container.h"

#include <xxhash.h>

#include <system_error>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/large_pages.h"
#include "depth/base/open_file.h"

namespace ossa {
namespace {

constexpr uint32_t kByteOrderMark = 0x01020304;  // our format

struct Header {
  std::array<char, 8> magic{};
  uint32_t byte_order = kByteOrderMark;
  uint32_t version = 0;
  uint64_t payload_size = 0;
  uint64_t checksum = 0;
};
static_assert(sizeof(Header) == 32);

uint64_t Checksum(std::span<const std::byte> bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

// The header, checked except for the checksum: `bytes` start with it, if long enough, and are
// followed by more, `size` in total. Files of another kind are refused by their header alone; they
// may not even fit into memory.
Header CheckedHeader(std::span<const std::byte> bytes, uint64_t size, const std::string& name,
                     const ContainerFormat& format) {
  const std::string what(format.what);
  Header header;
  if (bytes.size() < sizeof(header)) {
    throw InputError(name + ": byte 0: expected the 32-byte header of a " + what + ", found " +
                     std::to_string(bytes.size()) + " bytes");
  }
  std::memcpy(&header, bytes.data(), sizeof(header));
  if (header.magic != format.magic) {
    throw InputError(name + ": byte 0: magic: this is not a " + what);
  }
  if (header.byte_order != kByteOrderMark) {
    throw InputError(name + ": byte 8: byte order: written on a machine of the other byte order");
  }
  if (header.version != format.version) {
    throw InputError(name + ": byte 12: version: expected " + std::to_string(format.version) +
                     ", found " + std::to_string(header.version));
  }
  if (header.payload_size != size - sizeof(header)) {
    throw InputError(name + ": byte 16: length: expected " + std::to_string(header.payload_size) +
                     " bytes of payload, found " + std::to_string(size - sizeof(header)));
  }
  return header;
}

void CheckPayload(std::span<const std::byte> payload, const Header& header, const std::string& name,
                  const ContainerFormat& format) {
  if (header.checksum != Checksum(payload)) {
    throw InputError(name + ": byte 24: checksum: the " + std::string(format.what) + " is damaged");
  }
}

// Reads the next bytes of the file; fewer at its end.
std::vector<std::byte> NextBytes(std::ifstream& file, size_t at_most) {
  auto bytes = MakeLargeVector<std::byte>(at_most);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(at_most));
  bytes.resize(static_cast<size_t>(file.gcount()));
  return bytes;
}

}  // namespace

void WriteContainer(const std::filesystem::path& path, const ContainerFormat& format,
                    std::span<const std::byte> payload) {
  const Header header{format.magic, kByteOrderMark, format.version, payload.size(),
                      Checksum(payload)};
  AtomicFile file(path);
  file.stream().write(reinterpret_cast<const char*>(&header), sizeof(header));
  file.stream().write(reinterpret_cast<const char*>(payload.data()),
                      static_cast<std::streamsize>(payload.size()));
  file.Commit();
}

std::vector<std::byte> ReadContainerBytes(std::span<const std::byte> bytes, const std::string& name,
                                          const ContainerFormat& format) {
  const Header header = CheckedHeader(bytes, bytes.size(), name, format);
  const auto payload = bytes.subspan(sizeof(header));
  CheckPayload(payload, header, name, format);
  return {payload.begin(), payload.end()};
}

bool IsContainer(const std::filesystem::path& path, const ContainerFormat& format) {
  std::ifstream file = OpenFile(path);
  std::array<char, 8> magic{};
  file.read(magic.data(), magic.size());
  return file && magic == format.magic;
}

uint64_t ReadContainerChecksum(const std::filesystem::path& path) {
  std::ifstream file = OpenFile(path);
  Header header;
  file.read(reinterpret_cast<char*>(&header), sizeof(header));
  if (!file) throw InputError(path.string() + ": byte 0: expected a header of 32 bytes");
  return header.checksum;
}

ContainerFormat ReadContainerFormat(std::span<const std::byte> bytes, const ContainerFormat& newest,
                                    uint32_t oldest) {
  Header header;
  if (bytes.size() < sizeof(header)) return newest;
  std::memcpy(&header, bytes.data(), sizeof(header));
  ContainerFormat format = newest;
  if (header.version >= oldest && header.version < newest.version) format.version = header.version;
  return format;
}

ContainerFormat ReadContainerFormat(const std::filesystem::path& path,
                                    const ContainerFormat& newest, uint32_t oldest) {
  std::ifstream file = OpenFile(path);
  return ReadContainerFormat(NextBytes(file, sizeof(Header)), newest, oldest);
}

std::vector<std::byte> ReadContainer(const std::filesystem::path& path,
                                     const ContainerFormat& format) {
  std::ifstream file = OpenFile(path, std::ios::ate);
  if (!file) {
    std::error_code unknown;
    const bool is_there = std::filesystem::exists(path, unknown);
    throw InputError(path.string() + (is_there ? ": cannot be read" : ": no such file") +
                     ": expected a " + std::string(format.what));
  }
  const auto size = static_cast<uint64_t>(file.tellg());
  file.seekg(0);
  const Header header = CheckedHeader(NextBytes(file, sizeof(Header)), size, path.string(), format);
  std::vector<std::byte> payload = NextBytes(file, header.payload_size);
  if (payload.size() != header.payload_size) throw InputError(path.string() + ": reading failed");
  CheckPayload(payload, header, path.string(), format);
  return payload;
}

std::span<const uint8_t> PayloadReader::GetBytes(std::string_view field) {
  const auto bytes = Take(TakeCount(1, field), field);
  return {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()};
}

std::string PayloadReader::GetString(std::string_view field) {
  const std::vector<char> text = GetVector<char>(field);
  return {text.begin(), text.end()};
}

void PayloadReader::ExpectEnd() const {
  if (offset_ != payload_.size()) {
    Fail("end", std::to_string(payload_.size() - offset_) + " bytes too many");
  }
}

void PayloadReader::Fail(std::string_view field, const std::string& reason) const {
  throw InputError(file_ + ": byte " + std::to_string(offset_ + sizeof(Header)) + ": " +
                   std::string(field) + ": " + reason);
}

std::span<const std::byte> PayloadReader::Take(size_t size, std::string_view field) {
  if (size > payload_.size() - offset_) {
    Fail(field, "expected " + std::to_string(size) + " bytes, found " +
                    std::to_string(payload_.size() - offset_));
  }
  const auto bytes = payload_.subspan(offset_, size);
  offset_ += size;
  return bytes;
}

size_t PayloadReader::TakeCount(size_t element_size, std::string_view field) {
  const auto count = Get<uint64_t>(field);
  if (count > (payload_.size() - offset_) / element_size) {
    Fail(field, "count " + std::to_string(count) + " is more than the file holds");
  }
  return static_cast<size_t>(count);
}

}  // namespace ossa
