/// An overlay and its bases as one text, whose lines know the file that they come from.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "change/text_edit.hpp"
#include "diagnostics/diagnostics.hpp"
#include "overlay/apply_overlay.hpp"
#include "text/reading_choices.hpp"
#include "text/source_file.hpp"

namespace edsc {

/// Reads a file that an overlay names. Returns null if it cannot be read, with path and reason in `error`.
using ReadBase = std::function<std::unique_ptr<SourceFile>(const std::string& path, const ReadingChoices& choices,
                                                           std::string& error)>;

/// A file and the overlays of its text, the last one outermost.
struct ComposedOverlay {
  std::unique_ptr<SourceFile> text;                      ///< null if a base cannot be used
  bool is_unreadable = false;                            ///< a base could not be read
  std::string base_path;                                 ///< of the file that is not an overlay
  std::vector<std::vector<TextEdit>> edits;              ///< of each overlay, beginning at the base
  std::vector<LineOutcome> outcomes;                     ///< of the lines of the outermost overlay
  std::vector<std::shared_ptr<const SourceFile>> parts;  ///< all files that were read, the outermost overlay first
};

struct ComposeSettings {
  ReadBase read;                ///< empty: from the file system
  bool needs_reasons = false;   ///< report sections of the outermost overlay without a reason
  ReadingChoices choices = {};  ///< of the bases, unless an overlay has other ones
};

/// Maximum number of overlays and bases below an overlay.
inline constexpr std::size_t max_bases = 8;

[[nodiscard]] ComposedOverlay compose_overlay(std::shared_ptr<const SourceFile> overlay,
                                              const ComposeSettings& settings, Diagnostics& diagnostics);

/// The same for an overlay that selects the file by its identity, as `base`, which is not an overlay.
[[nodiscard]] ComposedOverlay compose_overlay(std::shared_ptr<const SourceFile> overlay,
                                              std::shared_ptr<const SourceFile> base, const ComposeSettings& settings,
                                              Diagnostics& diagnostics);

/// The text of an XDD or XDC as `edsc format` converts it; the file itself if it is not XML. Its lines come from the
/// elements of the file.
[[nodiscard]] std::shared_ptr<const SourceFile> text_of_base(std::shared_ptr<const SourceFile> file);

/// `path` beside the file `from`.
[[nodiscard]] std::string path_beside(const std::string& from, std::string_view path);

}  // namespace edsc
