#pragma once
// A .zip made here, of nothing but its documented layout: members stored, not deflated.
#include <zlib.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace ossa::recon {

inline std::string LittleEndian(uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> 8 * i & 0xff);
  return text;
}

/// Version, flags, method, time, date, checksum, both sizes, lengths of name and extra field: what
/// a member's own header and the table at the end say alike.
inline std::string ZipMember(const std::string& name, const std::string& content) {
  const uLong checksum =
      crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
  return LittleEndian(20, 2) + std::string(8, '\0') + LittleEndian(checksum, 4) +
         LittleEndian(content.size(), 4) + LittleEndian(content.size(), 4) +
         LittleEndian(name.size(), 2) + LittleEndian(0, 2);
}

/// Members are given by name and content.
inline std::string Zip(const std::vector<std::pair<std::string, std::string>>& members) {
  std::string bytes, table;
  for (const auto& [name, content] : members) {
    const std::string member = ZipMember(name, content);
    table += "PK\x01\x02" + LittleEndian(20, 2) + member + std::string(10, '\0') +
             LittleEndian(bytes.size(), 4) + name;
    bytes += "PK\x03\x04" + member + name + content;
  }
  const size_t at = bytes.size();
  return bytes + table + "PK\x05\x06" + std::string(4, '\0') + LittleEndian(members.size(), 2) +
         LittleEndian(members.size(), 2) + LittleEndian(table.size(), 4) + LittleEndian(at, 4) +
         LittleEndian(0, 2);
}

}  // namespace ossa::recon
