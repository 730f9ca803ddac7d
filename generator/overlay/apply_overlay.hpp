/// The lines of an overlay as edits of the text of its base.
#pragma once

#include <cstdint>
#include <vector>

#include "change/sheet_text.hpp"
#include "change/text_edit.hpp"
#include "diagnostics/diagnostics.hpp"
#include "overlay/overlay_file.hpp"

namespace edsc {

enum class LineState : std::uint8_t {
  applied,
  obsolete,  ///< the base already has the new value
  stale,     ///< the base has neither the old nor the new value
};

/// The state of a line of an overlay.
struct LineOutcome {
  std::uint32_t line = 0;
  LineState state = LineState::applied;
};

struct OverlayEdits {
  std::vector<TextEdit> edits;
  std::vector<LineOutcome> outcomes;  ///< of all lines with a change, ascending by section and line
};

/// Reports stale and obsolete lines, and changes without effect. With `needs_reasons`, also sections without a reason.
[[nodiscard]] OverlayEdits edits_of(const OverlayFile& overlay, const SheetText& base, bool needs_reasons,
                                    Diagnostics& diagnostics);

}  // namespace edsc
