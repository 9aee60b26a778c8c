#include "depth/base/error.h"

#include <gtest/gtest.h>

#include "depth/base/one_line.h"

namespace ossa {
namespace {

// Names quoted from a damaged model may contain line breaks (found by fuzzing).
TEST(InputErrors, StayOneLineForAnyQuotedText) {
  EXPECT_STREQ(InputError("a.ossa: target 'He\nad\x1B'").what(), "a.ossa: target 'He\\x0Aad\\x1B'");
}

TEST(InputErrors, KeepNonAsciiLetters) {
  EXPECT_STREQ(InputError("J\xC3\xBCrgen.ossa: empty").what(), "J\xC3\xBCrgen.ossa: empty");
}

TEST(InputErrors, EscapeInvalidBytes) {
  const std::string cut = "\xC3", second_only = "\x80", too_long = "\xC0\xAF",
                    surrogate = "\xED\xA0\x80", too_large = "\xF4\x90\x80\x80",
                    control = "\xC2\x9B";
  EXPECT_EQ(OnOneLine(cut), "\\xC3");
  EXPECT_EQ(OnOneLine(cut + "x"), "\\xC3x");
  EXPECT_EQ(OnOneLine(second_only), "\\x80");
  EXPECT_EQ(OnOneLine(too_long), "\\xC0\\xAF");
  EXPECT_EQ(OnOneLine(surrogate), "\\xED\\xA0\\x80");
  EXPECT_EQ(OnOneLine(too_large), "\\xF4\\x90\\x80\\x80");
  EXPECT_EQ(OnOneLine(control), "\\xC2\\x9B");
}

TEST(InputErrors, KeepCharactersOfEveryLength) {
  const std::string text =
      "a\xC2\xA0\xE2\x82\xAC\xF0\x9F\xA6\xB4";  // a, no-break space, euro, bone
  EXPECT_EQ(OnOneLine(text), text);
}

}  // namespace
}  // namespace ossa
