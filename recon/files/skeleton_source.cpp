#include <archive.h>
#include <archive_entry.h>
#include <locale.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>

#include "depth/base/error.h"
#include "recon/files/skeleton_source_internal.h"

namespace ossa::recon {
namespace {

// Constants: bytes, bounds, by hand.

constexpr size_t kMostBytes = size_t{1} << 30;

using Archive = std::unique_ptr<archive, decltype(&archive_read_free)>;

[[noreturn]] void Fail(const std::filesystem::path& path, archive* reader) {
  const char* reason = archive_error_string(reader);
  throw InputError(path.string() + ": byte " + std::to_string(archive_filter_bytes(reader, -1)) +
                   ": expected a whole archive, found damage (" +
                   (reason != nullptr ? reason : "unknown") + ")");
}

// Raw opens anything; it is asked for only where the file is known to be a plain .gz.
Archive TryOpen(const std::filesystem::path& path, bool raw, int& status) {
  Archive reader(archive_read_new(), archive_read_free);
  archive_read_support_filter_gzip(reader.get());
  if (raw) {
    archive_read_support_format_raw(reader.get());
  } else {
    archive_read_support_format_tar(reader.get());
    archive_read_support_format_zip(reader.get());
  }
  constexpr size_t kBlock = size_t{1} << 16;
  status = archive_read_open_filename(reader.get(), path.c_str(), kBlock);
  return reader;
}

Archive Open(const std::filesystem::path& path, bool raw) {
  int status = ARCHIVE_OK;
  Archive reader = TryOpen(path, raw, status);
  if (status != ARCHIVE_OK) Fail(path, reader.get());
  return reader;
}

std::string ReadMember(const std::filesystem::path& path, archive* reader, size_t& total) {
  std::string content;
  std::array<char, 1 << 16> block{};
  for (;;) {
    const la_ssize_t size = archive_read_data(reader, block.data(), block.size());
    if (size < 0) Fail(path, reader);
    if (size == 0) return content;
    total += static_cast<size_t>(size);
    if (total > kMostBytes) throw InputError(path.string() + ": unfolds to more than 1 GiB");
    content.append(block.data(), static_cast<size_t>(size));
  }
}

// Programs begin in the C locale, in which libarchive has no name for members of a .zip that are
// named beyond ASCII: they would all be one. For this thread, and for characters only.
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

// Of a name under which something is written into a folder: whether it would lie elsewhere.
bool LeadsOut(const std::filesystem::path& name) {
  return name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end();
}

std::string FirstBytes(const std::filesystem::path& path, size_t count) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(count, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<size_t>(file.gcount()));
  return bytes;
}

// Columns are said before or after the member; a member's own name may hold a '#'.
void TakeWords(std::string words, SkeletonPath& parts) {
  const size_t last = words.rfind('#') + 1;  // 0 without one
  const size_t first = std::min(words.find('#'), words.size());
  if (parts.columns = ColumnsNamed(words.substr(last)); !parts.columns.empty()) {
    words.resize(last > 0 ? last - 1 : 0);
  } else if (parts.columns = ColumnsNamed(words.substr(0, first)); !parts.columns.empty()) {
    words.erase(0, first + 1);
  }
  parts.member = std::move(words);
}

}  // namespace

std::string ColumnsNamed(const std::string& word) {
  for (const char* name : {"truth", "vicon", "G", "ground-truth"}) {
    if (word == name) return "truth";
  }
  for (const char* name : {"observed", "kinect", "estimate", "a2j", "K", "P"}) {
    if (word == name) return "observed";
  }
  return {};
}

SkeletonPath TakeApart(const std::filesystem::path& path) {
  const std::string text = path.string();
  for (size_t end = text.size(); end != std::string::npos && end > 0;
       end = text.rfind('#', end - 1)) {
    std::error_code unknown;
    const std::string left = text.substr(0, end);
    if (!std::filesystem::exists(left, unknown)) continue;
    SkeletonPath parts{left, {}, {}};
    if (end < text.size()) TakeWords(text.substr(end + 1), parts);
    return parts;
  }
  return {path, {}, {}};
}

bool IsGzip(const std::filesystem::path& path) { return FirstBytes(path, 2) == "\x1F\x8B"; }

bool IsArchive(const std::filesystem::path& path) {
  const std::string head = FirstBytes(path, 262);
  if (head.starts_with("PK\x03\x04") ||
      head.substr(std::min<size_t>(257, head.size())) == "ustar") {
    return true;
  }
  if (!head.starts_with("\x1F\x8B")) return false;
  // A gzip holds an archive when a first tar header can be read from it.
  const std::string name = path.filename().string();
  if (name.ends_with(".tgz") || name.ends_with(".tar.gz")) return true;
  int status = ARCHIVE_OK;
  Archive reader = TryOpen(path, false, status);
  archive_entry* entry = nullptr;
  return status == ARCHIVE_OK && archive_read_next_header(reader.get(), &entry) == ARCHIVE_OK;
}

std::map<std::string, std::string> ReadArchive(const std::filesystem::path& path) {
  const Utf8Names names;
  Archive reader = Open(path, false);
  std::map<std::string, std::string> members;
  size_t total = 0;
  for (;;) {
    archive_entry* entry = nullptr;
    const int status = archive_read_next_header(reader.get(), &entry);
    if (status == ARCHIVE_EOF) return members;
    if (status < ARCHIVE_WARN) Fail(path, reader.get());
    if (archive_entry_filetype(entry) != AE_IFREG) continue;
    const std::string name = NameOf(entry, members.size());
    if (LeadsOut(name)) {
      throw InputError(path.string() + "#" + name +
                       ": expected members named as within the archive, found one that leads out");
    }
    members[name] = ReadMember(path, reader.get(), total);
  }
}

std::string ReadGzip(const std::filesystem::path& path) {
  Archive reader = Open(path, true);
  archive_entry* entry = nullptr;
  if (archive_read_next_header(reader.get(), &entry) < ARCHIVE_WARN) Fail(path, reader.get());
  size_t total = 0;
  return ReadMember(path, reader.get(), total);
}

}  // namespace ossa::recon
