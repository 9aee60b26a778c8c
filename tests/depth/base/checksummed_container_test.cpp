#include "depth/base/checksummed_container.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <optional>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/folder_lock.h"
#include "depth/base/open_file.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa {
namespace {

constexpr ContainerFormat kFormat{{'o', 's', 's', 'a', 't', 'e', 's', 't'}, 7, "test file"};

std::vector<std::byte> ContainerExample() {
  PayloadWriter writer;
  writer.Put<int32_t>(42);
  writer.PutString("bones");
  const auto path =
      std::filesystem::temp_directory_path() / ("ossa_sealed_" + std::to_string(getpid()) + ".bin");
  WriteContainer(path, kFormat, writer.bytes());
  std::ifstream file(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  std::filesystem::remove(path);
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

TEST(ChecksummedContainer, GivesBackWhatWasWritten) {
  const auto payload = ReadContainerBytes(ContainerExample(), "x", kFormat);
  PayloadReader reader(payload, "x");
  EXPECT_EQ(reader.Get<int32_t>("number"), 42);
  EXPECT_EQ(reader.GetString("name"), "bones");
  EXPECT_NO_THROW(reader.ExpectEnd());
}

struct Damage {
  size_t byte;
  const char* named;
};

class DamagedContainer : public testing::TestWithParam<Damage> {};

TEST_P(DamagedContainer, IsRefusedByTheNameOfTheField) {
  auto bytes = ContainerExample();
  bytes.at(GetParam().byte) ^= std::byte{0x10};
  try {
    ReadContainerBytes(bytes, "file.bin", kFormat);
    FAIL() << "damage at byte " << GetParam().byte << " was not noticed";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().named), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(EveryField, DamagedContainer,
                         testing::Values(Damage{0, "magic"}, Damage{8, "byte order"},
                                         Damage{12, "version"}, Damage{16, "length"},
                                         Damage{24, "checksum"}, Damage{33, "checksum"}));

// A terabyte that takes no room on the disk.
TEST(ChecksummedContainer, AnotherFileIsRefusedByItsHeaderBeforeAllocating) {
  const test::TemporaryFolder folder;
  for (const auto& [name, field] : {std::pair("other", "magic"), {"longer", "length"}}) {
    if (name == std::string("other")) {
      std::ofstream(folder / name) << "NI10 and so on";
    } else {
      WriteContainer(folder / name, kFormat, {});
    }
    std::filesystem::resize_file(folder / name, uintmax_t{1} << 40U);
    const auto path = folder / name;  // clang 14 captures no binding
    test::ExpectRefused([&] { ReadContainer(path, kFormat); }, field);
  }
}

TEST(ChecksummedContainer, ShorterThanItsHeaderIsRefused) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "short") << "ossatest";
  test::ExpectRefused([&] { ReadContainer(folder / "short", kFormat); }, "found 8 bytes");
}

TEST(ChecksummedContainer, ACountLargerThanTheFileIsRefusedBeforeAllocating) {
  PayloadWriter writer;
  writer.Put<uint64_t>(uint64_t{1} << 60);
  PayloadReader reader(writer.bytes(), "x");
  EXPECT_THROW(reader.GetVector<double>("values"), InputError);
}

TEST(AtomicFile, LeavesNothingBehindWithoutCommit) {
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

// A rename would put a file in the place of /dev/null.
TEST(AtomicFile, TakesThePlaceOfAFileOnly) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "folder");
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  for (const char* name : {"folder", "pipe", "nowhere/file"}) {
    EXPECT_THROW(AtomicFile::CheckWritable(folder / name), InputError) << name;
  }
  EXPECT_NO_THROW(AtomicFile::CheckWritable(folder / "new"));
  EXPECT_FALSE(std::filesystem::exists(folder / "new"));
}

// Else the disk that a link leads away from would be filled.
TEST(AtomicFile, ALinkStaysAndWhatItLeadsToIsWritten) {
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

TEST(AtomicFile, AFileThatMayNotBeWrittenIsNotReplaced) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write anything";
  const test::TemporaryFolder folder;
  std::ofstream(folder / "kept") << "as it is";
  std::filesystem::permissions(folder / "kept", std::filesystem::perms::owner_read);
  EXPECT_THROW(AtomicFile::CheckWritable(folder / "kept"), InputError);
}

// The number of a process that was.
pid_t DeadProcess() {
  const pid_t process = fork();
  if (process == 0) _exit(0);
  waitpid(process, nullptr, 0);
  return process;
}

// What SIGKILL left of the same file goes; what somebody may still be writing, here or on another
// machine, does not, nor what is another file's or has another's name.
TEST(AtomicFile, TakesAwayWhatTheKilledLeftOfTheSameFile) {
  const test::TemporaryFolder folder;
  const std::string dead = std::to_string(DeadProcess());
  const auto leave = [&](const std::string& name) {
    std::ofstream(folder / name) << "half";
    return folder / name;
  };
  const auto left = leave("out.oni.partial-" + dead);
  std::vector<std::filesystem::path> kept = {leave("out.oni.partial-" + std::to_string(getppid())),
                                             leave("out.oni"),
                                             leave("other.oni.partial-" + dead),
                                             leave("out.oni2.partial-" + dead),
                                             leave("out.oni.partial-" + dead + "x"),
                                             leave("out.oni.partial-"),
                                             leave("out.oni.partial--1"),
                                             leave("out.oni.partial-99999999999999999999")};
  const auto locked = leave("out.oni.partial-" + std::to_string(DeadProcess()));
  const int lock = open(locked.c_str(), O_WRONLY);
  ASSERT_EQ(flock(lock, LOCK_EX | LOCK_NB), 0);
  kept.push_back(locked);
  std::filesystem::create_symlink("out.oni", folder / "link");
  AtomicFile::CheckWritable(folder / "link");
  EXPECT_FALSE(std::filesystem::exists(left));
  for (const auto& path : kept) EXPECT_TRUE(std::filesystem::exists(path)) << path;
  close(lock);
  AtomicFile::CheckWritable(folder / "link");
  EXPECT_FALSE(std::filesystem::exists(locked));
}

// Its number may be unknown here: what is being written is locked.
TEST(AtomicFile, IsLockedWhileItIsWritten) {
  const test::TemporaryFolder folder;
  std::optional<AtomicFile> file(folder / "out");
  const int other = open(file->temporary_path().c_str(), O_WRONLY);
  EXPECT_NE(flock(other, LOCK_EX | LOCK_NB), 0);
  file.reset();
  EXPECT_EQ(flock(other, LOCK_EX | LOCK_NB), 0);
  close(other);
}

TEST(AtomicFile, WhatIsCutOffIsGoneAndWritingGoesOnThere) {
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

TEST(AtomicFile, AFullDiskIsKnownBeforeTheEnd) {
  const test::TemporaryFolder folder;
  AtomicFile file(folder / "out");
  EXPECT_NO_THROW(file.Check());
  file.stream().setstate(std::ios::badbit);
  EXPECT_THROW(file.Check(), InputError);
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

// To open it would be to wait for who writes to it.
TEST(OpenFile, APipeIsNoFile) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_FALSE(OpenFile(folder / "pipe"));
  EXPECT_FALSE(OpenFile(folder / "nothing"));
  EXPECT_FALSE(OpenFile(folder.path()));
  std::ofstream(folder / "file") << "text";
  std::string text;
  OpenFile(folder / "file") >> text;
  EXPECT_EQ(text, "text");
}

}  // namespace
}  // namespace ossa
