#include <archive.h>
#include <archive_entry.h>
#include <locale.h>

#include <algorithm>
#include <array>
#include <exception>
#include <fstream>
#include <memory>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "recon/files/archive_bytes_internal.h"
#include "recon/files/gzip_bytes_internal.h"
#include "recon/files/zip_table_internal.h"

namespace ossa::recon {
namespace {

// Constants: bounds by hand.
constexpr size_t kMostBytes = size_t{1} << 30;
// The largest public skeleton data sets have some ten thousand recordings per file.
constexpr size_t kMostMembers = 100000;

[[noreturn]] void FailTooLarge(const std::filesystem::path& path) {
  throw InputError(path.string() + ": unfolds to more than 1 GiB");
}

std::string FirstBytes(const std::filesystem::path& path, size_t count) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(count, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<size_t>(file.gcount()));
  return bytes;
}

// The input of libarchive: a file, or the content of a gzip file.
class ArchiveBytes {
 public:
  explicit ArchiveBytes(const std::filesystem::path& path) {
    if (IsGzip(path)) {
      gzip_ = std::make_unique<GzipBytes>(path);
    } else {
      file_.open(path, std::ios::binary);
    }
  }

  std::span<const char> Next() {
    const std::span<const char> piece = gzip_ ? gzip_->Next() : NextOfFile();
    const size_t zeros = static_cast<size_t>(
        std::find_if(piece.rbegin(), piece.rend(), [](char c) { return c != 0; }) - piece.rbegin());
    zeros_ = zeros == piece.size() ? zeros_ + zeros : zeros;
    return piece;
  }
  /// Number of trailing zero bytes of the input so far.
  size_t zeros_at_the_end() const { return zeros_; }
  /// Exception thrown by Next inside libarchive, which is C and must not be unwound.
  std::exception_ptr failure;

 private:
  std::span<const char> NextOfFile() {
    file_.read(block_.data(), static_cast<std::streamsize>(block_.size()));
    return std::span(block_).first(static_cast<size_t>(file_.gcount()));
  }

  std::unique_ptr<GzipBytes> gzip_;
  std::ifstream file_;
  std::array<char, size_t{1} << 16> block_;
  size_t zeros_ = 0;
};

la_ssize_t NextForArchive(archive*, void* from, const void** piece) {
  auto& bytes = *static_cast<ArchiveBytes*>(from);
  try {
    const auto next = bytes.Next();
    *piece = next.data();
    return static_cast<la_ssize_t>(next.size());
  } catch (...) {
    bytes.failure = std::current_exception();
    return ARCHIVE_FATAL;
  }
}

class Archive {
 public:
  explicit Archive(const std::filesystem::path& path)
      : path_(path), bytes_(path), reader_(archive_read_new(), archive_read_free) {
    archive_read_support_format_tar(reader_.get());
    archive_read_support_format_zip(reader_.get());
    is_zip_ = FirstBytes(path, kZip.size()) == kZip;
    if (is_zip_) CheckZipTable(path);
    // A zip's central directory is at its end.
    constexpr size_t kBlock = size_t{1} << 16;
    status_ = is_zip_ ? archive_read_open_filename(reader_.get(), path.c_str(), kBlock)
                      : archive_read_open(reader_.get(), &bytes_, nullptr, NextForArchive, nullptr);
  }

  archive* get() const { return reader_.get(); }
  bool is_open() const { return status_ == ARCHIVE_OK; }
  /// Whether a member is a file. A zip's file types are not reliable; folders in it have names that
  /// end in '/'.
  bool IsFile(archive_entry* entry, const std::string& name) const {
    return is_zip_ ? !name.ends_with('/') : archive_entry_filetype(entry) == AE_IFREG;
  }

  /// Null at the end.
  archive_entry* Next() {
    archive_entry* entry = nullptr;
    const int status = archive_read_next_header(reader_.get(), &entry);
    if (status == ARCHIVE_EOF) return nullptr;
    if (status < ARCHIVE_WARN) Fail();
    return entry;
  }

  std::string Content(size_t& total) {
    std::string content;
    std::array<char, 1 << 16> block{};
    for (;;) {
      const la_ssize_t size = archive_read_data(reader_.get(), block.data(), block.size());
      if (size < 0) Fail();
      if (size == 0) return content;
      total += static_cast<size_t>(size);
      if (total > kMostBytes) FailTooLarge(path_);
      content.append(block.data(), static_cast<size_t>(size));
    }
  }

  /// Reads what libarchive leaves unread: a gzip's checksum, and a tar's two empty end blocks,
  /// without which a tar that was cut between two members would pass for a complete one.
  void CheckEnd() {
    if (is_zip_) return;
    while (!bytes_.Next().empty()) {
    }
    constexpr size_t kEmptyBlocks = 1024;  // bytes, of the format
    if (bytes_.zeros_at_the_end() >= kEmptyBlocks) return;
    throw InputError(path_.string() +
                     ": expected a whole archive, found no end of it: it is cut short");
  }

  [[noreturn]] void Fail() const {
    if (bytes_.failure) std::rethrow_exception(bytes_.failure);
    const char* reason = archive_error_string(reader_.get());
    throw InputError(path_.string() + ": byte " +
                     std::to_string(archive_filter_bytes(reader_.get(), -1)) +
                     ": expected a whole archive, found damage (" +
                     (reason != nullptr ? reason : "unknown") + ")");
  }

  static constexpr std::string_view kZip = "PK\x03\x04";

 private:
  std::filesystem::path path_;
  ArchiveBytes bytes_;
  std::unique_ptr<archive, decltype(&archive_read_free)> reader_;
  bool is_zip_ = false;
  int status_ = ARCHIVE_OK;
};

// Programs start in the C locale, in which libarchive has no names for .zip members outside ASCII:
// all would be the same. Sets UTF-8 for this thread, and for character types only.
class Utf8Names {
 public:
  Utf8Names() : utf8_(newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr)) {
    if (utf8_ != nullptr) before_ = uselocale(utf8_);
  }
  ~Utf8Names() {
    if (utf8_ == nullptr) return;
    uselocale(before_);
    freelocale(utf8_);
  }
  Utf8Names(const Utf8Names&) = delete;
  Utf8Names& operator=(const Utf8Names&) = delete;

 private:
  locale_t utf8_;
  locale_t before_ = nullptr;
};

std::string NameOf(archive_entry* entry, size_t number) {
  const char* name = archive_entry_pathname(entry);
  return name != nullptr ? name : "member " + std::to_string(number);
}

// Whether a relative name would lie outside the folder that it is written into.
bool EscapesFolder(const std::filesystem::path& name) {
  return name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end();
}

// As the member is called once it is unpacked: 'tar cf x.tar .' writes "./walk.bvh".
std::string NameInFolder(const std::filesystem::path& name) {
  return name.lexically_normal().generic_string();
}

}  // namespace

bool IsGzip(const std::filesystem::path& path) { return FirstBytes(path, 2) == "\x1F\x8B"; }

bool IsArchive(const std::filesystem::path& path) {
  constexpr size_t kTarMagic = 257;  // bytes before it
  const std::string head = FirstBytes(path, kTarMagic + 5);
  if (head.starts_with(Archive::kZip) || head.substr(std::min(kTarMagic, head.size())) == "ustar") {
    return true;
  }
  if (!head.starts_with("\x1F\x8B")) return false;
  // A gzip file holds an archive if it starts with a valid tar header.
  const std::string name = path.filename().string();
  if (HasEnding(name, ".tgz") || HasEnding(name, ".tar.gz")) return true;
  const Archive archive(path);
  archive_entry* entry = nullptr;
  return archive.is_open() && archive_read_next_header(archive.get(), &entry) == ARCHIVE_OK;
}

std::map<std::string, std::string> ReadArchive(const std::filesystem::path& path) {
  const Utf8Names names;
  Archive archive(path);
  if (!archive.is_open()) archive.Fail();
  std::map<std::string, std::string> members;
  size_t total = 0, count = 0;
  while (archive_entry* entry = archive.Next()) {
    if (++count > kMostMembers) {
      throw InputError(path.string() + ": expected an archive of at most " +
                       std::to_string(kMostMembers) + " members, found more");
    }
    const std::string name = NameOf(entry, members.size());
    if (!archive.IsFile(entry, name)) continue;
    if (EscapesFolder(name)) {
      throw InputError(path.string() + "#" + name +
                       ": expected members named as within the archive, found one that leads out");
    }
    members[NameInFolder(name)] = archive.Content(total);
  }
  archive.CheckEnd();
  return members;
}

std::string ReadGzip(const std::filesystem::path& path) {
  GzipBytes bytes(path);
  std::string content;
  for (auto piece = bytes.Next(); !piece.empty(); piece = bytes.Next()) {
    if (content.size() + piece.size() > kMostBytes) FailTooLarge(path);
    content.append(piece.data(), piece.size());
  }
  return content;
}

}  // namespace ossa::recon
