#pragma once
#include <optional>
#include <string>
#include <vector>

namespace ossa::tools {

/// Escapes text for HTML and SVG in UTF-8; line breaks stay.
std::string Escaped(const std::string& text);

/// Colour of a series by index; the truth is drawn in kTruthColour.
std::string SeriesColour(size_t index);
inline constexpr const char* kTruthColour = "#444444";

/// One line of a plot; points without y are gaps.
struct Series {
  std::string name;
  std::vector<double> x;
  std::vector<std::optional<double>> y;
};

struct Axes {
  std::string x_label;
  std::string y_label;
  std::optional<double> x_max;  // the plot begins at zero and ends here, else at the data's end
  std::optional<double> y_max;
};

/// Lines over x, with grid, labels and a legend, as an <svg> element.
std::string LinePlot(const std::vector<Series>& series, const Axes& axes);

/// Groups of bars: values[series][group]; absent ones leave a gap.
std::string BarPlot(const std::vector<std::string>& series, const std::vector<std::string>& groups,
                    const std::vector<std::vector<std::optional<double>>>& values,
                    const std::string& y_label);

}  // namespace ossa::tools
