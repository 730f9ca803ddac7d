/// Overlays that edsc writes: from an edited copy of a file, and for a new version of a base.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "overlay/apply_overlay.hpp"
#include "overlay/overlay_file.hpp"
#include "text/source_file.hpp"

namespace edsc {

struct DerivedOverlay {
  std::string text;
  std::string problem;  ///< what an overlay cannot express; empty if the overlay makes the edited copy of the base
};

/// The overlay that changes `base` to the sections and values of `edited`. Comments, blanks and the order do not
/// matter. `base_path` is the value of Base.
[[nodiscard]] DerivedOverlay derive_overlay(const std::shared_ptr<const SourceFile>& base, const SourceFile& edited,
                                            std::string_view base_path);

/// The bytes of an overlay with another base, without its obsolete lines. `outcomes` are those with the new base.
[[nodiscard]] EditedBytes rebased_overlay(const OverlayFile& overlay, std::string_view bytes,
                                          const std::vector<LineOutcome>& outcomes, std::string_view base_path);

}  // namespace edsc
