#include "tools/commands/describe.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tools/commands/examples.h"

namespace ossa::commands {
namespace {

using Json = nlohmann::ordered_json;

// Whether an option takes any number of values, rather than a fixed tuple.
bool Repeats(const CLI::Option& option) {
  return option.get_items_expected_max() > 1 &&
         option.get_items_expected_max() > option.get_items_expected_min();
}

// "TEXT:{on,off}=on" is a type, the choices, and a default.
std::string TypeOf(const CLI::Option& option) {
  const std::string name = option.get_type_name();
  const int together = option.get_items_expected_min();
  return name.substr(0, name.find(':')) +
         (together > 1 && !Repeats(option) ? " x " + std::to_string(together) : "");
}

std::vector<std::string> ChoicesOf(const CLI::Option& option) {
  const std::string name = option.get_type_name();
  const size_t begin = name.find('{'), end = name.find('}');
  std::vector<std::string> choices;
  if (begin == std::string::npos || end == std::string::npos) return choices;
  std::istringstream listed(name.substr(begin + 1, end - begin - 1));
  for (std::string choice; std::getline(listed, choice, ',');) choices.push_back(choice);
  return choices;
}

// "[1 - 6]" of "INT:INT in [1 - 6]=3".
std::string RangeOf(const CLI::Option& option) {
  const std::string name = option.get_type_name();
  const size_t in = name.find(" in [");
  if (in == std::string::npos) return {};
  const size_t begin = name.find('[', in);
  return name.substr(begin, name.find(']', begin) + 1 - begin);
}

Json NamesOf(const CLI::Option& option) {
  Json names = Json::array();
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

Json DescribeOption(const CLI::Option& option) {
  const bool is_flag = option.get_items_expected_max() == 0;
  return {{"names", NamesOf(option)},
          {"value", is_flag ? "" : TypeOf(option)},
          {"choices", ChoicesOf(option)},
          {"range", RangeOf(option)},
          {"default", option.get_default_str()},
          {"required", option.get_required()},
          {"repeats", Repeats(option)},
          {"help", option.get_description()}};
}

}  // namespace

std::string Describe(const CLI::App& app, std::string_view command) {
  Json positionals = Json::array(), options = Json::array(), examples = Json::array();
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) {
      positionals.push_back({{"name", option->get_name(true)},
                             {"required", option->get_required()},
                             {"repeats", Repeats(*option)},
                             {"help", option->get_description()}});
    } else {
      options.push_back(DescribeOption(*option));
    }
  }
  for (const Example& example : FindExamples(command)) {
    examples.push_back({{"line", example.line}, {"purpose", example.purpose}});
  }
  const Json all = {{"command", command},         {"description", app.get_description()},
                    {"positionals", positionals}, {"options", options},
                    {"notes", app.get_footer()},  {"examples", examples}};
  return all.dump();
}

}  // namespace ossa::commands
