#include "web/edit_page.hpp"

#include <nlohmann/json.hpp>
#include <string_view>

#include "backend/render.hpp"
#include "backend/template_parts.hpp"

namespace edsc {
namespace {

/// The scripts of the page, each after those that it uses.
constexpr std::string_view edit_scripts[] = {
    "elements.js",      "edit_client.js",   "virtual_rows.js",    "tabs.js",
    "dialogs.js",       "choice_box.js",    "completion.js",      "form_field.js",
    "entry_grid.js",    "object_filter.js", "object_tree.js",     "pdo_bits.js",
    "pdo_editor.js",    "device_form.js",   "side_panel.js",      "new_object_dialog.js",
    "member_fields.js", "item_list.js",     "member_dialog.js",   "set_values.js",
    "node_editor.js",   "signal_editor.js", "network_drawing.js", "bus_load.js",
    "network_view.js",  "edit.js",
};

}  // namespace

std::string edit_page() {
  std::string scripts;
  for (const std::string_view name : edit_scripts) scripts += report_template(name);
  return render_html(with_parts("edit.html"),
                     {{"style", with_parts("edit.css")}, {"scripts", scripts}, {"nonce", "{{{nonce}}}"}});
}

}  // namespace edsc
