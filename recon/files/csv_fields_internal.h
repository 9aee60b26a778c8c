#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace ossa::recon {

/// Takes the lines of a table with a header apart, as ossa and spreadsheets of any country save it:
/// fields between ',', ';' or tabs, whichever the header has most of, in quotes or not. A number
/// with a decimal comma, which a ',' between fields allows in quotes only, gets a point.
class CsvFields {
 public:
  explicit CsvFields(std::string_view header);

  /// Without white space and quotes about them. A separator at the end opens an empty last field.
  std::vector<std::string> Split(std::string_view line) const;
  /// The same of a row of a table of so many columns: of blank fields beyond these, as spreadsheets
  /// add, nothing is left.
  std::vector<std::string> SplitRow(std::string_view line, size_t columns) const;

 private:
  char separator_ = ',';
};

/// The names of a header, blank ones at its end left out.
std::vector<std::string> ReadCsvHeader(std::string_view header);

}  // namespace ossa::recon
