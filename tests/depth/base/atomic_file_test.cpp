#include "depth/base/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <optional>

#include "depth/base/folder_lock.h"
#include "depth/base/leftovers.h"
#include "tests/support/full_disk.h"
#include "tests/support/temporary_folder.h"

namespace ossa {
namespace {

TEST(AtomicFile, LeavesNoFileWithoutCommit) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("ossa_atomic_" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  { AtomicFile(folder / "out.txt").stream() << "half"; }
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  AtomicFile file(folder / "out.txt");
  file.stream() << "whole";
  EXPECT_FALSE(std::filesystem::exists(folder / "out.txt"));
  file.Commit();
  EXPECT_TRUE(std::filesystem::exists(folder / "out.txt"));
  std::filesystem::remove_all(folder);
}

// A rename would replace /dev/null by a file.
TEST(AtomicFile, ReplacesRegularFilesOnly) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "folder");
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  for (const char* name : {"folder", "pipe", "nowhere/file"}) {
    EXPECT_THROW(AtomicFile::CheckWritable(folder / name), InputError) << name;
  }
  EXPECT_NO_THROW(AtomicFile::CheckWritable(folder / "new"));
  EXPECT_FALSE(std::filesystem::exists(folder / "new"));
}

// Otherwise a link to another disk would be replaced by a file on this one.
TEST(AtomicFile, WritesTheTargetOfALink) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "large_disk");
  std::filesystem::create_symlink("large_disk/out", folder / "link");
  std::filesystem::create_symlink(folder / "link", folder / "link_to_link");
  std::filesystem::create_symlink("round", folder / "round");
  for (const std::string text : {"new", "again"}) {
    AtomicFile file(folder / "link_to_link");
    file.stream() << text;
    file.Commit();
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link_to_link"));
    std::string found;
    std::ifstream(folder / "large_disk/out") >> found;
    EXPECT_EQ(found, text);
  }
  EXPECT_THROW(AtomicFile::CheckWritable(folder / "round"), InputError);
}

TEST(AtomicFile, DoesNotReplaceAWriteProtectedFile) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write anything";
  const test::TemporaryFolder folder;
  std::ofstream(folder / "kept") << "as it is";
  std::filesystem::permissions(folder / "kept", std::filesystem::perms::owner_read);
  EXPECT_THROW(AtomicFile::CheckWritable(folder / "kept"), InputError);
}

// Private files stay private, and group-shared ones shared.
TEST(AtomicFile, KeepsThePermissionsOfAReplacedFile) {
  const test::TemporaryFolder folder;
  for (const mode_t mode : {0600U, 0664U}) {
    std::ofstream(folder / "out") << "old";
    ASSERT_EQ(chmod((folder / "out").c_str(), mode), 0);
    AtomicFile file(folder / "out");
    file.stream() << "new";
    file.Commit();
    struct stat found {};
    ASSERT_EQ(stat((folder / "out").c_str(), &found), 0);
    EXPECT_EQ(found.st_mode & 0777U, mode);
  }
}

std::string TextOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Leftovers are listed but kept: they may be the user's only recording.
TEST(AtomicFile, FindsAndKeepsLeftoversOfKilledProcesses) {
  const test::TemporaryFolder folder;
  const auto leave = [&](const std::string& name) {
    std::ofstream(folder / name) << "half";
    return folder / name;
  };
  const auto left = leave("out.oni.partial-00c0ffee0000");
  const auto old = leave("out.oni.partial-1234");  // by process id, as in earlier versions
  leave("out.oni");
  leave("other.oni.partial-00c0ffee0000");
  leave("out.oni2.partial-1234");
  std::filesystem::create_symlink("out.oni", folder / "out.oni.partial-link");
  const AtomicFile alive(folder / "out.oni");
  const std::vector<std::filesystem::path> expected = {left, old};
  EXPECT_EQ(AtomicFile::FindLeftovers(folder / "out.oni"), expected);
  AtomicFile::CheckWritable(folder / "out.oni");
  AtomicFile(folder / "out.oni").Commit();
  EXPECT_EQ(TextOf(left), "half");
  EXPECT_EQ(TextOf(old), "half");
}

// File names usually may have 255 bytes, all of which users may use.
TEST(AtomicFile, AcceptsTheLongestNameOfTheFileSystem) {
  const test::TemporaryFolder folder;
  for (size_t length = 230; length <= 255; ++length) {
    std::string name = "n";
    while (name.size() + 2 <= length) name += "\u00e9";
    name.resize(length, 'n');
    AtomicFile file(folder / name);
    EXPECT_NE(file.temporary_path().filename().string().find(".partial-"), std::string::npos);
    file.stream() << "whole";
    file.Commit();
    EXPECT_EQ(TextOf(folder / name), "whole") << length;
  }
  EXPECT_THROW(AtomicFile(folder / std::string(256, 'n')), InputError);
}

// The extension identifies an incomplete recording.
TEST(AtomicFile, ShortenedNameKeepsItsExtension) {
  const test::TemporaryFolder folder;
  const AtomicFile file(folder / (std::string(251, 'n') + ".oni"));
  EXPECT_EQ(file.temporary_path().stem().extension(), ".oni");
}

TEST(AtomicFile, LeftoversOfShortenedNamesDoNotCollide) {
  const test::TemporaryFolder folder;
  const auto first = folder / (std::string(254, 'n') + "1"),
             second = folder / (std::string(254, 'n') + "2");
  std::filesystem::path left;
  {
    const AtomicFile killed(first);
    left = killed.temporary_path();
  }
  std::ofstream(left) << "half";
  EXPECT_EQ(AtomicFile::FindLeftovers(first), std::vector{left});
  EXPECT_TRUE(AtomicFile::FindLeftovers(second).empty());
}

TEST(AtomicFile, RemovesLeftoversInAFolder) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "depth");
  const std::string left = folder / "depth/0.png.partial-0123456789ab";
  const std::string others = folder / "notes.partial-0123", made = folder / "depth/0.png";
  for (const std::string& path : {left, others, made}) std::ofstream(path) << "x";
  const AtomicFile alive(folder / "depth/1.png");
  RemoveLeftovers(folder.path());
  EXPECT_FALSE(std::filesystem::exists(left));
  EXPECT_TRUE(std::filesystem::exists(others));
  EXPECT_TRUE(std::filesystem::exists(made));
  EXPECT_TRUE(std::filesystem::exists(alive.temporary_path()));
}

TEST(AtomicFile, RemovesLeftoversOfOneFile) {
  const test::TemporaryFolder folder;
  const std::string left = folder / "m.partial-0123456789ab", notes = folder / "m.partial-notes";
  const std::string others = folder / "m2.partial-0123456789ab", made = folder / "m";
  for (const std::string& path : {left, notes, others, made}) std::ofstream(path) << "x";
  const AtomicFile alive(made);
  RemoveLeftoversOf(made);
  EXPECT_FALSE(std::filesystem::exists(left));
  for (const std::filesystem::path& path :
       {std::filesystem::path(notes), std::filesystem::path(others), std::filesystem::path(made),
        alive.temporary_path()}) {
    EXPECT_TRUE(std::filesystem::exists(path)) << path;
  }
}

// Two writers of one name, in one process or two: each writes its own file, and the result is
// complete.
TEST(AtomicFile, LastOfTwoWritersWinsWithACompleteFile) {
  const test::TemporaryFolder folder;
  AtomicFile first(folder / "out"), second(folder / "out");
  EXPECT_NE(first.temporary_path(), second.temporary_path());
  first.stream() << "the first one's";
  second.stream() << "the second's";
  second.Commit();
  EXPECT_EQ(TextOf(folder / "out"), "the second's");
  first.Commit();
  EXPECT_EQ(TextOf(folder / "out"), "the first one's");
}

// In a folder that others may write to, a link is put in the file's place: its target is not
// modified.
TEST(AtomicFile, NeverWritesThroughALinkUnderItsTemporaryName) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "precious") << "precious";
  AtomicFile file(folder / "out");
  std::filesystem::remove(file.temporary_path());
  std::filesystem::create_symlink("precious", file.temporary_path());
  file.stream() << "new" << std::flush;
  file.CutTo(0);
  EXPECT_EQ(TextOf(folder / "precious"), "precious");
}

// The lock shows that the file is being written.
TEST(AtomicFile, IsLockedWhileItIsWritten) {
  const test::TemporaryFolder folder;
  std::optional<AtomicFile> file(folder / "out");
  const int other = open(file->temporary_path().c_str(), O_WRONLY);
  EXPECT_NE(flock(other, LOCK_EX | LOCK_NB), 0);
  file.reset();
  EXPECT_EQ(flock(other, LOCK_EX | LOCK_NB), 0);
  close(other);
}

TEST(AtomicFile, CutToTruncatesAndContinuesThere) {
  const test::TemporaryFolder folder;
  AtomicFile file(folder / "out");
  file.stream() << "kept, gone" << std::flush;
  file.stream().setstate(std::ios::badbit);
  file.CutTo(4);
  EXPECT_THROW(file.CutTo(5), InputError);
  file.CutTo(4);
  file.stream() << "!";
  file.Commit();
  std::string text;
  std::getline(std::ifstream(folder / "out"), text);
  EXPECT_EQ(text, "kept!");
}

TEST(AtomicFile, RemoveBytesMovesUpTheRest) {
  const test::TemporaryFolder folder;
  AtomicFile file(folder / "out");
  const std::string rows(size_t{3} << 20, 'r');  // more than is moved at a time
  file.stream() << "head....." << rows;
  file.RemoveBytes(4, 5);
  file.stream() << "end";
  file.Commit();
  EXPECT_EQ(TextOf(folder / "out"), "head" + rows + "end");
}

TEST(AtomicFile, HeaderCanBeOverwritten) {
  const test::TemporaryFolder folder;
  AtomicFile file(folder / "out");
  file.stream() << "0 rows\nrow\n";
  file.stream().seekp(0);
  file.stream() << "1";
  file.Commit();
  EXPECT_EQ(TextOf(folder / "out"), "1 rows\nrow\n");
}

TEST(AtomicFile, ReportsAFullDiskBeforeTheEnd) {
  const test::TemporaryFolder folder;
  AtomicFile file(folder / "out");
  EXPECT_NO_THROW(file.Check());
  file.stream().setstate(std::ios::badbit);
  EXPECT_THROW(file.Check(), InputError);
}

TEST(AtomicFile, ThrowsOnAFullDisk) {
  const test::TemporaryFolder folder;
  const test::FullDisk disk(10);
  AtomicFile file(folder / "out");
  file.stream() << "12345678";
  EXPECT_NO_THROW(file.Flush());
  file.stream() << "9abcdef";
  EXPECT_THROW(file.Flush(), DiskFull);
  file.CutTo(8);
  file.Commit();
  EXPECT_EQ(TextOf(folder / "out"), "12345678");
}

TEST(FolderLock, IsHeldByOneAndGivenBack) {
  const test::TemporaryFolder folder;
  {
    const FolderLock first(folder / "a/b");
    EXPECT_THROW(FolderLock(folder / "a/b"), InputError);
    EXPECT_NO_THROW(FolderLock(folder / "a"));
  }
  EXPECT_NO_THROW(FolderLock(folder / "a/b"));
  std::ofstream(folder / "file") << "no folder";
  EXPECT_THROW(FolderLock(folder / "file"), InputError);
}

}  // namespace
}  // namespace ossa
