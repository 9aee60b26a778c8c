#include "tools/experiments/page/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <optional>

#include "tools/experiments/compare/svg_plot.h"
#include "tools/json/base64.h"

namespace ossa::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>ossa experiment {0}</title><style>
body{{font:15px/1.45 system-ui,sans-serif;color:#222;max-width:920px;margin:2em auto;padding:0 1em}}
h1{{font-size:1.5em}}h2{{font-size:1.15em;margin-top:2em}}img{{max-width:100%}}
table{{border-collapse:collapse;font-size:13px}}td,th{{border-bottom:1px solid #ddd;padding:3px 9px;
text-align:right}}td:first-child,th:first-child{{text-align:left}}.scroll{{overflow-x:auto}}
svg text{{font:11px system-ui,sans-serif;fill:#444}}.grid{{stroke:#e4e4e4}}.plot{{width:100%}}
.legend,.note{{font-size:13px;color:#444}}</style></head><body>
<h1>ossa experiment {0}</h1>
)";

std::string Row(const std::vector<std::string>& cells, const char* tag) {
  std::string row = "<tr>";
  for (const std::string& cell : cells) row += fmt::format("<{0}>{1}</{0}>", tag, Escaped(cell));
  return row + "</tr>\n";
}

// The number that a cell begins with: 2.27 of "2.27 ± 0.1"; empty for "–" and for words.
std::optional<double> ParseNumber(const std::string& cell) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
  if (error != std::errc()) return std::nullopt;
  return number;
}

// Bars for each row, of the columns whose numbers have similar size in most rows: else the largest
// would hide all others.
std::string Plot(const Table& table) {
  constexpr size_t kMostRows = 40, kMostColumns = 6;  // by eye: more cannot be told apart
  if (table.rows.empty() || table.rows.size() > kMostRows) return {};
  std::vector<std::string> series, groups;
  std::vector<std::vector<std::optional<double>>> values;
  for (size_t c = 1; c < table.columns.size() && series.size() < kMostColumns; ++c) {
    std::vector<std::optional<double>> column;
    for (const auto& row : table.rows) {
      auto number = c < row.size() ? ParseNumber(row[c]) : std::nullopt;
      if (number && *number < 0) number.reset();  // bars begin at zero
      column.push_back(number);
    }
    const auto known =
        std::count_if(column.begin(), column.end(), [](const auto& v) { return v.has_value(); });
    if (2 * static_cast<size_t>(known) < column.size()) continue;
    series.push_back(table.columns[c]);
    values.push_back(std::move(column));
  }
  if (series.empty()) return {};
  for (const auto& row : table.rows) groups.push_back(row.empty() ? "" : row.front());
  return BarPlot(series, groups, values, "");
}

std::string Show(const Table& table) {
  std::string html = fmt::format("<h2>{}</h2>\n{}\n<div class=\"scroll\"><table>\n",
                                 Escaped(table.title), Plot(table));
  html += Row(table.columns, "th");
  for (const auto& row : table.rows) html += Row(row, "td");
  return html + fmt::format("</table></div>\n<p class=\"note\">{}</p>\n", Escaped(table.note));
}

std::string ShowFigure(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const char* type = file.extension() == ".svg" ? "svg+xml" : "png";
  return fmt::format("<h2>{}</h2>\n<img alt=\"{}\" src=\"data:image/{};base64,{}\">\n",
                     Escaped(file.stem().string()), Escaped(file.filename().string()), type,
                     Base64(bytes));
}

}  // namespace

std::string ExperimentPage(std::string_view name, const std::vector<Table>& tables,
                           const fs::path& folder) {
  std::string html = fmt::format(fmt::runtime(kHead), Escaped(std::string(name)));
  for (const Table& table : tables) html += Show(table);
  std::vector<fs::path> figures;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path extension = entry.path().extension();
    if (extension == ".svg" || extension == ".png") figures.push_back(entry.path());
  }
  std::sort(figures.begin(), figures.end());
  for (const fs::path& figure : figures) html += ShowFigure(figure);
  return html + "</body></html>\n";
}

}  // namespace ossa::tools
