#pragma once
#include <gtest/gtest.h>

#include <string>

#include "depth/base/error.h"

namespace ossa::test {

/// Expects `read` to throw an InputError whose text names what is wrong.
template <typename Read>
void ExpectRefused(const Read& read, const std::string& named) {
  try {
    read();
    ADD_FAILURE() << "taken, though " << named << " is wrong";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
  }
}

}  // namespace ossa::test
