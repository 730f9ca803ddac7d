/// The report of a run as one HTML file that needs nothing else.
#pragma once

#include <string>

#include "conform/verdict.hpp"
#include "device/device.hpp"

namespace edsc::conform {

/// Of each case at most `max_html_frames` frames are shown, the last ones.
inline constexpr std::size_t max_html_frames = 500;

/// Filled into templates/html/conform.html.mustache, which is built into edsc.
[[nodiscard]] std::string html_report(const RunReport& run, const Device& sheet);

}  // namespace edsc::conform
