#include "depth/base/toml_shape.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "depth/base/error.h"

namespace ossa {
namespace {

class PlainToml {
 public:
  PlainToml(std::string_view text, std::string source, TomlTables tables)
      : text_(text), source_(std::move(source)), tables_(tables == TomlTables::kAllowed) {}

  void Check() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;  // a byte-order mark
    for (SkipLines(); at_ < text_.size(); SkipLines()) {
      if (tables_ && Next() == '[') {
        Header();
      } else {
        Assignment();
      }
      SkipBlanks();
      SkipComment();
      if (at_ < text_.size() && Next() != '\n') Refuse("the end of the line after a value");
    }
  }

 private:
  char Next() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool Take(char c) {
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    line_ += c == '\n' ? 1 : 0;
    return true;
  }
  void SkipBlanks() {
    while (Take(' ') || Take('\t') || (text_.substr(at_, 2) == "\r\n" && Take('\r'))) continue;
  }
  void SkipComment() {
    if (Next() == '#') at_ = std::min(text_.find('\n', at_), text_.size());
  }
  void SkipLines() {
    do {
      SkipBlanks();
      SkipComment();
    } while (Take('\n'));
  }

  void Header() {
    const bool is_list = text_.substr(at_, 2) == "[[";
    for (int k = 0; k < (is_list ? 2 : 1); ++k) Take('[');
    do {
      Word("the name of a table", "_-");
    } while (Take('.'));
    for (int k = 0; k < (is_list ? 2 : 1); ++k) {
      if (!Take(']')) Refuse(is_list ? "[[name]]" : "[name]");
    }
  }

  void Assignment() {
    Word("a name", "_-");
    SkipBlanks();
    if (!Take('=')) Refuse(tables_ ? "name = value" : "name = value, no tables");
    SkipBlanks();
    if (Take('[')) {
      List();
    } else {
      Item();
    }
  }

  void List() {
    for (SkipLines(); !Take(']'); SkipLines()) {
      Item();
      SkipLines();
      if (!Take(',') && Next() != ']')
        Refuse("a comma or the end of a list, no lists within lists");
    }
  }

  void Item() {
    for (const char quote : {'"', '\''}) {
      if (!Take(quote)) continue;
      while (at_ < text_.size() && Next() != quote && Next() != '\n') {
        const bool escapes = quote == '"' && Next() == '\\' && text_.substr(at_ + 1, 1) != "\n";
        at_ += escapes ? 2U : 1U;
      }
      if (at_ >= text_.size() || !Take(quote) || Next() == quote)
        Refuse("texts of one line, in one quote");
      return;
    }
    Word("a number, a text or a list of them, no tables", "_-+.");
  }

  void Word(const std::string& what, std::string_view signs) {
    const size_t begin = at_;
    while (std::isalnum(static_cast<unsigned char>(Next())) != 0 ||
           (at_ < text_.size() && signs.find(Next()) != std::string_view::npos)) {
      ++at_;
    }
    if (static_cast<unsigned char>(Next()) >= 0x80) Refuse("letters beyond ASCII only in quotes");
    if (at_ == begin) Refuse(what);
  }

  [[noreturn]] void Refuse(const std::string& expected) const {
    throw InputError(source_ + ": line " + std::to_string(line_) + ": expected " + expected);
  }

  std::string_view text_;
  std::string source_;
  bool tables_;
  size_t at_ = 0;
  int line_ = 1;
};

}  // namespace

void CheckTomlShape(std::string_view text, const std::string& source, TomlTables tables) {
  PlainToml(text, source, tables).Check();
}

}  // namespace ossa
