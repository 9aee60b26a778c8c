// The .zip format: PKWARE's APPNOTE.TXT 6.3, sections 4.3.7 (local header), 4.3.12 (central
// directory), 4.3.14 to 16 (end records).
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>

#include "depth/base/error.h"
#include "depth/base/open_file.h"
#include "recon/files/zip_table_internal.h"

namespace ossa::recon {
namespace {

// Constants: the format's unless stated otherwise.
constexpr std::string_view kMember = "PK\x03\x04", kEntry = "PK\x01\x02", kEnd = "PK\x05\x06",
                           kLargeEnd = "PK\x06\x06", kLargeEndAt = "PK\x06\x07";
constexpr size_t kMemberSize = 30, kEntrySize = 46, kEndSize = 22, kLargeEndSize = 56,
                 kLargeEndAtSize = 20;
constexpr size_t kLongestComment = 65535;
constexpr uint64_t kInZip64Record = 0xffffffff;
constexpr unsigned kChecksumFollows = 1U << 3U;         // local header flag
constexpr uint64_t kLargestTable = uint64_t{1} << 26U;  // bytes, by hand: a million names

struct Table {
  uint64_t entries = 0;
  uint64_t size = 0;
  uint64_t at = 0;
};

class ZipFile {
 public:
  explicit ZipFile(const std::filesystem::path& path)
      : name_(path.string()), file_(OpenFile(path, std::ios::ate)) {
    if (!file_) throw InputError(name_ + ": cannot be opened for reading");
    size_ = static_cast<uint64_t>(file_.tellg());
  }

  void Check() {
    const Table table = FindTable();
    if (table.size > kLargestTable) Fail(table.at, "a table of members of at most 64 MiB");
    const std::string entries = ReadAt(table.at, table.size);
    size_t at = 0;
    for (uint64_t e = 0; e < table.entries; ++e) at += CheckEntry(entries, at, table.at);
    if (at != entries.size()) Fail(table.at + at, "as many members as the table's end says");
  }

 private:
  [[noreturn]] void Fail(uint64_t at, const std::string& expected) const {
    throw InputError(name_ + ": byte " + std::to_string(at) +
                     ": expected a whole archive: " + expected);
  }

  std::string ReadAt(uint64_t at, uint64_t size) {
    if (at > size_ || size > size_ - at) Fail(size_, "it is cut short");
    std::string bytes(size, '\0');
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(at));
    if (!file_.read(bytes.data(), static_cast<std::streamsize>(size))) Fail(at, "it can be read");
    return bytes;
  }

  static uint64_t Number(std::string_view bytes, size_t at, size_t size) {
    uint64_t value = 0;
    for (size_t i = size; i-- > 0;) value = value << 8U | static_cast<uint8_t>(bytes[at + i]);
    return value;
  }

  // The last end-of-directory record whose comment ends with the file.
  uint64_t FindEnd() {
    const uint64_t size = std::min<uint64_t>(size_, kEndSize + kLongestComment);
    const std::string tail = ReadAt(size_ - size, size);
    for (size_t at = tail.rfind(kEnd); at != tail.npos;
         at = at > 0 ? tail.rfind(kEnd, at - 1) : tail.npos) {
      if (tail.size() - at < kEndSize) continue;
      if (at + kEndSize + Number(tail, at + 20, 2) == tail.size()) return size_ - size + at;
    }
    Fail(size_, "the end of its table of members, found none: it is cut short");
  }

  Table FindTable() {
    const uint64_t end_at = FindEnd();
    const std::string end = ReadAt(end_at, kEndSize);
    Table table{Number(end, 10, 2), Number(end, 12, 4), Number(end, 16, 4)};
    if (Number(end, 4, 2) != 0 || Number(end, 6, 2) != 0 || Number(end, 8, 2) != table.entries) {
      Fail(end_at, "one file");
    }
    if (table.at == kInZip64Record) return FindLargeTable(end_at);
    if (table.at + table.size != end_at) Fail(end_at, "its table of members before its end");
    return table;
  }

  Table FindLargeTable(uint64_t end_at) {
    if (end_at < kLargeEndAtSize) Fail(end_at, "where the end of its table is");
    const std::string where = ReadAt(end_at - kLargeEndAtSize, kLargeEndAtSize);
    if (!where.starts_with(kLargeEndAt)) Fail(end_at, "where the end of its table is");
    const uint64_t large_at = Number(where, 8, 8);
    const std::string end = ReadAt(large_at, kLargeEndSize);
    const Table table{Number(end, 32, 8), Number(end, 40, 8), Number(end, 48, 8)};
    if (!end.starts_with(kLargeEnd) || table.at > large_at || table.size != large_at - table.at) {
      Fail(large_at, "its table of members before its end");
    }
    return table;
  }

  // Whether the DOS or Unix attributes of an entry say folder; folders are not read.
  static bool IsFolderEntry(uint64_t attributes) {
    constexpr uint64_t kDosFolder = 0x10, kUnixKind = 0170000, kUnixFolder = 0040000;
    return (attributes & kDosFolder) != 0 || (attributes >> 16U & kUnixKind) == kUnixFolder;
  }

  // Returns the size of the entry.
  size_t CheckEntry(std::string_view entries, size_t at, uint64_t table_at) {
    if (entries.size() - at < kEntrySize || entries.substr(at, 4) != kEntry) {
      Fail(table_at + at, "an entry of its table of members");
    }
    const auto field = [&](size_t offset, size_t size) {
      return Number(entries, at + offset, size);
    };
    const size_t name_size = field(28, 2);
    const size_t size = kEntrySize + name_size + field(30, 2) + field(32, 2);
    if (entries.size() - at < size) Fail(table_at + at, "an entry of its table of members");
    uint64_t member_at = field(42, 4);
    if (member_at == kInZip64Record) {
      member_at = LargeOffset(entries.substr(at + kEntrySize + name_size, field(30, 2)),
                              {field(24, 4), field(20, 4)}, table_at + at);
    }
    const std::string member = ReadAt(member_at, kMemberSize + name_size);
    const bool follows = (Number(member, 6, 2) & kChecksumFollows) != 0;
    const bool same = member.starts_with(kMember) && Number(member, 8, 2) == field(10, 2) &&
                      (follows || Number(member, 14, 4) == field(16, 4)) &&
                      Number(member, 26, 2) == name_size &&
                      member.substr(kMemberSize) == entries.substr(at + kEntrySize, name_size);
    if (!same) Fail(member_at, "a member as its table says, found another");
    if (IsFolderEntry(field(38, 4)) && !member.ends_with('/')) {
      Fail(table_at + at, "a folder named as one");
    }
    return size;
  }

  // The offset of a member beyond 4 GiB, from the extra field (4.5.3), after the sizes that
  // overflow as well.
  uint64_t LargeOffset(std::string_view extra, std::array<uint64_t, 2> sizes, uint64_t at) const {
    constexpr uint64_t kLargeSizes = 1;
    while (extra.size() >= 4) {
      const size_t size = Number(extra, 2, 2);
      if (size > extra.size() - 4) break;
      if (Number(extra, 0, 2) == kLargeSizes) {
        size_t skip = 4;
        for (const uint64_t value : sizes) skip += value == kInZip64Record ? 8 : 0;
        if (skip + 8 <= size + 4) return Number(extra, skip, 8);
      }
      extra.remove_prefix(4 + size);
    }
    Fail(at, "where its member is");
  }

  std::string name_;
  std::ifstream file_;
  uint64_t size_ = 0;
};

}  // namespace

void CheckZipTable(const std::filesystem::path& path) { ZipFile(path).Check(); }

}  // namespace ossa::recon
