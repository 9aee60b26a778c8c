// Folders of PNGs: which files are frames, in which order, and what is said of the others.
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "depth/base/error.h"
#include "depth/image/depth_png.h"
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

TEST(FolderSource, ReturnsFramesInNameOrderAt30HzThenEnds) {
  const TemporaryFolder folder;
  for (const char* name : {"b.png", "a.png", "c.png"}) {
    WriteFrame(folder / name, static_cast<uint16_t>(name[0]));
  }
  const auto source = OpenSource(folder.path().string());
  EXPECT_EQ(source->frame_count(), 3);
  EXPECT_FALSE(source->is_live());
  for (int i = 0; i < 3; ++i) {
    const ReadResult result = Next(*source);
    ASSERT_EQ(result.status, ReadStatus::kFrame);
    EXPECT_EQ(result.frame.depth_mm[0], 'a' + i);
    EXPECT_EQ(result.frame.index, i);
    EXPECT_DOUBLE_EQ(result.frame.time_s, i / 30.0);
    EXPECT_EQ(result.dropped, 0);
  }
  EXPECT_EQ(Next(*source).status, ReadStatus::kEnd);
  EXPECT_EQ(Next(*source).status, ReadStatus::kEnd);
}

TEST(FolderSource, CountsMissingNumbersAsDroppedFrames) {
  const TemporaryFolder folder;
  for (const char* name : {"000003.png", "000004.png", "000007.png"}) WriteFrame(folder / name, 1);
  const auto source = OpenSource(folder.path().string());
  EXPECT_EQ(Next(*source).frame.index, 3);
  EXPECT_EQ(Next(*source).dropped, 0);
  const ReadResult third = Next(*source);
  EXPECT_EQ(third.dropped, 2);
  EXPECT_EQ(third.frame.index, 7);
  EXPECT_DOUBLE_EQ(third.frame.time_s, 4 / 30.0);
}

// A PGM whose pixels all have one value.
void WritePgm(const std::filesystem::path& path, uint16_t value) {
  std::ofstream file(path, std::ios::binary);
  file << "P5 8 6 65535\n";
  for (int i = 0; i < 8 * 6; ++i) {
    file << static_cast<char>(value >> 8) << static_cast<char>(value & 255);
  }
}

TEST(FolderSource, ReadsImagesOfOtherFormats) {
  const TemporaryFolder folder;
  for (const int i : {9, 10, 11}) {
    WritePgm(folder / ("depth_" + std::to_string(i) + ".pgm"), static_cast<uint16_t>(1000 + i));
  }
  const auto source = OpenSource(folder.path().string());
  EXPECT_EQ(ValuesOf(*source), (std::vector<uint16_t>{1009, 1010, 1011}));
  EXPECT_EQ(ValuesOf(*OpenSource(folder / "depth_10.pgm")), (std::vector<uint16_t>{1010}));
}

TEST(FolderSource, ReadsTheCommonestOfSeveralFormatsOrPngs) {
  const TemporaryFolder folder;
  for (const int i : {0, 1, 2}) WritePgm(folder / (std::to_string(i) + ".pgm"), 1000);
  for (const int i : {0, 1, 2}) WriteFrame(folder / (std::to_string(i) + ".png"), 2000);
  Notes notes;
  EXPECT_EQ(ValuesOf(*OpenSource(folder.path(), notes.Options())),
            (std::vector<uint16_t>{2000, 2000, 2000}));
  EXPECT_TRUE(notes.Tell("images in another format are ignored, such as 0.pgm"));
  WritePgm(folder / "3.pgm", 1000);
  EXPECT_EQ(ValuesOf(*OpenSource(folder.path())), (std::vector<uint16_t>(4, 1000)));
}

TEST(FolderSource, MaximumValueIsNoReading) {
  const TemporaryFolder folder;
  for (const auto& [name, value] : {std::pair("0.png", 65535), {"1.png", 65534}, {"2.png", 9}}) {
    WriteFrame(folder / name, static_cast<uint16_t>(value));
  }
  const auto source = OpenSource(folder.path().string());
  EXPECT_EQ(ValuesOf(*source), (std::vector<uint16_t>{0, 65534, 9}));
}

TEST(FolderSource, ReturnsFramesInNaturalOrder) {
  const TemporaryFolder folder;
  for (const int number : {1, 2, 10, 9, 100}) {
    WriteFrame(folder / ("img_" + std::to_string(number) + ".png"), static_cast<uint16_t>(number));
  }
  const auto source = OpenSource(folder.path().string());
  EXPECT_EQ(ValuesOf(*source), (std::vector<uint16_t>{1, 2, 9, 10, 100}));
}

TEST(FolderSource, SkipsAndCountsUnreadableFramesWithAWarning) {
  const TemporaryFolder folder;
  std::ofstream(folder / "0.png") << "not a PNG";
  WriteFrame(folder / "1.png", 2);
  std::ofstream(folder / "2.png") << "";
  WriteFrame(folder / "3.png", 4);
  std::ofstream(folder / "4.png") << "cut";
  Notes notes;
  const auto source = OpenSource(folder.path().string(), notes.Options());
  const ReadResult first = Next(*source), second = Next(*source);
  EXPECT_EQ(first.frame.depth_mm[0], 2);
  EXPECT_EQ(first.dropped, 1);
  EXPECT_EQ(second.frame.depth_mm[0], 4);
  EXPECT_EQ(second.dropped, 1);
  const ReadResult end = Next(*source);
  EXPECT_EQ(end.status, ReadStatus::kEnd);
  EXPECT_EQ(end.dropped, 1);
  EXPECT_EQ(Next(*source).dropped, 0) << "told once";
  EXPECT_TRUE(notes.Tell("skipped 3 of 5 frames")) << notes.text;
  EXPECT_TRUE(notes.Tell("0.png: byte 0")) << notes.text;
}

TEST(FolderSource, RefusesTheFirstFrameIfNoneIsReadable) {
  const TemporaryFolder folder;
  std::ofstream(folder / "0.png") << "not a PNG";
  EXPECT_THROW(OpenSource(folder.path().string()), InputError);
}

TEST(FolderSource, SkipsFramesOfAnotherSizeEvenTheFirst) {
  const TemporaryFolder folder;
  WriteFrame(folder / "0.png", 1, 16, 12);
  for (const char* name : {"1.png", "2.png"}) WriteFrame(folder / name, 1);
  Notes notes;
  const auto source = OpenSource(folder.path().string(), notes.Options());
  EXPECT_EQ(source->camera().width, 8);
  EXPECT_EQ(ValuesOf(*source).size(), 2u);
  EXPECT_TRUE(notes.Tell("0.png: expected 8x6 like the other frames, found 16x12")) << notes.text;
}

TEST(FolderSource, SkipsOtherFilesWithANote) {
  const TemporaryFolder folder;
  for (const char* name : {"depth_0.png", "depth_1.png", "ir_0.png"}) WriteFrame(folder / name, 1);
  std::ofstream(folder / "._depth_0.png") << "Mac";
  std::ofstream(folder / "notes.txt") << "text";
  const Image<uint8_t> grey(8, 6, 0);
  WriteLabelPng(folder / "depth_shown.png", grey);
  Notes notes;
  const auto source = OpenSource(folder.path().string(), notes.Options());
  EXPECT_EQ(source->frame_count(), 2);
  EXPECT_TRUE(notes.Tell("4 files are not depth images")) << notes.text;
}

TEST(FolderSource, WarnsOfTwoSequencesInOneFolder) {
  const TemporaryFolder folder;
  for (const char* name : {"depth_0.png", "depth_1.png", "depth_raw_0.png"}) {
    WriteFrame(folder / name, 1);
  }
  Notes notes;
  OpenSource(folder.path().string(), notes.Options());
  EXPECT_FALSE(notes.Tell("kinds")) << notes.text;
  WriteFrame(folder / "depth_raw_1.png", 1);
  OpenSource(folder.path().string(), notes.Options());
  EXPECT_TRUE(notes.Tell("depth images of 2 kinds by their names ('depth_', 'depth_raw_')"))
      << notes.text;
}

TEST(FolderSource, RefusesImagesWithoutDepthByTheirKind) {
  const TemporaryFolder folder;
  WriteLabelPng(folder / "0.png", Image<uint8_t>(8, 6, 0));
  test::ExpectRefused([&] { OpenSource(folder.path().string()); },
                      "expected one channel of 16 bits, found grey of 8 bits");
}

TEST(FolderSource, NamesTheDepthSubfolderOfAGivenParent) {
  const TemporaryFolder folder;
  const std::string name = folder.path().string();
  test::ExpectRefused([&] { OpenSource(name); }, "found none in it");
  for (const char* below : {"aligned", "depth"}) std::filesystem::create_directory(folder / below);
  WriteFrame(folder / "aligned/0.png", 1);
  WriteFrame(folder / "depth/0.png", 1);
  test::ExpectRefused([&] { OpenSource(name); }, "found none in it, but in " + name + "/depth");
}

TEST(FolderSource, AcceptsFileNamesInCapitals) {
  const TemporaryFolder folder;
  EXPECT_FALSE(IsRecording(folder.path()));
  WriteFrame(folder / "000007.PNG", 70);
  EXPECT_TRUE(IsRecording(folder.path()));
  WriteFrame(folder / "000009.png", 90);
  const auto source = OpenSource(folder.path().string());
  EXPECT_EQ(source->frame_count(), 2);
  EXPECT_EQ(Next(*source).frame.index, 7);
  EXPECT_EQ(Next(*source).dropped, 1);
  WriteFrame(folder / "000007.png", 71);  // beside the one in capitals: names count no frames
  const auto counted = OpenSource(folder.path().string());
  for (int i = 0; i < 3; ++i) {
    const ReadResult next = Next(*counted);
    EXPECT_EQ(next.frame.index, i);
    EXPECT_EQ(next.dropped, 0);
  }
}

}  // namespace
}  // namespace ossa::depth
