#include "backend/render.hpp"

#include <algorithm>
#include <kainjow/mustache.hpp>
#include <stdexcept>

#include "backend/json_context.hpp"
#include "text/markdown.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

/// Whether a line contains only one section tag.
bool is_section_line(std::string_view line) {
  const std::size_t begin = line.find_first_not_of(' ');
  if (begin == std::string_view::npos || !line.substr(begin).starts_with("{{")) return false;
  if (!line.ends_with("}}") || line.find("}}") != line.size() - 2) return false;
  return line.size() > begin + 2 && std::string_view{"#/^!"}.find(line[begin + 2]) != std::string_view::npos;
}

/// Removes the line ends of lines that contain only a section tag, so that they do not produce empty lines.
std::string without_section_lines(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    if (is_section_line(line)) {
      out += line.substr(line.find('{'));
    } else {
      out += line;
      if (end < text.size()) out += '\n';
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

/// The output of the library.
struct Output {
  std::string text;
  Output& operator<<(const std::string& part) {
    text += part;
    return *this;
  }
};

std::string render_escaped(std::string_view text, const nlohmann::ordered_json& view,
                           const kainjow::mustache::mustache::escape_handler& escape) {
  kainjow::mustache::mustache filler{without_section_lines(text)};
  if (!filler.is_valid()) throw std::runtime_error{filler.error_message()};
  filler.set_custom_escape(escape);
  JsonContext context{view};
  Output out;
  filler.render(context, out);
  if (!filler.is_valid()) throw std::runtime_error{filler.error_message()};
  return std::move(out.text);
}

}  // namespace

bool is_needed(const Template& header, const nlohmann::ordered_json& view) {
  return header.needed.empty() || !view.at(std::string{header.needed}).is_null();
}

std::string_view report_template(std::string_view file_name) {
  const auto found = std::ranges::find(report_templates(), file_name, &Template::file_name);
  if (found == report_templates().end()) throw std::logic_error{"unknown template " + std::string{file_name}};
  return found->text;
}

std::string render(std::string_view text, const nlohmann::ordered_json& view) {
  return render_escaped(text, view, [](const std::string& plain) { return plain; });
}

std::string render_html(std::string_view text, const nlohmann::ordered_json& view) {
  return render_escaped(text, view,
                        [](const std::string& plain) { return kainjow::mustache::html_escape(printable(plain)); });
}

std::string render_markdown(std::string_view text, const nlohmann::ordered_json& view) {
  return render_escaped(text, view, [](const std::string& plain) { return markdown_text(plain); });
}

}  // namespace edsc
