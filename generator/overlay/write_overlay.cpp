#include "overlay/write_overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "overlay/overlay_keys.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

/// A reason may quote a file: a comment is one line.
std::string reason_line(std::string_view text) { return fmt::format("; {}\n", printable(text)); }

}  // namespace

std::string overlay_line(const OverlayChange& change) {
  if (change.key == remove_key || !change.old_text) return fmt::format("{}={}", change.key, change.new_text);
  const std::string text = fmt::format("{}={} {} {}", change.key, *change.old_text, arrow, change.new_text);
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

std::string overlay_text(const NewOverlay& overlay) {
  std::string text;
  for (const std::string& remark : overlay.remarks) text += reason_line(remark);
  text += fmt::format("[{}]\nVersion=1\nBase={}\n", overlay_section, overlay.base);
  for (const auto& [key, value] : overlay.header) text += fmt::format("{}={}\n", key, value);
  std::vector<std::string_view> sections;
  std::map<std::string_view, std::vector<const OverlayChange*>> by_section;
  for (const OverlayChange& change : overlay.changes) {
    std::vector<const OverlayChange*>& changes = by_section[change.section];
    if (changes.empty()) sections.push_back(change.section);
    changes.push_back(&change);
  }
  for (const std::string_view section : sections) {
    text += fmt::format("\n[{}]\n", section);
    std::string_view reason;
    for (const OverlayChange* const change : by_section[section]) {
      if (change->reason != reason) text += reason_line(change->reason);
      reason = change->reason;
      text += overlay_line(*change) + '\n';
    }
  }
  return text;
}

}  // namespace edsc
