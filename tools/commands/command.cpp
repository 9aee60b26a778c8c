#include "tools/commands/command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "tools/commands/closest_word.h"
#include "tools/commands/default_options.h"
#include "tools/commands/describe.h"
#include "tools/commands/examples.h"

namespace ossa::commands {
namespace {

template <typename T>
bool IsWholeNumber(const std::string& text) {
  T number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

// CLI11 makes -1 the largest unsigned number, cuts whole numbers that are too large down to the
// largest, takes nan and inf, which pass by every range, and an empty word (a shell's unset
// variable) as a file's name.
void CheckValues(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();
    for (const std::string& text : option->results()) {
      if (text.empty() && option->get_expected_min() > 0) {
        throw UsageError(fmt::format("{}: expected a value, found ''", option->get_name()));
      }
      const bool good = type.starts_with("UINT")  ? IsWholeNumber<uint64_t>(text)
                        : type.starts_with("INT") ? IsWholeNumber<int64_t>(text)
                        : type.starts_with("FLOAT")
                            ? std::isfinite(std::strtod(text.c_str(), nullptr))
                            : true;
      if (good) continue;
      const char* expected = type.starts_with("UINT")  ? "a whole number from 0 up"
                             : type.starts_with("INT") ? "a whole number"
                                                       : "a finite number";
      throw UsageError(
          fmt::format("{}: expected {}, found '{}'", option->get_name(), expected, text));
    }
  }
}

// The first word that looks like an option and is none; "" where there is none.
std::string FindUnknownOption(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining();
  const auto found = std::find_if(words.begin(), words.end(),
                                  [](const std::string& word) { return word.starts_with('-'); });
  return found == words.end() ? "" : *found;
}

// The option that was most likely meant by that word.
std::string SuggestOption(const CLI::App& app) {
  const std::string word = FindUnknownOption(app);
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  const std::string meant = word.empty() ? "" : ClosestWord(word.substr(0, word.find('=')), names);
  return meant.empty() ? "" : fmt::format("is {} meant? ", meant);
}

void AddExamples(CLI::App& app, std::string_view command) {
  const std::string notes = app.get_footer();
  app.footer(ExamplesText(command) + (notes.empty() ? "" : "\n\n" + notes));
}

}  // namespace

void Parse(CLI::App& app, int argc, char** argv, const std::set<std::string>& left_out) {
  const std::string command = argv[0];
  app.name("ossa " + command);
  if (argc == 2 && std::string_view(argv[1]) == "--describe") {
    fmt::print("{}\n", Describe(app, command));
    throw HelpShown{};
  }
  AddExamples(app, command);
  try {
    app.parse(argc, argv);
    ApplyDefaults(app, command, left_out);
    CheckValues(app);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", app.help());
    throw HelpShown{};
  } catch (const CLI::ExtrasError& error) {
    throw UsageError(
        fmt::format("{} ({}see 'ossa {} --help')", error.what(), SuggestOption(app), command));
  } catch (const CLI::RequiredError& error) {
    // A missing option may be present under a mistyped name.
    const std::string unknown = FindUnknownOption(app);
    throw UsageError(fmt::format("{}{} ({}see 'ossa {} --help')", error.what(),
                                 unknown.empty() ? "" : ", and " + unknown + " was not expected",
                                 SuggestOption(app), command));
  } catch (const CLI::ParseError& error) {
    throw UsageError(fmt::format("{} (see 'ossa {} --help')", error.what(), command));
  }
}

}  // namespace ossa::commands
