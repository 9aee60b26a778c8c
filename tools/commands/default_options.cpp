#include "tools/commands/default_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>

#include "depth/base/error.h"
#include "depth/base/one_line.h"
#include "tools/commands/closest_word.h"
#include "tools/commands/examples.h"

namespace ossa::commands {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBlank = " \t\r";

std::string_view Trim(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
  return text.substr(0, text.find_last_not_of(kBlank) + 1);
}

bool IsName(std::string_view text) {
  const auto belongs = [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; };
  return !text.empty() && std::all_of(text.begin(), text.end(), belongs);
}

// Parses one line of the file from left to right.
class LineReader {
 public:
  LineReader(std::string_view text, std::string place) : rest_(text), place_(std::move(place)) {}

  [[noreturn]] void Expect(const std::string& what) const {
    throw InputError(fmt::format("{}: expected {}, found '{}'", place_, what, OnOneLine(rest_)));
  }
  bool AtEnd() {
    rest_ = Trim(rest_);
    return rest_.empty() || rest_.front() == '#';
  }
  bool Take(char c) {
    rest_ = Trim(rest_);
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }
  std::string Name(const char* what) {
    rest_ = Trim(rest_);
    const std::string_view name = rest_.substr(0, rest_.find_first_of(" \t\r]=#"));
    if (!IsName(name)) Expect(what);
    rest_.remove_prefix(name.size());
    return std::string(name);
  }
  std::vector<std::string> Values() {
    if (!Take('[')) return {Value()};
    std::vector<std::string> values;
    while (!Take(']')) {
      values.push_back(Value());
      if (!Take(',') && !rest_.starts_with(']')) Expect("',' or ']'");
    }
    return values;
  }

 private:
  std::string Value() {
    rest_ = Trim(rest_);
    if (rest_.starts_with('"') || rest_.starts_with('\'')) return Quoted(rest_.front());
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r,]#"));
    const bool is_number = !word.empty() && word.find_first_not_of("0123456789+-.eE") == word.npos;
    if (!is_number && word != "true" && word != "false") {
      Expect("\"text\", a number, true or false");
    }
    rest_.remove_prefix(word.size());
    return std::string(word);
  }
  // A one-line TOML string, without escapes: names of files and words need none.
  std::string Quoted(char quote) {
    const size_t end = rest_.find(quote, 1);
    if (end == rest_.npos) Expect("a text that ends in this line");
    const std::string_view text = rest_.substr(1, end - 1);
    if (quote == '"' && text.find('\\') != text.npos) Expect("'text' in single quotes for a \\");
    std::string value(text);
    rest_.remove_prefix(end + 1);
    return value;
  }

  std::string_view rest_;
  std::string place_;
};

// The value for an option that takes one.
void SetValue(CLI::Option& option, const DefaultValue& value) {
  const bool is_flag = option.get_items_expected_max() == 0;
  for (const std::string& text : value.values) {
    if (is_flag && text != "true" && text != "false") {
      throw CLI::ValidationError(value.name, "expected true or false, found '" + text + "'");
    }
    if (!is_flag || text == "true") option.add_result(text);
  }
  if (option.count() > 0) option.run_callback();
}

CLI::Option& FindOption(CLI::App& app, const DefaultValue& value, const std::string& place) {
  CLI::Option* option = app.get_option_no_throw("--" + value.name);
  if (option != nullptr && value.name != "help") return *option;
  std::vector<std::string> names;
  for (const CLI::Option* known : app.get_options()) {
    for (const std::string& name : known->get_lnames()) {
      if (name != "help") names.push_back(name);
    }
  }
  const std::string meant = ClosestWord(value.name, names);
  throw InputError(fmt::format("{}: expected the name of an option of 'ossa {}', found '{}'{}",
                               place, value.command, value.name,
                               meant.empty() ? "" : fmt::format(" (is '{}' meant?)", meant)));
}

}  // namespace

std::optional<fs::path> DefaultsFile() {
  const char* chosen = std::getenv("OSSA_CONFIG");
  if (chosen != nullptr && *chosen == '\0') return std::nullopt;
  if (chosen != nullptr) return chosen;
  const char* xdg = std::getenv("XDG_CONFIG_HOME");
  const char* home = std::getenv("HOME");
  fs::path folder;
  if (xdg != nullptr && *xdg == '/') {  // by the specification relative ones are ignored
    folder = xdg;
  } else if (home != nullptr && *home != '\0') {
    folder = fs::path(home) / ".config";
  } else {
    return std::nullopt;
  }
  std::error_code unknown;
  const fs::path file = folder / "ossa/config.toml";
  if (!fs::exists(file, unknown)) return std::nullopt;
  return file;
}

std::vector<DefaultValue> ReadDefaults(const fs::path& file) {
  std::ifstream in(file);
  if (!in || fs::is_directory(file))
    throw InputError(file.string() + ": cannot be read: expected a TOML file of defaults");
  std::vector<DefaultValue> defaults;
  std::string text, command;
  for (int line = 1; std::getline(in, text); ++line) {
    LineReader reader(text, fmt::format("{}: line {}", file.string(), line));
    if (reader.AtEnd()) continue;
    if (reader.Take('[')) {
      command = reader.Name("the name of a command in []");
      if (FindExamples(command).empty()) {
        throw InputError(fmt::format("{}: line {}: expected the name of a command, found '{}'",
                                     file.string(), line, command));
      }
      if (!reader.Take(']')) reader.Expect("]");
    } else {
      if (command.empty()) reader.Expect("[COMMAND] before the first option");
      DefaultValue& value = defaults.emplace_back();
      value.command = command;
      value.line = line;
      value.name = reader.Name("the name of an option");
      if (!reader.Take('=')) reader.Expect("name = value");
      value.values = reader.Values();
    }
    if (!reader.AtEnd()) reader.Expect("the end of the line");
  }
  return defaults;
}

std::vector<DefaultValue> ListDefaults(std::string_view command) {
  const auto file = DefaultsFile();
  if (!file) return {};
  std::vector<DefaultValue> defaults = ReadDefaults(*file);
  std::erase_if(defaults, [&](const DefaultValue& value) { return value.command != command; });
  return defaults;
}

void ApplyDefaults(CLI::App& app, std::string_view command, const std::set<std::string>& left_out) {
  const auto defaults = ListDefaults(command);
  for (size_t i = 0; i < defaults.size(); ++i) {
    const DefaultValue& value = defaults[i];
    const std::string place = fmt::format("{}: line {}", DefaultsFile()->string(), value.line);
    const auto is_same = [&](const DefaultValue& other) { return other.name == value.name; };
    if (std::any_of(defaults.begin(), defaults.begin() + static_cast<std::ptrdiff_t>(i), is_same)) {
      throw InputError(
          fmt::format("{}: expected each option once, found '{}' again", place, value.name));
    }
    CLI::Option& option = FindOption(app, value, place);
    if (option.count() > 0) continue;  // the command line takes precedence
    if (left_out.contains(value.name)) continue;
    try {
      SetValue(option, value);
    } catch (const CLI::ParseError& error) {
      throw InputError(fmt::format("{}: {}", place, error.what()));
    }
  }
}

}  // namespace ossa::commands
