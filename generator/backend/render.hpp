/// Renders views with templates.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace edsc {

/// A template built into edsc, or read from a folder.
struct Template {
  std::string_view file_name;  ///< of the generated file, such as `dictionary.hpp`
  std::string_view text;
  std::string_view needed = {};  ///< a member of the view; if it is null, the file is not generated
};

/// The templates of the generated headers, in the order of writing their files.
[[nodiscard]] const std::vector<Template>& built_in_templates();

/// The templates of a target of `edsc generate`, by its name; for C++ the same.
[[nodiscard]] const std::vector<Template>& target_templates(std::string_view target);

/// The other templates: of reports, with their styles and scripts, and of networks.
[[nodiscard]] const std::vector<Template>& report_templates();

/// The text of one of these, by the name of its file without `.mustache`. An unknown name is a fault of edsc.
[[nodiscard]] std::string_view report_template(std::string_view file_name);

/// Whether a header is generated for this view.
[[nodiscard]] bool is_needed(const Template& header, const nlohmann::ordered_json& view);

/// Renders a template. Throws std::runtime_error with a message if the template is invalid, or uses a name that the
/// view does not have.
[[nodiscard]] std::string render(std::string_view text, const nlohmann::ordered_json& view);

/// The same for HTML: each value becomes printable, and <, >, &, " and ' in it become entities.
[[nodiscard]] std::string render_html(std::string_view text, const nlohmann::ordered_json& view);

/// The same for Markdown: each value becomes printable, and markup in it is escaped.
[[nodiscard]] std::string render_markdown(std::string_view text, const nlohmann::ordered_json& view);

}  // namespace edsc
