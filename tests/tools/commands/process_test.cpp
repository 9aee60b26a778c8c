// Closed streams, full disks, signals and limits, for every command.
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>

#include "depth/base/folder_lock.h"
#include "tests/support/depth_examples.h"
#include "tests/support/run_command.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_folder.h"

namespace ossa::commands {
namespace {

using test::CommandResult;
using test::TemporaryFolder;

// `$1` in `script` stands for the command, `$2` for the folder.
CommandResult Shell(const std::string& script, const TemporaryFolder& folder) {
  return test::RunProgram(
      {"/bin/bash", "-c", script, "shell", test::OssaPath(), folder.path().string()});
}

std::string Bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Streams, ClosedStandardStreamsNeverReceiveOutputOfOtherFiles) {
  const TemporaryFolder folder;
  test::WriteExampleFolder(folder.path(), 5);
  const std::string track = R"("$1" track "$2" --method none --out "$2/)";
  ASSERT_EQ(Shell(track + "a.jsonl\"", folder).exit_status, 0);
  EXPECT_EQ(Shell(track + "b.jsonl\" 2>&-", folder).exit_status, 0);
  EXPECT_EQ(Shell(track + "c.jsonl\" <&- 2>&- >&-", folder).exit_status, 1)
      << "the summary could not be printed";
  EXPECT_EQ(Bytes(folder / "a.jsonl"), Bytes(folder / "b.jsonl"));
  EXPECT_EQ(Bytes(folder / "a.jsonl"), Bytes(folder / "c.jsonl"));
}

TEST(Streams, FailedPrintingIsAFailure) {
  const TemporaryFolder folder;
  for (const char* words : {"--help", "--version", "track --help"}) {
    const CommandResult result = Shell(std::string("\"$1\" ") + words + " > /dev/full", folder);
    EXPECT_EQ(result.exit_status, 1) << words;
    EXPECT_EQ(result.err, "ossa: standard output: cannot be written: No space left on device\n");
  }
}

TEST(Streams, ClosedPipeEndsTheCommandSilently) {
  const TemporaryFolder folder;
  const CommandResult result =
      Shell("(\"$1\" experiment --help; echo $? >&2) | sleep 0; true", folder);
  // The reader may be gone after the text has fitted into the pipe.
  EXPECT_TRUE(result.err == "141\n" || result.err == "0\n") << result.err;
}

TEST(Streams, FullErrorStreamDoesNotStopTheCommand) {
  const TemporaryFolder folder;
  test::WriteExampleFolder(folder.path(), 3);
  EXPECT_EQ(Shell(R"("$1" record "$2" --out "$2/x.oni" 2> /dev/full)", folder).exit_status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "x.oni"));
}

TEST(Files, FileSizeLimitIsReportedInOneLineAndNothingIsLeft) {
  const TemporaryFolder folder;
  test::WriteExampleFolder(folder.path(), 40);
  const CommandResult result =
      Shell(R"(ulimit -f 1; exec "$1" record "$2" --out "$2/x.oni" --quiet)", folder);
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(result.err,
            "ossa: " + (folder / "x.oni").string() + ": writing failed: is the disk full?\n");
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    EXPECT_EQ(entry.path().extension(), ".png") << entry.path();
  }
}

TEST(Memory, ExhaustionIsReportedInOneLine) {
  if (test::kSanitized) GTEST_SKIP() << "the shadow of its memory alone takes more";
  const TemporaryFolder folder;
  const CommandResult result =
      Shell(R"(ulimit -v 400000; exec "$1" database --mocap authored --out "$2/x.ossadb" --quiet)",
            folder);
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(result.err, "ossa: out of memory\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "x.ossadb"));
}

TEST(Memory, ExhaustionByAFileNamesTheFile) {
  if (test::kSanitized) GTEST_SKIP() << "the shadow of its memory alone takes more";
  const TemporaryFolder folder;
  const CommandResult result =
      Shell(R"(yes '{"frame":0,"time_s":0,"bodies":[]}' | head -c 500000000 | gzip -1 > "$2/x.gz"
         ulimit -v 400000; exec "$1" reconstruct "$2/x.gz" --out "$2/y.jsonl" --quiet)",
            folder);
  EXPECT_EQ(result.exit_status, 1);
  const std::string file = (folder / "x.gz").string();
  EXPECT_EQ(result.err, "ossa: " + file + ": out of memory: expected a file that fits into it\n");
}

TEST(Memory, ExhaustionByMotionNamesTheFile) {
  if (test::kSanitized) GTEST_SKIP() << "the shadow of its memory alone takes more";
  const TemporaryFolder folder;
  const CommandResult result = Shell(R"(echo HIERARCHY > "$2/x.bvh"; truncate -s 1G "$2/x.bvh"
         ulimit -v 400000; exec "$1" database --mocap "$2/x.bvh" --out "$2/y.ossadb" --quiet)",
                                     folder);
  EXPECT_EQ(result.exit_status, 1);
  const std::string file = (folder / "x.bvh").string();
  EXPECT_EQ(result.err, "ossa: " + file + ": out of memory: expected a file that fits into it\n");
}

// The first signal sets a flag, which a command checks between steps; one right after it, as
// timeout(1) sends, counts as the same; the next one ends the process.
TEST(Interrupt, SecondOneEndsACommandThatDoesNotReactToTheFirst) {
  const TemporaryFolder folder;
  const CommandResult deaf = Shell(
      R"("$1" database --mocap authored --mocap authored --mocap authored --out "$2/x" --quiet &
         sleep 0.3; kill -INT $!; kill -INT $!; sleep 0.8; kill -INT $!; wait $!; echo $?)",
      folder);
  // On a fast machine the command has reacted to the first one.
  EXPECT_TRUE(deaf.out == "130\n" || deaf.out == "1\n") << deaf.out << deaf.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "x"));
}

TEST(Interrupt, ClosedTerminalEndsARecordingWithACompleteFile) {
  const TemporaryFolder folder;
  test::WriteExampleFolder(folder.path(), 10);
  const std::string out = (folder / "x.oni").string();
  auto running = test::StartOssa({"record", "openni:ossa://" + folder.path().string() + "?loop=1",
                                  "--out", out, "--seconds", "1000"});
  ASSERT_TRUE(running.WaitForError("recording", test::kCommandTimeout));
  running.Signal(SIGHUP);
  EXPECT_EQ(running.Wait(test::kCommandTimeout).exit_status, 0);
  EXPECT_TRUE(std::filesystem::exists(out));
}

// Outputs whose format is fixed by the option may have any name: these commands fail on their
// inputs only.
TEST(OutputName, IsFreeForOutputsOfOneFormat) {
  const TemporaryFolder folder;
  for (const char* words :
       {"learn --observed a --truth b --out x", "prior --mocap a --out x.bin", "refine a --out x",
        "train a --out x", "database --mocap a --out x.bin", "evaluate a b --json x.txt",
        "evaluate a b --json -", "compare a b --json x.txt", "compare a b --json -",
        "track /nowhere --json-stats x.txt", "track /nowhere --json-stats -"}) {
    const CommandResult result = Shell(std::string("cd \"$2\" && \"$1\" ") + words, folder);
    EXPECT_EQ(result.exit_status, 1) << words << ": " << result.err;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// Wrong usage exits with 2 before any file is opened or written.
TEST(WrongUsage, OfOutputsExitsWithTwo) {
  const TemporaryFolder folder;
  std::ofstream(folder / "in.jsonl") << "precious";
  std::filesystem::create_symlink("in.jsonl", folder / "same");
  for (const char* words : {"track /nowhere --out x.xyz",
                            "track /nowhere --out x",
                            "track /nowhere --picture x.jpg",
                            "track /nowhere --out in.jsonl --json-stats ./same",
                            "reconstruct in.jsonl --out in.jsonl",
                            "reconstruct in.jsonl#truth --out ./in.jsonl",
                            "compare in.json a --json in.json",
                            "compare a b --report x",
                            "compare a b --json x.csv",
                            "learn --observed a --truth in.ossagp --out in.ossagp",
                            "database --mocap in.ossadb --out in.ossadb",
                            "prior --mocap in.ossaprior --out in.ossaprior",
                            "record in.oni --out in.oni",
                            "evaluate a b --report x",
                            "evaluate a b --json x.html",
                            "learn --observed a --truth b --out x.ossa",
                            "prior --mocap authored --out x.ossadb",
                            "database --mocap authored --out x.ossa",
                            "train a --out x.jsonl",
                            "train a --out x.ossarefine",
                            "track /nowhere --out x.jsonl --json-stats x.html"}) {
    const CommandResult result = Shell(std::string("cd \"$2\" && \"$1\" ") + words, folder);
    EXPECT_EQ(result.exit_status, 2) << words << ": " << result.err;
    EXPECT_EQ(test::LineCount(result.err), 1) << result.err;
  }
  EXPECT_EQ(Bytes(folder / "in.jsonl"), "precious");
}

TEST(WrongUsage, OfOptionsExitsWithTwo) {
  const TemporaryFolder folder;
  for (const char* words :
       {"learn --observed a --truth b --out x.ossagp --regions 1000000000",
        "learn --observed a --truth b --out x.ossagp --regions 1e8",
        "learn --observed a --truth b --out x.ossagp --samples 5001",
        "learn --observed a --truth b --out x.ossagp --pairs 9",
        "track a --out x.jsonl --method liu-2016", "reconstruct a --out x.jsonl --method liu-2016",
        "compare a b --time nan", "compare a b --format x", "compare a b --columns x",
        "experiment nosuch --out x",
        "reconstruct a --out x.csv --method shum-2013 --weights 1,1,1,-1",
        "train a --out x --memory 1K", "train a --out x --resume --trees-of b",
        "train a --out x --trees-of b --import-pcl c"}) {
    const CommandResult result = Shell(std::string("cd \"$2\" && \"$1\" ") + words, folder);
    EXPECT_EQ(result.exit_status, 2) << words << ": " << result.err;
    EXPECT_EQ(test::LineCount(result.err), 1) << result.err;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(RenderCommand, RefusesAFolderThatAnotherProcessWrites) {
  const TemporaryFolder folder;
  const FolderLock other(folder / "set");
  const CommandResult result =
      test::RunOssa({"render", "--mocap", "authored", "--frames", "2", "--size", "64x48", "--out",
                     (folder / "set").string()});
  if (result.err.find("MPFB body") != std::string::npos) GTEST_SKIP() << result.err;
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_NE(result.err.find("another ossa is writing here"), std::string::npos) << result.err;
  EXPECT_TRUE(std::filesystem::is_empty(folder / "set"));
}

}  // namespace
}  // namespace ossa::commands
