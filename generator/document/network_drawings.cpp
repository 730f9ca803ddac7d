#include "document/network_drawings.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <string_view>
#include <utility>

#include "backend/render.hpp"
#include "backend/template_parts.hpp"
#include "document/views.hpp"
#include "system/path.hpp"

namespace edsc {
namespace {

using document::Json;

constexpr std::size_t margin = 12;  ///< around a drawing, on each side; also in drawing.svg.mustache

/// The declarations of the block `:root` of this number in colors.css: 0 is light, 1 is dark.
std::string_view color_scheme(std::size_t number) {
  constexpr std::string_view begin = ":root {";
  std::string_view text = report_template("colors.css");
  for (std::size_t skipped = 0; skipped <= number; ++skipped) text.remove_prefix(text.find(begin) + begin.size());
  return text.substr(0, text.find('}'));
}

/// Rules with colours in place of variables, which many programs for SVG do not know.
std::string with_colors(std::string rules, std::string_view scheme) {
  constexpr std::string_view begin = "var(";
  for (std::size_t at = 0; (at = rules.find(begin, at)) != std::string::npos;) {
    const std::size_t close = rules.find(')', at);
    const std::string name = rules.substr(at + begin.size(), close - at - begin.size()) + ": ";
    const std::size_t value = scheme.find(name) + name.size();
    rules.replace(at, close + 1 - at, scheme.substr(value, scheme.find(';', value) - value));
  }
  return rules;
}

std::string style() {
  const std::string rules{report_template("drawing.css")};
  return fmt::format("{}@media (prefers-color-scheme: dark) {{\n{}}}", with_colors(rules, color_scheme(0)),
                     with_colors(rules, color_scheme(1)));
}

/// `section` is the part of the template that draws it.
std::string svg(std::string_view section, std::string title, const Json& drawing, std::string_view prefix) {
  const auto number = [&](std::string_view name) {
    return drawing.at(fmt::format("{}_{}", prefix, name)).get<std::size_t>();
  };
  Json view{{"title", std::move(title)},
            {"description", drawing.at(fmt::format("{}_label", prefix))},
            {"style", style()},
            {"view_width", number("width") + 2 * margin},
            {"view_height", number("height") + 2 * margin},
            {"topology", nullptr},
            {"sync", nullptr}};
  view[std::string{section}] = drawing;
  return render_html(with_parts("drawing.svg"), view);
}

}  // namespace

std::vector<OutputFile> network_drawings(const Network& network) {
  const std::string name{stem_of(network.source->name())};
  std::vector<OutputFile> files;
  files.push_back({name + ".svg", svg("topology", name, document::topology_drawing(network), "topology")});
  const Json cycle = document::cycle_drawing(network);
  if (!cycle.is_null()) {
    files.push_back({name + "_cycle.svg", svg("sync", fmt::format("SYNC cycle of {}", name), cycle, "cycle")});
  }
  return files;
}

}  // namespace edsc
