#include "recon/files/csv_fields_internal.h"

#include <algorithm>
#include <array>

#include "recon/files/text_lines_internal.h"

namespace ossa::recon {
namespace {

// Number of occurrences of `separator` outside quotes.
size_t CountOutsideQuotes(std::string_view line, char separator) {
  size_t count = 0;
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == separator && !quoted) ++count;
  }
  return count;
}

void PointForDecimalComma(std::string& field) {
  const size_t comma = field.find(',');
  if (comma == std::string::npos || field.find(',', comma + 1) != std::string::npos) return;
  if (field.find_first_not_of("+-0123456789,eE") != std::string::npos) return;
  field[comma] = '.';
}

void DropBlankEnd(std::vector<std::string>& fields, size_t at_least) {
  while (fields.size() > at_least && fields.back().empty()) fields.pop_back();
}

}  // namespace

CsvFields::CsvFields(std::string_view header) {
  constexpr std::array kSeparators = {',', ';', '\t'};
  separator_ = *std::max_element(kSeparators.begin(), kSeparators.end(), [&](char a, char b) {
    return CountOutsideQuotes(header, a) < CountOutsideQuotes(header, b);
  });
}

std::vector<std::string> CsvFields::Split(std::string_view line) const {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (size_t at = 0; at < line.size(); ++at) {
    const char c = line[at];
    if (c == '"' && quoted && at + 1 < line.size() && line[at + 1] == '"') {
      fields.back().push_back(line[++at]);  // a doubled quote is an escaped one
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == separator_ && !quoted) {
      fields.emplace_back();
    } else {
      fields.back().push_back(c);
    }
  }
  for (std::string& field : fields) {
    field = std::string(Trimmed(field));
    PointForDecimalComma(field);
  }
  return fields;
}

std::vector<std::string> CsvFields::SplitRow(std::string_view line, size_t columns) const {
  std::vector<std::string> fields = Split(line);
  DropBlankEnd(fields, columns);
  return fields;
}

std::vector<std::string> ReadCsvHeader(std::string_view header) {
  std::vector<std::string> names = CsvFields(header).Split(header);
  DropBlankEnd(names, 0);
  return names;
}

}  // namespace ossa::recon
