/// The report of a run as one HTML file that needs no other file.
#pragma once

#include <string>

#include "conform/verdict.hpp"
#include "device/device.hpp"

namespace edsc::conform {

/// The maximum number of frames of a case in the report: the last ones.
inline constexpr std::size_t max_html_frames = 500;

/// Renders templates/html/conform.html.mustache, which is built into edsc.
[[nodiscard]] std::string html_report(const RunReport& run, const Device& sheet);

}  // namespace edsc::conform
