/// Templates that include others.
#pragma once

#include <string>
#include <string_view>

namespace edsc {

/// The text of a report template, with the templates that its lines `{{>name}}` include. A part without an extension
/// has that of the template.
[[nodiscard]] std::string with_parts(std::string_view name);

}  // namespace edsc
