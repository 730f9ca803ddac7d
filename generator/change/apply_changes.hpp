/// Applies changes to an EDS or DCF. No files, threads or clock.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "change/change.hpp"
#include "change/open_sheet.hpp"
#include "change/text_edit.hpp"

namespace edsc {

/// The new values of [FileInfo] with `--stamp`: FileRevision is raised by one.
struct ChangeStamp {
  std::string date;  ///< `11-29-2026`
  std::string time;  ///< `12:00AM`
};

struct ChangeSettings {
  bool force = false;                ///< apply changes that add an error, or that a PDO or a missing part rejects
  bool utf8 = false;                 ///< an ASCII file may become UTF-8
  std::optional<ChangeStamp> stamp;  ///< nothing: FileRevision and dates remain
};

struct AppliedChanges {
  /// Why nothing was changed, also with `force`: a missing section, a character that the file cannot have.
  std::string problem;
  /// Why changes are rejected without `force`: a removed object that a PDO maps.
  std::vector<std::string> objections;
  /// Errors that the file did not have before. They point into `after`.
  std::vector<Diagnostic> new_errors;
  /// Whether the changes were rejected: `edits` and `bytes` are then empty.
  bool is_rejected = false;

  std::vector<TextEdit> edits;             ///< of the lines of the file before
  std::vector<ByteEdit> bytes;             ///< the same as bytes: `with_edits` applies, `without_edits` takes them back
  std::unique_ptr<const OpenSheet> after;  ///< the changed file; null with a problem
};

/// Applies changes, each to the result of the ones before it. Bytes outside of the edited lines remain. A canonical
/// file remains canonical.
[[nodiscard]] AppliedChanges apply_changes(const OpenSheet& before, std::span<const SheetChange> changes,
                                           const ChangeSettings& settings);

/// The file after, and before, the edits.
[[nodiscard]] std::string with_edits(std::string_view before, std::span<const ByteEdit> edits);
[[nodiscard]] std::string without_edits(std::string_view after, std::span<const ByteEdit> edits);

}  // namespace edsc
