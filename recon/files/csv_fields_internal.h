#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace ossa::recon {

/// Splits the lines of a table with a header, as ossa and spreadsheets of any locale save it:
/// fields are separated by ',', ';' or tabs, whichever is most frequent in the header, and may be
/// quoted. Decimal commas become points; where ',' separates fields, they occur in quotes only.
/// Commas that may separate thousands stay, and are no numbers: 1,234 until a row before or the row
/// itself has a number like 0,5.
class CsvFields {
 public:
  explicit CsvFields(std::string_view header);

  /// Fields without surrounding white space and quotes. A separator at the end starts an empty last
  /// field.
  std::vector<std::string> Split(std::string_view line);
  /// As Split, for a row of a table of `columns` columns: drops blank fields beyond them, which
  /// spreadsheets add.
  std::vector<std::string> SplitRow(std::string_view line, size_t columns);

 private:
  bool HasDecimalCommas(const std::vector<std::string>& fields);

  char separator_ = ',';
  bool decimal_commas_ = false;  // a row had a comma that can be nothing else
};

/// The names of a header, blank ones at its end left out.
std::vector<std::string> ReadCsvHeader(std::string_view header);

}  // namespace ossa::recon
