#include "accept/overlay_of.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <string>

namespace edsc::accept {
namespace {

/// Maximum number of frames in a reason: those of a block or segmented transfer are more.
constexpr std::size_t max_reason_frames = 4;

/// `605#4017100000000000 585#8017100000000206`
std::string frames_text(const std::vector<conform::SeenFrame>& frames) {
  std::string text;
  for (const conform::SeenFrame& seen : std::span{frames}.first(std::min(frames.size(), max_reason_frames))) {
    fmt::format_to(std::back_inserter(text), "{}{:03X}#", text.empty() ? "" : " ", seen.frame.id);
    for (const std::uint8_t byte : std::span{seen.frame.data}.first(seen.frame.size)) {
      fmt::format_to(std::back_inserter(text), "{:02X}", byte);
    }
  }
  if (frames.size() > max_reason_frames) text += " ...";
  return text;
}

}  // namespace

NewOverlay overlay_of(const Comparison& comparison) {
  NewOverlay overlay;
  for (const Difference& difference : comparison.differences) {
    if (difference.mark != Mark::eds_wrong) continue;
    const std::string frames = frames_text(difference.frames);
    for (Correction correction : difference.corrections) {
      if (!frames.empty()) correction.reason += fmt::format(" ({})", frames);
      overlay.changes.push_back(std::move(correction));
    }
  }
  return overlay;
}

}  // namespace edsc::accept
