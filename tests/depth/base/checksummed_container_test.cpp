#include "depth/base/checksummed_container.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "depth/base/error.h"
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

TEST(ChecksummedContainer, RoundTripIsExact) {
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

TEST_P(DamagedContainer, IsRefusedWithTheFieldsName) {
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

// A sparse file of a terabyte.
TEST(ChecksummedContainer, OtherFileIsRefusedByItsHeaderBeforeAllocating) {
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

TEST(ChecksummedContainer, MissingFileIsReportedAsMissing) {
  const test::TemporaryFolder folder;
  test::ExpectRefused([&] { ReadContainer(folder / "none", kFormat); },
                      "none: no such file: expected a test file");
  test::ExpectRefused([&] { ReadContainer(folder.path(), kFormat); },
                      ": cannot be read: expected a test file");
}

TEST(ChecksummedContainer, ShorterThanItsHeaderIsRefused) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "short") << "ossatest";
  test::ExpectRefused([&] { ReadContainer(folder / "short", kFormat); }, "found 8 bytes");
}

TEST(ChecksummedContainer, ChecksumIsIndependentOfTheName) {
  const test::TemporaryFolder folder;
  const auto written = [&](const char* name, std::byte first) {
    WriteContainer(folder / name, kFormat, std::vector<std::byte>{first, std::byte{7}});
    return ReadContainerChecksum(folder / name);
  };
  EXPECT_EQ(written("a", std::byte{1}), written("b", std::byte{1}));
  EXPECT_NE(written("a", std::byte{1}), written("b", std::byte{2}));
  std::ofstream(folder / "short") << "OSSA";
  EXPECT_THROW(ReadContainerChecksum(folder / "short"), InputError);
}

TEST(ChecksummedContainer, CountBeyondTheFileIsRefusedBeforeAllocating) {
  PayloadWriter writer;
  writer.Put<uint64_t>(uint64_t{1} << 60);
  PayloadReader reader(writer.bytes(), "x");
  EXPECT_THROW(reader.GetVector<double>("values"), InputError);
}

// Opening it would wait for a writer.
TEST(OpenFile, PipeIsRefused) {
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
