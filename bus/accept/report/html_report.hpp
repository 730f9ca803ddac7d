/// The acceptance report as one HTML file that needs no other file.
#pragma once

#include <string>

#include "accept/acceptance.hpp"

namespace edsc::accept {

/// Renders templates/html/accept.html.mustache, which is built into edsc.
[[nodiscard]] std::string html_report(const Acceptance& acceptance);

}  // namespace edsc::accept
