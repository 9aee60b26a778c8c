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

// Whether a field is a number with one comma and no point.
bool HasOneComma(std::string_view field) {
  return std::count(field.begin(), field.end(), ',') == 1 &&
         field.find_first_not_of("+-0123456789,eE") == field.npos;
}

// Whether the comma of such a field may separate thousands: of 1,234, but not of 0,123 or 1,23.
bool MayBeThousands(std::string_view field) {
  constexpr size_t kGroup = 3;  // digits, by convention
  if (field.starts_with('-') || field.starts_with('+')) field.remove_prefix(1);
  const size_t comma = field.find(',');
  const bool is_group =
      field.substr(comma + 1).size() == kGroup && field.find_first_of("eE") == field.npos;
  return is_group && comma >= 1 && comma <= kGroup && field.front() != '0';
}

// What the numbers of a row tell of its commas.
struct RowCommas {
  bool points = false;    // some have decimal points
  bool decimals = false;  // some commas can be nothing but decimal ones
  size_t whole = 0;       // numbers with neither
};

RowCommas FindCommas(const std::vector<std::string>& fields) {
  RowCommas row;
  for (const std::string& field : fields) {
    const bool has_comma = HasOneComma(field);
    row.decimals = row.decimals || (has_comma && !MayBeThousands(field));
    if (has_comma || !LooksLikeNumber(field)) continue;
    const bool has_point = field.find('.') != field.npos;
    row.points = row.points || has_point;
    row.whole += has_point ? 0 : 1;
  }
  return row;
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

bool CsvFields::HasDecimalCommas(const std::vector<std::string>& fields) {
  constexpr size_t kMostWhole = 3;  // by hand: frame, time and person are whole in any locale
  const RowCommas row = FindCommas(fields);
  if (row.points) return false;
  decimal_commas_ = decimal_commas_ || row.decimals;
  return decimal_commas_ || (separator_ == ';' && row.whole <= kMostWhole);
}

std::vector<std::string> CsvFields::Split(std::string_view line) {
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
  for (std::string& field : fields) field = std::string(Trimmed(field));
  if (!HasDecimalCommas(fields)) return fields;
  for (std::string& field : fields) {
    if (HasOneComma(field)) std::replace(field.begin(), field.end(), ',', '.');
  }
  return fields;
}

std::vector<std::string> CsvFields::SplitRow(std::string_view line, size_t columns) {
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
