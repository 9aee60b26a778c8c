// The markdown of a table; separate from the studies, which `ossa compare` does not link.
#include "tools/experiments/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "depth/base/one_line.h"

namespace ossa::tools {
namespace {

// Width on a terminal: bytes that continue a UTF-8 character take no place.
size_t WidthOf(const std::string& text) {
  return static_cast<size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u;
  }));
}

std::string Padded(const std::string& text, size_t width) {
  return text + std::string(width - std::min(width, WidthOf(text)), ' ');
}

// Names of files may hold what Markdown would take for the end of a cell or for HTML.
std::string InMarkdown(const std::string& text) {
  const std::string line = OnOneLine(text);
  std::string escaped;
  for (size_t i = 0; i < line.size(); ++i) {
    const char next = i + 1 < line.size() ? line[i + 1] : ' ';
    // CommonMark 0.30, section 6.6: a tag begins with one of these; "<10 cm" is none.
    const bool is_tag = line[i] == '<' && (std::isalpha(static_cast<unsigned char>(next)) != 0 ||
                                           next == '/' || next == '!' || next == '?');
    if (line[i] == '|' || is_tag) escaped += '\\';
    escaped += line[i];
  }
  return escaped;
}

Table InMarkdown(Table table) {
  table.title = InMarkdown(table.title);
  table.note = InMarkdown(table.note);
  for (std::string& column : table.columns) column = InMarkdown(column);
  for (auto& row : table.rows) {
    for (std::string& cell : row) cell = InMarkdown(cell);
  }
  return table;
}

}  // namespace

std::string ToMarkdown(const Table& unescaped) {
  const Table table = InMarkdown(unescaped);
  std::vector<size_t> widths;
  for (const std::string& column : table.columns) {
    widths.push_back(std::max<size_t>(3, WidthOf(column)));
  }
  for (const auto& row : table.rows) {
    for (size_t c = 0; c < row.size() && c < widths.size(); ++c) {
      widths[c] = std::max(widths[c], WidthOf(row[c]));
    }
  }
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text = "|";
    for (size_t c = 0; c < widths.size(); ++c) {
      text += fmt::format(" {} |", Padded(c < cells.size() ? cells[c] : "", widths[c]));
    }
    return text + "\n";
  };
  std::string text = "### " + table.title + "\n\n" + line(table.columns) + "|";
  for (const size_t width : widths) text += std::string(width + 2, '-') + "|";
  text += "\n";
  for (const auto& row : table.rows) text += line(row);
  if (!table.note.empty()) text += "\n" + table.note + "\n";
  return text;
}

}  // namespace ossa::tools
