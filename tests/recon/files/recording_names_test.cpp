// The recordings selected by SOURCE#MEMBER.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/recon/files/skeleton_examples.h"
#include "tests/recon/files/tar_bytes.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

std::string Walk(int frames) {
  const test::TemporaryFolder folder;
  WriteSkeletons(folder / "walk.jsonl", ExampleSequence(frames));
  std::ifstream file(folder / "walk.jsonl");
  return {std::istreambuf_iterator<char>(file), {}};
}

void WriteWalk(const std::filesystem::path& path, int frames) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << Walk(frames);
}

std::vector<std::string> NamesAt(const std::string& path) {
  std::vector<std::string> names;
  for (const SkeletonClip& clip : ReadSkeletonClips(path)) names.push_back(clip.name);
  return names;
}

size_t FramesAt(const std::string& path) { return ReadSkeletons(path).frames.size(); }

using Names = std::vector<std::string>;

TEST(RecordingNames, NameMayBePartOfAnother) {
  const test::TemporaryFolder folder;
  const std::string tar = folder / "sel.tar";
  WriteTar(tar, {{"1.jsonl", Walk(1)},
                 {"11.jsonl", Walk(11)},
                 {"set/1.jsonl", Walk(2)},
                 {"set/21.jsonl", Walk(21)}});
  EXPECT_EQ(FramesAt(tar + "#1"), 1u);
  EXPECT_EQ(FramesAt(tar + "#1.jsonl"), 1u);
  EXPECT_EQ(FramesAt(tar + "#11"), 11u);
  EXPECT_EQ(FramesAt(tar + "#21"), 21u) << "a whole name in a folder of the archive";
  EXPECT_EQ(NamesAt(tar + "#1.j"), (Names{"1", "11", "set/1", "set/21"})) << "a part of all";
}

TEST(RecordingNames, StopReadingAfterTheLastWanted) {
  const test::TemporaryFolder folder;
  WriteWalk(folder / "walks/walk.jsonl", 2);
  WriteTar(folder / "walks.tar", {{"walk.jsonl", Walk(2)}});
  SkeletonReadOptions options;
  options.stop = [] { return true; };
  for (const char* name : {"walks", "walks.tar"}) {
    EXPECT_TRUE(ReadSkeletonClips(folder / name, options).empty()) << name;
    EXPECT_TRUE(ReadSkeletons(folder / name, options).frames.empty()) << name;
  }
}

// `walks#walk` must not match the folder name itself.
TEST(RecordingNames, FoldersListTheirRecordings) {
  const test::TemporaryFolder folder;
  const std::string walks = folder / "walks";
  WriteWalk(walks + "/walk.jsonl", 2);
  WriteWalk(walks + "/run.jsonl", 3);
  WriteWalk(walks + "/slow/walk_2.jsonl", 4);
  EXPECT_EQ(FramesAt(walks + "#walk"), 2u);
  EXPECT_EQ(NamesAt(walks + "#slow"), Names{"slow/walk_2"});
  EXPECT_EQ(NamesAt(walks + "#alk"), (Names{"slow/walk_2", "walk"}));
  test::ExpectRefused([&] { ReadSkeletons(walks + "#walks"); }, "holds no skeleton recording");
}

TEST(RecordingNames, BeginWithTheArchivesNameInAFolder) {
  const test::TemporaryFolder folder;
  const std::string people = folder / "people";
  std::filesystem::create_directory(people);
  WriteTar(people + "/s01.tar", {{"s01/a.jsonl", Walk(1)}, {"s01/aa.jsonl", Walk(2)}});
  WriteTar(people + "/s010.tar", {{"a.jsonl", Walk(3)}});
  EXPECT_EQ(NamesAt(people), (Names{"s01/a", "s01/aa", "s010/a"}));
  for (const auto& clip : ReadSkeletonClips(people)) {
    EXPECT_EQ(NamesAt(people + "#" + clip.name), Names{clip.name}) << "as it was called";
  }
  EXPECT_EQ(NamesAt(people + "#s01"), (Names{"s01/a", "s01/aa"}));
  EXPECT_EQ(NamesAt(people + "#s010.tar"), Names{"s010/a"});
}

// Other files there may be large or damaged.
TEST(RecordingNames, OtherNamesDoNotOpenArchives) {
  const test::TemporaryFolder folder;
  WriteWalk(folder / "walks/walk.jsonl", 2);
  std::ofstream(folder / "walks/other.tgz") << "\x1F\x8B is no archive";
  EXPECT_EQ(FramesAt(folder / "walks#walk"), 2u);
  test::ExpectRefused([&] { ReadSkeletons(folder / "walks#run"); }, "expected a whole archive");
}

// A '#' in the path itself must not be taken for the separator.
TEST(RecordingNames, MayFollowAPathWithAHash) {
  const test::TemporaryFolder folder;
  const std::string odd = folder / "a#b";
  WriteWalk(odd + "/walk#1.jsonl", 2);
  WriteTar(odd + "/sel.tar", {{"11.jsonl", Walk(11)}, {"x#y.jsonl", Walk(4)}});
  EXPECT_EQ(FramesAt(odd + "/sel.tar#11"), 11u);
  EXPECT_EQ(FramesAt(odd + "/sel.tar#11#truth"), 11u);
  EXPECT_EQ(FramesAt(odd + "/sel.tar#truth#x#y"), 4u);
  EXPECT_EQ(FramesAt(odd + "/walk#1.jsonl"), 2u) << "a file as it stands";
  EXPECT_EQ(FramesAt(odd + "#walk#1"), 2u);
  EXPECT_EQ(FindSkeletonFile(odd + "/sel.tar#11#truth"), odd + "/sel.tar");
  test::ExpectRefused([&] { ReadSkeletons(odd + "/gone.tar#11"); },
                      odd + "/gone.tar#11: no such file or folder");
}

TEST(RecordingNames, SuggestionsAreUsableNames) {
  const test::TemporaryFolder folder;
  const std::string tar = folder / "sel.tar";
  WriteTar(tar, {{"1.jsonl", Walk(1)}, {"11.jsonl", Walk(11)}});
  test::ExpectRefused([&] { ReadSkeletons(tar + "#jsonl#truth"); },
                      "found 2: name one, as " + tar + "#truth#1");
}

// If Kinect and Vicon data are in separate folders, "all.tar#kinect" and "all.tar#vicon" select the
// same files, and their difference is 0.00 cm.
TEST(RecordingNames, SkeletonChoiceWarnsIfThereIsNone) {
  const test::TemporaryFolder folder;
  const std::string tar = folder / "all.tar";
  WriteTar(tar, {{"Kinect/1.jsonl", Walk(1)}, {"Vicon/1.jsonl", Walk(2)}});
  const auto clips = ReadSkeletonClips(tar + "#vicon");
  ASSERT_EQ(clips.size(), 2u);
  ASSERT_EQ(clips[0].sequence.warnings.size(), 1u);
  EXPECT_EQ(clips[0].sequence.warnings[0],
            tar + "#vicon: chooses nothing: no file there holds two skeletons side by side");
  EXPECT_TRUE(clips[1].sequence.warnings.empty());
  EXPECT_TRUE(ReadSkeletonClips(tar)[0].sequence.warnings.empty());
}

// Otherwise the results of one would overwrite those of the other.
TEST(RecordingNames, AreUniqueInAFolder) {
  const test::TemporaryFolder folder;
  const std::string walks = folder / "walks";
  WriteWalk(walks + "/s01/x.jsonl", 2);
  WriteTar(walks + "/s01.tar", {{"x.jsonl", Walk(3)}});
  EXPECT_EQ(NamesAt(walks), (Names{"s01/x", "s01/x_2"}));
}

TEST(RecordingNames, SingleFilesHaveNone) {
  const test::TemporaryFolder folder;
  const std::string walk = folder / "walk.jsonl";
  WriteWalk(walk, 2);
  EXPECT_EQ(FramesAt(walk + "#truth"), 2u);
  test::ExpectRefused([&] { ReadSkeletons(walk + "#tru"); },
                      "expected a folder or an archive before '#', or #truth or #observed after");
}

}  // namespace
}  // namespace ossa::recon
