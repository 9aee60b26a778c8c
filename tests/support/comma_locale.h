#pragma once
#include <clocale>
#include <cstdlib>
#include <locale>
#include <string>

#include "tests/support/temporary_folder.h"

namespace ossa::test {

/// As long as it lives, C's and C++'s functions write and read numbers with a comma, as in a
/// program that follows the settings of a German user. The locale is made here: few machines have
/// it. Not while other threads run.
class CommaLocale {
 public:
  CommaLocale() {
    const std::string make =
        "localedef -i de_DE -f UTF-8 --no-archive '" + (folder_ / kName).string() + "' 2>/dev/null";
    is_there_ = std::system(make.c_str()) == 0 &&
                setenv("LOCPATH", folder_.path().c_str(), 1) == 0 &&
                std::setlocale(LC_ALL, kName) != nullptr;
    if (is_there_) std::locale::global(std::locale(kName));
  }
  ~CommaLocale() {
    std::locale::global(std::locale::classic());
    unsetenv("LOCPATH");
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

  /// False on a machine that cannot make it.
  bool is_there() const { return is_there_; }

 private:
  static constexpr const char* kName = "de_DE.UTF-8";
  TemporaryFolder folder_;
  bool is_there_ = false;
};

}  // namespace ossa::test
