#include "tools/experiments/compare/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "depth/base/one_line.h"

namespace ossa::tools {
namespace {

// Constants: layout of a plot in pixels, by eye.

constexpr double kWidth = 860;
constexpr double kHeight = 320;
constexpr double kLeft = 56;
constexpr double kRight = 12;
constexpr double kTop = 12;
constexpr double kBottom = 66;  // height of the slanted names under bars

// The round step (1, 2 or 5 times a power of ten) that divides a range into about five parts.
double RoundStep(double range) {
  const double rough = std::max(range, 1e-9) / 5;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10 * power;
}

struct Frame {
  double x_min = 0;
  double x_max = 1;
  double y_max = 1;
  double X(double x) const {
    return kLeft + (kWidth - kLeft - kRight) * (x - x_min) / (x_max - x_min);
  }
  double Y(double y) const { return kHeight - kBottom - (kHeight - kTop - kBottom) * y / y_max; }
};

std::string Text(double x, double y, const std::string& text, const char* anchor,
                 const char* extra = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {}>{}</text>", x, y,
                     anchor, extra, Escaped(text));
}

std::string Begin() {
  return fmt::format("<svg viewBox=\"0 0 {} {}\" class=\"plot\">", kWidth, kHeight);
}

std::string YGrid(const Frame& frame, const std::string& label) {
  std::string svg;
  const double step = RoundStep(frame.y_max);
  for (double y = 0; y <= frame.y_max * (1 + 1e-9); y += step) {
    svg += fmt::format("<line x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\" class=\"grid\"/>",
                       kLeft, kWidth - kRight, frame.Y(y), frame.Y(y));
    svg += Text(kLeft - 6, frame.Y(y) + 4, fmt::format("{:g}", y), "end");
  }
  const double middle = (kHeight - kBottom) / 2;
  return svg + Text(14, middle, label, "middle",
                    fmt::format("transform=\"rotate(-90 14 {:.0f})\"", middle).c_str());
}

std::string XGrid(const Frame& frame, const std::string& label) {
  std::string svg;
  const double step = RoundStep(frame.x_max - frame.x_min);
  for (double x = std::ceil(frame.x_min / step) * step; x <= frame.x_max * (1 + 1e-9); x += step) {
    svg += fmt::format("<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\" class=\"grid\"/>",
                       frame.X(x), kTop, kHeight - kBottom);
    svg += Text(frame.X(x), kHeight - kBottom + 15, fmt::format("{:g}", x), "middle");
  }
  return svg + Text((kLeft + kWidth) / 2, kHeight - 10, label, "middle");
}

std::string Legend(const std::vector<std::string>& names) {
  std::string html = "<p class=\"legend\">";
  for (size_t i = 0; i < names.size(); ++i) {
    html += fmt::format("<span style=\"color:{}\">&#9632;</span> {} &nbsp; ", SeriesColour(i),
                        Escaped(names[i]));
  }
  return html + "</p>";
}

std::string Line(const Series& series, const Frame& frame, const std::string& colour) {
  std::string path;
  bool open = false;
  for (size_t i = 0; i < series.x.size(); ++i) {
    if (!series.y[i] || series.x[i] > frame.x_max) {
      open = false;
      continue;
    }
    path += fmt::format("{}{:.1f},{:.1f}", open ? "L" : "M", frame.X(series.x[i]),
                        frame.Y(std::min(*series.y[i], frame.y_max)));
    open = true;
  }
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>", path,
                     colour);
}

Frame FrameOf(const std::vector<Series>& all, const Axes& axes) {
  Frame frame{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), 0};
  for (const Series& series : all) {
    for (size_t i = 0; i < series.x.size(); ++i) {
      frame.x_min = std::min(frame.x_min, series.x[i]);
      frame.x_max = std::max(frame.x_max, series.x[i]);
      frame.y_max = std::max(frame.y_max, series.y[i].value_or(0));
    }
  }
  if (axes.x_max) {
    frame.x_min = 0;
    frame.x_max = *axes.x_max;
  }
  if (!(frame.x_max > frame.x_min)) {
    frame.x_min = std::isfinite(frame.x_min) ? frame.x_min : 0;
    frame.x_max = frame.x_min + 1;
  }
  if (axes.y_max) frame.y_max = *axes.y_max;
  if (frame.y_max <= 0) frame.y_max = 1;
  return frame;
}

// File names may contain invalid UTF-8, which pages must not.
std::string Printable(std::string_view text) {
  std::string lines;
  while (true) {
    const size_t end = text.find('\n');
    lines += OnOneLine(text.substr(0, end));
    if (end == std::string_view::npos) return lines;
    lines += '\n';
    text.remove_prefix(end + 1);
  }
}

}  // namespace

std::string Escaped(const std::string& text) {
  std::string safe;
  for (const char c : Printable(text)) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe.push_back(c);
    }
  }
  return safe;
}

std::string SeriesColour(size_t index) {
  // Okabe and Ito's colours, for colour-blind readers too.
  static constexpr std::array kColours = {"#D55E00", "#0072B2", "#009E73", "#CC79A7",
                                          "#E69F00", "#56B4E9", "#8C6D31"};
  return kColours[index % kColours.size()];
}

std::string LinePlot(const std::vector<Series>& series, const Axes& axes) {
  const Frame frame = FrameOf(series, axes);
  std::string svg = Begin() + YGrid(frame, axes.y_label) + XGrid(frame, axes.x_label);
  std::vector<std::string> names;
  for (size_t i = 0; i < series.size(); ++i) {
    svg += Line(series[i], frame, SeriesColour(i));
    names.push_back(series[i].name);
  }
  return Legend(names) + svg + "</svg>";
}

std::string BarPlot(const std::vector<std::string>& series, const std::vector<std::string>& groups,
                    const std::vector<std::vector<std::optional<double>>>& values,
                    const std::string& y_label) {
  Frame frame{0, static_cast<double>(std::max<size_t>(groups.size(), 1)), 0};
  for (const auto& row : values) {
    for (const auto& value : row) frame.y_max = std::max(frame.y_max, value.value_or(0));
  }
  if (frame.y_max <= 0) frame.y_max = 1;
  std::string svg = Begin() + YGrid(frame, y_label);
  const double bar = 0.8 / static_cast<double>(std::max<size_t>(series.size(), 1));
  for (size_t g = 0; g < groups.size(); ++g) {
    const double left = static_cast<double>(g) + 0.1;
    for (size_t s = 0; s < series.size(); ++s) {
      if (!values[s][g]) continue;
      const double x = frame.X(left + bar * static_cast<double>(s));
      const double y = frame.Y(*values[s][g]);
      svg += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\">"
          "<title>{} {}: {:.2f}</title></rect>",
          x, y, frame.X(bar) - frame.X(0) - 1, frame.Y(0) - y, SeriesColour(s), Escaped(groups[g]),
          Escaped(series[s]), *values[s][g]);
    }
    const double middle = frame.X(static_cast<double>(g) + 0.5);
    const std::string turn =
        fmt::format("transform=\"rotate(-35 {:.1f} {:.1f})\"", middle, kHeight - kBottom + 12);
    svg += Text(middle, kHeight - kBottom + 12, groups[g], "end", turn.c_str());
  }
  return Legend(series) + svg + "</svg>";
}

}  // namespace ossa::tools
