#include <fmt/format.h>
#include <fmt/ranges.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "depth/base/error.h"
#include "depth/base/open_file.h"
#include "depth/base/toml_shape.h"
#include "tools/experiments/experiment.h"

namespace ossa::tools {
namespace {

[[noreturn]] void Fail(const std::string& source, int line, const std::string& expected) {
  throw InputError(fmt::format("{}: line {}: expected {}", source, line, expected));
}

std::string InToml(const std::string& text) {
  std::string escaped = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') escaped.push_back('\\');
    escaped.push_back(c);
  }
  return escaped + '"';
}

template <typename Values, typename Format>
std::string InToml(const Values& values, Format format) {
  std::string text = "[";
  for (size_t i = 0; i < values.size(); ++i) text += (i > 0 ? ", " : "") + format(values[i]);
  return text + "]";
}

/// " of LEAST or more", " of LEAST to MOST" for messages; `boundless`: a `most` that is no bound.
template <typename T>
std::string InRange(T least, T most, T boundless) {
  if (most == boundless) return fmt::format(" of {} or more", least);
  return fmt::format(" of {} to {}", least, most);
}

std::string ReadText(const std::filesystem::path& path) {
  std::ifstream file = OpenFile(path);
  if (!file) {
    throw InputError(path.string() + ": cannot be read: expected a TOML file");
  }
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

Parameters Parameters::FromToml(const std::filesystem::path& path) {
  Parameters parameters;
  parameters.source_ = path.string();
  const std::string toml_text = ReadText(path);
  CheckTomlShape(toml_text, parameters.source_, TomlTables::kNone);
  toml::table table;
  try {
    table = toml::parse(toml_text, path.string());
  } catch (const toml::parse_error& error) {
    std::string reason(error.description());
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    Fail(parameters.source_, static_cast<int>(error.source().begin.line), "TOML: " + reason);
  }
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    Value value;
    value.line = static_cast<int>(node.source().begin.line);
    const auto add = [&](const toml::node& item) {
      if (item.is_boolean()) {
        value.numbers.push_back(*item.value<bool>() ? 1.0 : 0.0);
        value.flag = true;
      } else if (const auto number = item.value<double>()) {
        if (!std::isfinite(*number)) Fail(parameters.source_, value.line, name + " to be finite");
        value.numbers.push_back(*number);
      } else if (const auto text = item.value<std::string>()) {
        value.texts.push_back(*text);
      } else {
        Fail(parameters.source_, value.line, name + " as a number, a text or a list of them");
      }
    };
    if (const auto* list = node.as_array()) {
      value.list = true;
      for (const toml::node& item : *list) add(item);
    } else {
      add(node);
    }
    parameters.values_[name] = std::move(value);
  }
  return parameters;
}

void Parameters::FailAt(const std::string& key, const std::string& expected) const {
  Fail(source_, values_.at(key).line, expected);
}

const Parameters::Value* Parameters::Find(const std::string& key, bool numbers, bool list) {
  if (all_asked_ && !used_.contains(key)) {
    throw std::logic_error("parameter '" + key + "': not asked for before the study began");
  }
  const auto found = values_.find(key);
  if (found == values_.end()) return nullptr;
  const Value& value = found->second;
  const bool fits = (numbers ? value.texts.empty() : value.numbers.empty()) && value.list == list;
  if (!fits) {
    Fail(source_, value.line,
         fmt::format("{} as a {}{}", key, list ? "list of " : "", numbers ? "number" : "text"));
  }
  return &value;
}

bool Parameters::Flag(const std::string& key, bool usual) {
  const Value* value = Find(key, true, false);
  if (value != nullptr && !value->flag) Fail(source_, value->line, key + " as true or false");
  const bool flag = value != nullptr ? value->numbers.at(0) != 0 : usual;
  used_[key] = flag ? "true" : "false";
  return flag;
}

double Parameters::Number(const std::string& key, double usual, double least, double most) {
  const Value* value = Find(key, true, false);
  if (value != nullptr && value->flag) Fail(source_, value->line, key + " as a number");
  const double number = value != nullptr ? value->numbers.at(0) : usual;
  if (number < least || number > most) FailAt(key, key + InRange(least, most, kMostNumber));
  used_[key] = fmt::format("{}", number);
  return number;
}

int Parameters::Integer(const std::string& key, int usual, int least, int most) {
  const double number = Number(key, usual);
  if (number != std::floor(number) || std::abs(number) > kMostInteger) {
    FailAt(key, key + " as a whole number");
  }
  if (number < least || number > most) FailAt(key, key + InRange(least, most, kMostInteger));
  used_[key] = fmt::format("{}", static_cast<int>(number));
  return static_cast<int>(number);
}

std::string Parameters::Text(const std::string& key, const std::string& usual) {
  const Value* value = Find(key, false, false);
  const std::string text = value != nullptr ? value->texts.at(0) : usual;
  used_[key] = InToml(text);
  return text;
}

std::string Parameters::OneOf(const std::string& key, const std::vector<std::string>& known,
                              const std::string& usual) {
  std::string text = Text(key, usual);
  if (std::find(known.begin(), known.end(), text) == known.end()) {
    FailAt(key, fmt::format("{} as one of {}; found '{}'", key, fmt::join(known, ", "), text));
  }
  return text;
}

void Parameters::RequireMotion(const std::string& key, const std::string& source) const {
  if (source == "authored" || source == "authored-floor") return;
  if (!values_.contains(key) || std::filesystem::exists(source)) return;
  FailAt(key, fmt::format("{} as a folder or file of motion, or the word 'authored'; found '{}'",
                          key, source));
}

std::string Parameters::Motion(const std::string& key, const std::string& usual) {
  std::string source = Text(key, usual);
  if (source != usual) RequireMotion(key, source);
  return source;
}

std::vector<std::string> Parameters::Motions(const std::string& key) {
  const auto sources = Texts(key, {"authored"});
  if (sources.empty()) FailAt(key, key + " as a list of one or more");
  for (const std::string& source : sources) RequireMotion(key, source);
  return sources;
}

std::vector<std::string> Parameters::Texts(const std::string& key,
                                           const std::vector<std::string>& usual) {
  const Value* value = Find(key, false, true);
  const auto texts = value != nullptr ? value->texts : usual;
  used_[key] = InToml(texts, [](const std::string& text) { return InToml(text); });
  return texts;
}

std::vector<std::string> Parameters::Some(const std::string& key,
                                          const std::vector<std::string>& known,
                                          const std::vector<std::string>& usual) {
  std::vector<std::string> some = Texts(key, usual);
  for (const std::string& text : some) {
    if (std::find(known.begin(), known.end(), text) != known.end()) continue;
    FailAt(key, fmt::format("{} as some of {}; found '{}'", key, fmt::join(known, ", "), text));
  }
  return some;
}

std::set<std::string> Parameters::Some(const std::string& key,
                                       const std::vector<std::string>& known) {
  const auto some = Some(key, known, known);
  return {some.begin(), some.end()};
}

std::vector<double> Parameters::Numbers(const std::string& key, const std::vector<double>& usual,
                                        double least, double most) {
  const Value* value = Find(key, true, true);
  if (value != nullptr && value->flag) FailAt(key, key + " as a list of numbers");
  const auto numbers = value != nullptr ? value->numbers : usual;
  for (const double number : numbers) {
    if (number >= least && number <= most) continue;
    FailAt(key, key + " each" + InRange(least, most, kMostNumber));
  }
  used_[key] = InToml(numbers, [](double number) { return fmt::format("{}", number); });
  return numbers;
}

std::vector<int> Parameters::Integers(const std::string& key, const std::vector<int>& usual,
                                      int least, int most) {
  std::vector<int> integers;
  for (const double number : Numbers(key, {usual.begin(), usual.end()}, least, most)) {
    if (number != std::floor(number)) FailAt(key, key + " as a list of whole numbers");
    integers.push_back(static_cast<int>(number));
  }
  if (integers.empty()) FailAt(key, key + " as a list of one or more");
  return integers;
}

std::string Parameters::Used() const {
  std::string text;
  for (const auto& [key, value] : used_) text += fmt::format("{} = {}\n", key, value);
  return text;
}

void Parameters::RequireAllUsed() {
  for (const auto& [key, value] : values_) {
    if (used_.contains(key)) continue;
    std::string known;
    for (const auto& [name, text] : used_) known.append(known.empty() ? "" : ", ").append(name);
    Fail(source_, value.line, fmt::format("one of {}; found {}", known, key));
  }
  all_asked_ = true;
}

}  // namespace ossa::tools
