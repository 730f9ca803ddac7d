/// The text of an overlay that edsc writes.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace edsc {

/// `Key=old => new` in a section of the base.
struct OverlayChange {
  std::string section;                  ///< `1018sub1`
  std::string key;                      ///< `DefaultValue`; `Remove` with the value 1: the whole section
  std::optional<std::string> old_text;  ///< as written in the base; nothing: the section does not have the key
  std::string new_text;
  std::string reason = {};  ///< one line, the comment before the key
};

struct NewOverlay {
  std::vector<std::string> remarks = {};                         ///< the comment at the beginning
  std::string base = {};                                         ///< relative to the overlay
  std::vector<std::pair<std::string, std::string>> header = {};  ///< further keys of [Overlay]
  std::vector<OverlayChange> changes = {};
};

/// The sections are in the order of their first changes.
[[nodiscard]] std::string overlay_text(const NewOverlay& overlay);

/// `DefaultValue=0x41 => 0x42`
[[nodiscard]] std::string overlay_line(const OverlayChange& change);

}  // namespace edsc
