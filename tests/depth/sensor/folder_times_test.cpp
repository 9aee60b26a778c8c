// The times of the frames of a folder: from names, from depth.txt, or by option.
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "depth/sensor/frame_source.h"
#include "tests/depth/sensor/folder_frames.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using test::Next;
using test::Notes;
using test::TemporaryFolder;
using test::ValuesOf;
using test::WriteFrame;

std::vector<double> TimesOf(FrameSource& source) {
  std::vector<double> times_s;
  for (ReadResult result; (result = Next(source)).status == ReadStatus::kFrame;) {
    times_s.push_back(result.frame.time_s);
  }
  return times_s;
}

TEST(FolderSource, ReadsTimesFromNames) {
  const TemporaryFolder folder;
  for (const char* name :
       {"1305031102.175304.png", "1305031102.275304.png", "1305031104.275304.png"})
    WriteFrame(folder / name, 1);
  const auto times_s = TimesOf(*OpenSource(folder.path().string()));
  ASSERT_EQ(times_s.size(), 3u);
  EXPECT_NEAR(times_s[1], 0.1, 1e-6);
  EXPECT_NEAR(times_s[2], 2.1, 1e-6);
}

// They may also be every thirtieth frame: the interpretation must be reported.
TEST(FolderSource, NotesNumbersThatAreReadAsTimes) {
  const TemporaryFolder folder;
  for (const char* name : {"0.png", "30.png", "60.png"}) WriteFrame(folder / name, 1);
  Notes notes;
  EXPECT_NEAR(TimesOf(*OpenSource(folder.path().string(), notes.Options()))[2], 0.06, 1e-9);
  EXPECT_TRUE(notes.Tell("numbers in its names")) << notes.text;
  EXPECT_TRUE(notes.Tell("are read as milliseconds")) << notes.text;
}

// As printed by many programs.
TEST(FolderSource, SortsTimesWithoutTrailingZeros) {
  const TemporaryFolder folder;
  for (const char* name : {"7.0.png", "7.033.png", "7.067.png", "7.1.png"}) {
    WriteFrame(folder / name, 1);
  }
  const auto source = OpenSource(folder.path().string());
  for (int i = 0; i < 4; ++i) {
    const ReadResult next = Next(*source);
    EXPECT_NEAR(next.frame.time_s, i / 30.0, 1e-3);
    EXPECT_EQ(next.frame.index, i);
    EXPECT_EQ(next.dropped, 0);
  }
}

TEST(FolderSource, ReadsTimesFromDepthTxt) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "depth");
  for (const char* name : {"b.png", "a.png", "c.png"}) {
    WriteFrame(folder / (std::string("depth/") + name), static_cast<uint16_t>(name[0]));
  }
  std::ofstream(folder / "depth.txt") << "# time file\n5.0 depth/b.png\n5.1 depth/a.png\n";
  for (const std::string& source : {folder.path().string(), (folder / "depth").string()}) {
    EXPECT_TRUE(IsRecording(source));
    EXPECT_EQ(ValuesOf(*OpenSource(source)), (std::vector<uint16_t>{'b', 'a'})) << source;
    EXPECT_NEAR(TimesOf(*OpenSource(source))[1], 0.1, 1e-9);
  }
}

TEST(FolderSource, DepthTxtMayNameFilesAsWindowsDoesAndWithBlanks) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "depth");
  for (const char* name : {"depth/take 1.png", "depth/take 2.png"}) WriteFrame(folder / name, 7);
  const std::string source = folder.path().string();
  for (const char* list : {"5.0 depth/take 1.png\n5.2 depth/take 2.png\n",
                           "5.0,\"depth\\take 1.png\"\r\n5.2,\"depth\\take 2.png\"\r\n"}) {
    std::ofstream(folder / "depth.txt") << list;
    EXPECT_NEAR(TimesOf(*OpenSource(source)).at(1), 0.2, 1e-9) << list;
  }
  std::ofstream(folder / "depth.txt") << "\xFF\xFE"
                                      << "5";
  test::ExpectRefused([&] { OpenSource(source); }, "found UTF-16: save it as UTF-8");
}

// As from a program that dumps a matrix.
TEST(FolderSource, IgnoresAForeignDepthTxtWithANote) {
  const TemporaryFolder folder;
  std::ofstream(folder / "depth.txt") << "# rows\n1203 1204 1207\n1203 1204 1208\n";
  test::ExpectRefused([&] { OpenSource(folder.path().string()); },
                      "depth.txt: expected seconds and files that are there, found line 2: '1204'");
  for (const char* name : {"0.png", "1.png"}) WriteFrame(folder / name, 7);
  Notes notes;
  EXPECT_EQ(ValuesOf(*OpenSource(folder.path().string(), notes.Options())).size(), 2u);
  EXPECT_TRUE(notes.Tell("found line 2: '1204' and the like: ignored")) << notes.text;
}

TEST(FolderSource, FindsListedFramesForAnySpellingOfTheFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "depth");
  WriteFrame(folder / "depth/a.png", 1);
  std::ofstream(folder / "depth.txt") << "5.0 depth/a.png\n";
  Notes notes;
  OpenSource((folder / "depth/../depth").string(), notes.Options());
  EXPECT_FALSE(notes.Tell("ignored")) << notes.text;
}

TEST(FolderSource, FpsOptionOverridesTimesInNames) {
  const TemporaryFolder folder;
  for (const char* name : {"0.000.png", "0.033.png"}) WriteFrame(folder / name, 1);
  EXPECT_DOUBLE_EQ(TimesOf(*OpenSource(folder.path().string(), {.fps = 10.0}))[1], 0.1);
}

TEST(FolderSource, DoesNotCountTimestampsAsFrameNumbers) {
  const TemporaryFolder folder;
  for (const char* name : {"d-1028.png", "d-1038.png"}) WriteFrame(folder / name, 1);
  const auto source = OpenSource(folder.path().string());
  Next(*source);
  EXPECT_EQ(Next(*source).dropped, 0);
}

}  // namespace
}  // namespace ossa::depth
