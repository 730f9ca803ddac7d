#include "plot/plot_svg.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "plot/axis_ticks.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

// In pixels.
constexpr double picture_width = 1000, plot_left = 90, plot_right = 980;
constexpr double title_height = 40, legend_row = 18, panel_height = 160, panel_gap = 24, time_axis_height = 50;
constexpr double band_height = 26;
constexpr unsigned max_time_ticks = 10, max_value_ticks = 5;

/// Colours that people with impaired colour vision can distinguish (Okabe and Ito), for both backgrounds.
struct LineColor {
  std::string_view light, dark;
};

constexpr LineColor line_colors[] = {{"#0072b2", "#56b4e9"}, {"#d55e00", "#ff8c42"}, {"#009e73", "#2fd6a6"},
                                     {"#cc79a7", "#e8a3c8"}, {"#a07000", "#e6b800"}, {"#5b3fa8", "#b19cf0"}};

std::string style_text() {
  std::string style =
      "\nsvg { font: 12px sans-serif }\n.background { fill: #ffffff }\n"
      "text { fill: #222222 }\n.title { font-size: 16px }\n.frame { fill: none; stroke: #888888 }\n"
      ".grid { stroke: #dddddd }\n.state { fill-opacity: 0.35; stroke: none }\n.mixed { fill: #888888 }\n.line { fill: none; stroke-width: 1.5; stroke-linecap: round; stroke-linejoin: round }\n";
  std::string dark =
      ".background { fill: #181818 }\ntext { fill: #eeeeee }\n.frame { stroke: #999999 }\n.grid { stroke: #3a3a3a }\n";
  for (std::size_t i = 0; i < std::size(line_colors); ++i) {
    style += fmt::format(".c{0} {{ stroke: {1} }}\n.s{0} {{ fill: {1} }}\n", i, line_colors[i].light);
    dark += fmt::format(".c{0} {{ stroke: {1} }}\n.s{0} {{ fill: {1} }}\n", i, line_colors[i].dark);
  }
  return style + "@media (prefers-color-scheme: dark) {\n" + dark + "}\n";
}

std::string pixel_text(double pixel) { return fmt::format("{:.2f}", pixel); }

pugi::xml_node append_element(pugi::xml_node parent, const char* name, const char* style_class) {
  pugi::xml_node element = parent.append_child(name);
  element.append_attribute("class").set_value(style_class);
  return element;
}

pugi::xml_node append_text_at(pugi::xml_node parent, double x, double y, const char* anchor, const std::string& text) {
  pugi::xml_node element = parent.append_child("text");
  element.append_attribute("x").set_value(pixel_text(x).c_str());
  element.append_attribute("y").set_value(pixel_text(y).c_str());
  element.append_attribute("text-anchor").set_value(anchor);
  element.text().set(printable(text).c_str());
  return element;
}

void append_rule(pugi::xml_node parent, double x1, double y1, double x2, double y2, const char* style_class) {
  pugi::xml_node rule = append_element(parent, "line", style_class);
  rule.append_attribute("x1").set_value(pixel_text(x1).c_str());
  rule.append_attribute("y1").set_value(pixel_text(y1).c_str());
  rule.append_attribute("x2").set_value(pixel_text(x2).c_str());
  rule.append_attribute("y2").set_value(pixel_text(y2).c_str());
}

/// From a number to a pixel.
struct Scale {
  double min = 0, max = 1;
  double from = 0, to = 1;

  [[nodiscard]] double at(double value) const {
    // Halves: the difference of the limits need not be a finite number.
    return from + (value / 2 - min / 2) / (max / 2 - min / 2) * (to - from);
  }
};

/// The times of the log, in seconds from the origin of the axis.
struct TimeAxis {
  std::int64_t origin_us = 0, last_us = 0;
  Scale scale;
  AxisTicks ticks;
  std::string label = "time in s";

  explicit TimeAxis(const Plot& plot) : last_us{plot.last_us} {
    constexpr std::int64_t first_date_us = 100'000'000'000'000;  // 1973: no measurement lasts so long
    if (plot.first_us >= first_date_us) {
      origin_us = plot.first_us;
      constexpr std::int64_t second = 1'000'000, last_year = 253'402'300'799;  // 9999
      const auto seconds = static_cast<std::time_t>(std::min(origin_us / second, last_year));
      label += fmt::format(" since {:%Y-%m-%d %H:%M:%S}.{:06} UTC", fmt::gmtime(seconds), origin_us % second);
    }
    scale = {seconds_of(plot.first_us), seconds_of(plot.last_us), plot_left, plot_right};
    if (scale.max <= scale.min) scale.max = scale.min + 1;
    ticks = axis_ticks(scale.min, scale.max, max_time_ticks);
  }

  [[nodiscard]] double seconds_of(std::int64_t microseconds) const {
    return static_cast<double>(microseconds - origin_us) / 1e6;
  }
  [[nodiscard]] double x(std::int64_t microseconds) const { return scale.at(seconds_of(microseconds)); }
};

/// The bins of a pixel column become one, so that the path has at most four points for each column.
std::vector<ValueBin> bins_of_pixels(const std::vector<ValueBin>& bins, const TimeAxis& time) {
  constexpr auto columns = static_cast<std::size_t>(plot_right - plot_left);
  if (bins.size() <= 2 * columns) return bins;
  std::vector<ValueBin> result;
  for (const ValueBin& bin : bins) {
    const bool same = !result.empty() && std::floor(time.x(result.back().first_us)) == std::floor(time.x(bin.first_us));
    if (same) {
      result.back().append(bin);
    } else {
      result.push_back(bin);
    }
  }
  return result;
}

/// The commands of an SVG path.
class LinePath {
 public:
  void move_or_draw(double x, double y, bool steps) {
    if (is_broken_) {
      text_ += fmt::format("M{:.2f} {:.2f}h0", x, y);  // a single value is a dot
      is_broken_ = false;
    } else if (steps) {
      text_ += fmt::format("H{:.2f}V{:.2f}", x, y);
    } else {
      text_ += fmt::format("L{:.2f} {:.2f}", x, y);
    }
    y_ = y;
  }
  /// The last value remains until then.
  void hold_to(double x) { text_ += fmt::format("H{:.2f}", x); }
  /// The next value is not connected to the last one.
  void break_line() { is_broken_ = true; }
  void draw_vertical(double y) {
    if (y != y_) text_ += fmt::format("V{:.2f}", y);
    y_ = y;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
  double y_ = 0;
  bool is_broken_ = true;
};

std::string path_of(const PlotLine& line, const TimeAxis& time, const Scale& values) {
  LinePath path;
  for (const ValueBin& bin : bins_of_pixels(line.series.bins(), time)) {
    path.move_or_draw(time.x(bin.first_us), values.at(bin.first), line.steps);
    path.draw_vertical(values.at(bin.min));
    path.draw_vertical(values.at(bin.max));
    path.draw_vertical(values.at(bin.last));
    if (bin.lost_us) {
      path.hold_to(time.x(std::min(*bin.lost_us, time.last_us)));
      path.break_line();
    }
  }
  const ValueBin& last = line.series.bins().back();
  if (!last.lost_us && last.last_us < time.last_us) path.hold_to(time.x(time.last_us));
  return path.text();
}

std::string state_name(const PlotLine& line, const StateRun& run) {
  if (run.is_mixed) return "several states";
  const auto found = line.state_names.find(run.state);
  return found != line.state_names.end() ? found->second : fmt::format("{}", run.state);
}

/// A piece of a band, in pixels.
struct BandPiece {
  double left, right;
  StateRun run;
};

/// A run that is narrower than half a pixel becomes one with its neighbours of that width.
std::vector<BandPiece> pieces_of(const PlotLine& line, const TimeAxis& time) {
  constexpr double narrow = 0.5;
  const std::vector<StateRun>& runs = line.states.runs();
  std::vector<BandPiece> pieces;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const bool is_last = i + 1 == runs.size();
    const std::int64_t next_us = is_last ? time.last_us : runs[i + 1].first_us;
    const double left = time.x(runs[i].first_us), right = time.x(std::min(runs[i].lost_us.value_or(next_us), next_us));
    const bool is_narrow = right - left < narrow && !is_last;
    const bool follows_narrow =
        !pieces.empty() && (pieces.back().run.is_mixed || pieces.back().right - pieces.back().left < narrow);
    if (is_narrow && follows_narrow && left - pieces.back().right < narrow) {
      pieces.back().right = right;
      pieces.back().run.is_mixed = true;
    } else {
      pieces.push_back({left, right, runs[i]});
    }
  }
  return pieces;
}

constexpr double character_width = 7, label_margin = 4;

double width_of(std::string_view name) { return static_cast<double>(name.size()) * character_width; }

/// A state as the legend has it.
struct LegendEntry {
  std::string name, style_class;
  double x = 0;
  unsigned row = 0;
};

/// The pieces of a band with their styles and names. States whose name does not fit into a piece are in the legend.
class Band {
 public:
  Band(const PlotLine& line, const TimeAxis& time) : line_{line}, pieces_{pieces_of(line, time)} {
    std::set<std::string> shown;
    for (const BandPiece& piece : pieces_) {
      if (has_label(piece)) shown.insert(name(piece));
    }
    for (const BandPiece& piece : pieces_) {
      const std::string style = style_class(piece);
      if (shown.insert(name(piece)).second) add_to_legend(name(piece), style);
    }
  }

  [[nodiscard]] const std::vector<BandPiece>& pieces() const { return pieces_; }
  [[nodiscard]] const std::vector<LegendEntry>& legend() const { return legend_; }
  [[nodiscard]] unsigned legend_rows() const { return legend_.empty() ? 0 : legend_.back().row + 1; }

  [[nodiscard]] std::string name(const BandPiece& piece) const { return state_name(line_, piece.run); }
  [[nodiscard]] static double width(const BandPiece& piece) { return std::max(piece.right - piece.left, 1.0); }
  [[nodiscard]] bool has_label(const BandPiece& piece) const {
    return width_of(name(piece)) + 2 * label_margin <= width(piece);
  }
  /// States get their colours in the order of the pieces.
  [[nodiscard]] std::string style_class(const BandPiece& piece) {
    const std::size_t color =
        colors_.try_emplace(piece.run.state, colors_.size() % std::size(line_colors)).first->second;
    return piece.run.is_mixed ? "state mixed" : fmt::format("state s{}", color);
  }

 private:
  void add_to_legend(std::string text, std::string style) {
    constexpr double mark_width = 18, distance = 16;
    const double width = mark_width + width_of(text) + distance;
    if (legend_x_ + width > plot_right && legend_x_ > plot_left) {
      legend_x_ = plot_left;
      ++legend_row_;
    }
    legend_.push_back({std::move(text), std::move(style), legend_x_, legend_row_});
    legend_x_ += width;
  }

  const PlotLine& line_;
  std::vector<BandPiece> pieces_;
  std::map<std::int64_t, std::size_t> colors_;
  std::vector<LegendEntry> legend_;
  double legend_x_ = plot_left;
  unsigned legend_row_ = 0;
};

struct Panel {
  std::string name;
  std::vector<const PlotLine*> lines;

  [[nodiscard]] bool is_band() const { return lines.front()->is_band; }
  [[nodiscard]] double height(const TimeAxis& time) const {
    if (is_band()) return panel_gap + legend_row + band_height + legend_row * Band{*lines.front(), time}.legend_rows();
    return panel_gap + legend_row * static_cast<double>(lines.size()) + panel_height;
  }
};

std::vector<Panel> panels_of(const Plot& plot) {
  std::vector<Panel> panels;
  for (const PlotLine& line : plot.lines) {
    auto found = std::ranges::find(panels, line.panel, &Panel::name);
    if (found == panels.end()) found = panels.insert(panels.end(), {line.panel, {}});
    found->lines.push_back(&line);
  }
  return panels;
}

/// The limits of a value axis: ticks that enclose all values.
Scale value_scale(const Panel& panel, double top, AxisTicks& ticks) {
  double min = panel.lines.front()->series.min(), max = panel.lines.front()->series.max();
  bool whole = true;
  for (const PlotLine* const line : panel.lines) {
    min = std::min(min, line->series.min());
    max = std::max(max, line->series.max());
    whole = whole && line->whole;
  }
  if (min == max) {
    const double margin = std::max(1.0, std::abs(min) * 1e-6);
    min -= margin;
    max += margin;
  }
  const double min_step = whole ? 1.0 : 0.0;
  const double step = axis_ticks(min, max, max_value_ticks, min_step).step;
  if (step > 0) {
    min = std::floor(min / step) * step;
    max = std::ceil(max / step) * step;
  }
  ticks = axis_ticks(min, max, max_value_ticks + 2, std::max(step, min_step));
  return {min, max, top + panel_height, top};
}

void append_band(pugi::xml_node svg, const PlotLine& line, const TimeAxis& time, double y) {
  pugi::xml_node group = append_element(svg, "g", "band");
  append_text_at(group, plot_left, y + panel_gap + 4, "start", line.name);
  const double top = y + panel_gap + legend_row;
  Band band{line, time};
  for (const BandPiece& piece : band.pieces()) {
    pugi::xml_node state = append_element(group, "rect", band.style_class(piece).c_str());
    state.append_attribute("x").set_value(pixel_text(piece.left).c_str());
    state.append_attribute("y").set_value(pixel_text(top).c_str());
    state.append_attribute("width").set_value(pixel_text(Band::width(piece)).c_str());
    state.append_attribute("height").set_value(pixel_text(band_height).c_str());
    state.append_child("title").text().set(printable(band.name(piece)).c_str());
    if (!band.has_label(piece)) continue;
    append_text_at(group, piece.left + label_margin, top + band_height / 2 + 4, "start", band.name(piece));
  }
  constexpr double mark_radius = 5, mark_distance = 14;
  for (const LegendEntry& entry : band.legend()) {
    const double row = top + band_height + legend_row * (entry.row + 0.75);
    pugi::xml_node mark = append_element(group, "circle", entry.style_class.c_str());
    mark.append_attribute("cx").set_value(pixel_text(entry.x + mark_radius).c_str());
    mark.append_attribute("cy").set_value(pixel_text(row - 4).c_str());
    mark.append_attribute("r").set_value(pixel_text(mark_radius).c_str());
    append_text_at(group, entry.x + mark_distance, row, "start", entry.name);
  }
}

void append_panel(pugi::xml_node svg, const Plot& plot, const Panel& panel, const TimeAxis& time, double y) {
  pugi::xml_node group = append_element(svg, "g", "panel");
  const double top = y + panel_gap + legend_row * static_cast<double>(panel.lines.size()), bottom = top + panel_height;
  AxisTicks ticks;
  const Scale values = value_scale(panel, top, ticks);
  for (const double tick : ticks.values) {
    append_rule(group, plot_left, values.at(tick), plot_right, values.at(tick), "grid value");
    append_text_at(group, plot_left - 6, values.at(tick) + 4, "end", ticks.text(tick));
  }
  for (const double tick : time.ticks.values)
    append_rule(group, time.scale.at(tick), top, time.scale.at(tick), bottom, "grid time");
  pugi::xml_node frame = append_element(group, "rect", "frame");
  frame.append_attribute("x").set_value(pixel_text(plot_left).c_str());
  frame.append_attribute("y").set_value(pixel_text(top).c_str());
  frame.append_attribute("width").set_value(pixel_text(plot_right - plot_left).c_str());
  frame.append_attribute("height").set_value(pixel_text(panel_height).c_str());
  double legend = y + panel_gap;
  for (const PlotLine* const line : panel.lines) {
    const auto color = static_cast<std::size_t>(line - plot.lines.data()) % std::size(line_colors);
    const std::string style_class = fmt::format("line c{}", color);
    append_rule(group, plot_left, legend, plot_left + 24, legend, style_class.c_str());
    append_text_at(group, plot_left + 32, legend + 4, "start",
                   line->unit.empty() ? line->name : line->name + " in " + line->unit);
    pugi::xml_node path = append_element(group, "path", style_class.c_str());
    path.append_attribute("d").set_value(path_of(*line, time, values).c_str());
    path.append_child("title").text().set(printable(line->name).c_str());
    legend += legend_row;
  }
}

}  // namespace

std::string plot_svg(const Plot& plot) {
  const TimeAxis time{plot};
  const std::vector<Panel> panels = panels_of(plot);
  double height = title_height + time_axis_height;
  for (const Panel& panel : panels) height += panel.height(time);

  pugi::xml_document document;
  pugi::xml_node svg = document.append_child("svg");
  svg.append_attribute("xmlns").set_value("http://www.w3.org/2000/svg");
  svg.append_attribute("width").set_value(fmt::format("{:.0f}", picture_width).c_str());
  svg.append_attribute("height").set_value(fmt::format("{:.0f}", height).c_str());
  svg.append_attribute("viewBox").set_value(fmt::format("0 0 {:.0f} {:.0f}", picture_width, height).c_str());
  svg.append_attribute("role").set_value("img");
  svg.append_child("title").text().set(printable(plot.title).c_str());
  std::string description;
  for (const PlotLine& line : plot.lines) {
    if (line.is_band) {
      description +=
          fmt::format("{}{}: {}", description.empty() ? "" : "; ", line.name, counted(line.states.count(), "value"));
      continue;
    }
    description += fmt::format("{}{}: {}, {} to {}{}{}", description.empty() ? "" : "; ", line.name,
                               counted(line.series.count(), "value"), line.series.min(), line.series.max(),
                               line.unit.empty() ? "" : " ", line.unit);
  }
  svg.append_child("desc").text().set(printable(description).c_str());
  svg.append_child("style").text().set(style_text().c_str());
  pugi::xml_node background = append_element(svg, "rect", "background");
  background.append_attribute("width").set_value("100%");
  background.append_attribute("height").set_value("100%");
  append_text_at(svg, plot_left, title_height - 12, "start", plot.title).append_attribute("class").set_value("title");
  double y = title_height;
  for (const Panel& panel : panels) {
    if (panel.is_band()) {
      append_band(svg, *panel.lines.front(), time, y);
    } else {
      append_panel(svg, plot, panel, time, y);
    }
    y += panel.height(time);
  }
  pugi::xml_node axis = append_element(svg, "g", "time-axis");
  for (const double tick : time.ticks.values)
    append_text_at(axis, time.scale.at(tick), y + 18, "middle", time.ticks.text(tick));
  append_text_at(svg, (plot_left + plot_right) / 2, y + 40, "middle", time.label);

  std::ostringstream out;
  document.save(out, "", pugi::format_raw | pugi::format_no_declaration);
  return out.str() + "\n";
}

}  // namespace edsc
