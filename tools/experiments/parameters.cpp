#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string_view>

#include "depth/error.h"
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

// toml++ 3 runs into what it declares unreachable when a letter beyond ASCII stands where a space
// might: outside of texts and comments none is legal here anyway, and texts of several lines, where
// one may follow a backslash, are not needed.
void RefuseBareLetters(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    throw InputError(path.string() + ": cannot be read: expected a TOML file");
  }
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  int line = 1;
  char quote = 0;  // that ends the text or comment (a newline) we are in; 0: in neither
  const size_t begin = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;  // a byte-order mark
  for (size_t i = begin; i < text.size(); ++i) {
    const char c = text[i];
    line += c == '\n' ? 1 : 0;
    if (quote == '"' && c == '\\') {
      ++i;
    } else if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      if (text.compare(i, 3, std::string(3, c)) == 0)
        Fail(path.string(), line, "texts of one line, in one quote");
      // Within a bare word toml++ does not take it for the beginning of a text.
      if (i > begin && std::string_view(" \t\r\n=,[{\"'").find(text[i - 1]) == std::string::npos) {
        Fail(path.string(), line, "a quote at the beginning of a text");
      }
      quote = c;
    } else if (c == '#') {
      quote = '\n';
    } else if (static_cast<unsigned char>(c) >= 0x80) {
      Fail(path.string(), line, "letters beyond ASCII only in quotes");
    }
  }
}

}  // namespace

Parameters Parameters::FromToml(const std::filesystem::path& path) {
  Parameters parameters;
  parameters.source_ = path.string();
  RefuseBareLetters(path);
  toml::table table;
  try {
    table = toml::parse_file(path.string());
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

const Parameters::Value* Parameters::Find(const std::string& key, bool numbers, bool list) {
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

double Parameters::Number(const std::string& key, double usual) {
  const Value* value = Find(key, true, false);
  if (value != nullptr && value->flag) Fail(source_, value->line, key + " as a number");
  const double number = value != nullptr ? value->numbers.at(0) : usual;
  used_[key] = fmt::format("{}", number);
  return number;
}

int Parameters::Integer(const std::string& key, int usual) {
  const double number = Number(key, usual);
  if (number != std::floor(number) || std::abs(number) > 1e9) {
    Fail(source_, values_.at(key).line, key + " as a whole number");
  }
  used_[key] = fmt::format("{}", static_cast<int>(number));
  return static_cast<int>(number);
}

std::string Parameters::Text(const std::string& key, const std::string& usual) {
  const Value* value = Find(key, false, false);
  const std::string text = value != nullptr ? value->texts.at(0) : usual;
  used_[key] = InToml(text);
  return text;
}

std::vector<std::string> Parameters::Texts(const std::string& key,
                                           const std::vector<std::string>& usual) {
  const Value* value = Find(key, false, true);
  const auto texts = value != nullptr ? value->texts : usual;
  used_[key] = InToml(texts, [](const std::string& text) { return InToml(text); });
  return texts;
}

std::vector<double> Parameters::Numbers(const std::string& key, const std::vector<double>& usual) {
  const Value* value = Find(key, true, true);
  const auto numbers = value != nullptr ? value->numbers : usual;
  used_[key] = InToml(numbers, [](double number) { return fmt::format("{}", number); });
  return numbers;
}

std::string Parameters::Used() const {
  std::string text;
  for (const auto& [key, value] : used_) text += fmt::format("{} = {}\n", key, value);
  return text;
}

void Parameters::ExpectAllUsed() const {
  for (const auto& [key, value] : values_) {
    if (used_.contains(key)) continue;
    std::string known;
    for (const auto& [name, text] : used_) known.append(known.empty() ? "" : ", ").append(name);
    Fail(source_, value.line, fmt::format("one of {}; found {}", known, key));
  }
}

}  // namespace ossa::tools
