#include "depth/sensor/drivers/virtual_uri.h"

#include <gtest/gtest.h>

#include "depth/base/error.h"

namespace ossa::depth {
namespace {

TEST(VirtualUri, HasAPathAndOptions) {
  const auto options = ParseVirtualUri(
      "ossa:///data/a%3Fb%25c?loop=1&speed=2.5&fps=15&mirror=1&mirrored=1&unplug_after=30"
      "&replug_after_ms=200&unplugs=3&stall_after=99&restart_clock_after=98");
  EXPECT_EQ(options.path, "/data/a?b%c");
  EXPECT_TRUE(options.loop);
  EXPECT_TRUE(options.mirror);
  EXPECT_TRUE(options.mirrored);
  EXPECT_EQ(options.speed, 2.5);
  EXPECT_EQ(options.fps, 15);
  EXPECT_EQ(options.unplug_after, 30);
  EXPECT_EQ(options.replug_after, std::chrono::milliseconds(200));
  EXPECT_EQ(options.unplugs, 3);
  EXPECT_EQ(options.stall_after, 99);
  EXPECT_EQ(options.restart_clock_after, 98);
  EXPECT_FALSE(ParseVirtualUri("ossa://relative/path").loop);
  EXPECT_FALSE(ParseVirtualUri("ossa://x?mirror=1").mirrored);
}

TEST(VirtualUri, RefusesUnknownOptionsByName) {
  for (const char* uri :
       {"", "ossa://", "ossa://?loop=1", "/path", "ossa://x?lop=1", "ossa://x?loop",
        "ossa://x?fps=0", "ossa://x?speed=-1", "ossa://x?speed=nan", "ossa://x?fps=3x",
        "ossa://x?unplug_after=", "ossa://x?loop=1&&", "ossa://x%2", "ossa://x%zz", "ossa://x%00",
        "ossa://x?fps=1e99"}) {
    try {
      ParseVirtualUri(uri);
      ADD_FAILURE() << uri;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).rfind(std::string(uri) + ": ", 0), 0u) << error.what();
    }
  }
}

}  // namespace
}  // namespace ossa::depth
