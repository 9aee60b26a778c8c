#include "depth/error.h"

#include <gtest/gtest.h>

namespace ossa {
namespace {

// Names quoted from a damaged model once broke the line in two (found by fuzzing).
TEST(InputErrors, StayOneLineWhateverTheyQuote) {
  EXPECT_STREQ(InputError("a.ossa: target 'He\nad\x1B'").what(), "a.ossa: target 'He\\x0Aad\\x1B'");
}

TEST(InputErrors, KeepLettersBeyondAscii) {
  EXPECT_STREQ(InputError("J\xC3\xBCrgen.ossa: empty").what(), "J\xC3\xBCrgen.ossa: empty");
}

}  // namespace
}  // namespace ossa
