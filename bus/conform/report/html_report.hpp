/// The report of a run as one HTML file that needs no other file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "conform/verdict.hpp"
#include "device/device.hpp"

namespace edsc::conform {

/// The maximum number of frames of a case in the report.
inline constexpr std::size_t max_html_frames = 500;

/// The names of conform_facts.html.mustache and conform_results.html.mustache in templates/html, for a page with other
/// parts.
[[nodiscard]] nlohmann::ordered_json run_view(const RunReport& run, const Device& sheet);
/// Those of conform_frames.html.mustache. `named`: positions of the frames that the failed check names.
[[nodiscard]] nlohmann::ordered_json frames_view(std::span<const SeenFrame> frames, std::uint8_t node,
                                                 const Device& sheet, std::span<const std::size_t> named = {});

/// Renders templates/html/conform.html.mustache, which is built into edsc.
[[nodiscard]] std::string html_report(const RunReport& run, const Device& sheet);

}  // namespace edsc::conform
