#include "change/apply_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "change/change_applier.hpp"
#include "change/line_diff.hpp"
#include "diagnostics/new_errors.hpp"
#include "eds/number.hpp"

namespace edsc {
namespace {

constexpr std::string_view file_info = "FileInfo";

void stamp(const ChangeStamp& stamp, const OpenSheet& before, ChangeApplier& applier) {
  applier.apply(SetValue{std::string{file_info}, "ModificationDate", stamp.date});
  applier.apply(SetValue{std::string{file_info}, "ModificationTime", stamp.time});
  const auto revision = number_of(before.sheet.file_info.file_revision);
  applier.apply(SetValue{std::string{file_info}, "FileRevision", fmt::format("{}", revision.value_or(0) + 1)});
}

std::vector<Diagnostic> new_errors_in(const OpenSheet& after, const OpenSheet& before, bool is_renamed) {
  if (after.diagnostics.errors() == 0) return {};
  if (before.checks == SheetChecks::all) return new_errors(after.diagnostics, before.diagnostics, is_renamed);
  const auto checked = open_sheet(before.source->name(), before.bytes, before.options, SheetChecks::all);
  return new_errors(after.diagnostics, checked->diagnostics, is_renamed);
}

/// Sets the edits that make a text of the file, and the file after. Returns false with a problem.
bool set_result(const OpenSheet& before, const SourceFile& changed, bool allow_utf8, AppliedChanges& applied) {
  applied.edits = line_edits(*before.source, changed);
  EditedBytes edited = edited_bytes(before.bytes, before.source->encoding(), applied.edits, allow_utf8);
  if (!edited.error.empty()) {
    applied = {};
    applied.problem = std::move(edited.error);
    applied.is_rejected = true;
    return false;
  }
  applied.bytes = std::move(edited.changes);
  applied.after = open_sheet(before.source->name(), std::move(edited.bytes), before.options, SheetChecks::all);
  return true;
}

}  // namespace

AppliedChanges apply_changes(const OpenSheet& before, std::span<const SheetChange> changes,
                             const ChangeSettings& settings) {
  AppliedChanges applied;
  ChangeApplier applier(before.source);
  for (const SheetChange& change : changes) applier.apply(change);
  if (settings.stamp) stamp(*settings.stamp, before, applier);
  const std::shared_ptr<const SourceFile> changed = applier.finish();
  applied.problem = applier.problem();
  applied.objections = applier.objections();
  applied.is_rejected = !applied.problem.empty() || (!applied.objections.empty() && !settings.force);
  if (!applied.problem.empty()) return applied;

  if (!set_result(before, *changed, settings.utf8, applied)) return applied;
  // The file after is usually canonical if the one before is.
  if (applied.after->device && !is_canonical(*applied.after) && is_canonical(before)) {
    const SourceFile canonical{changed->name(), canonical_text(*applied.after), Packing::none,
                               applied.after->source->choices()};
    if (!set_result(before, canonical, settings.utf8, applied)) return applied;
  }
  const bool is_renamed = std::ranges::any_of(
      changes, [](const SheetChange& change) { return std::holds_alternative<RenamePart>(change); });
  applied.new_errors = new_errors_in(*applied.after, before, is_renamed);
  applied.is_rejected = applied.is_rejected || (!applied.new_errors.empty() && !settings.force);
  if (applied.is_rejected) {
    applied.edits.clear();
    applied.bytes.clear();
  }
  return applied;
}

std::string with_edits(std::string_view before, std::span<const ByteEdit> edits) {
  std::string after;
  std::size_t next = 0;
  for (const ByteEdit& edit : edits) {
    after += before.substr(next, edit.offset - next);
    after += edit.after;
    next = edit.offset + edit.before.size();
  }
  after += before.substr(next);
  return after;
}

std::string without_edits(std::string_view after, std::span<const ByteEdit> edits) {
  std::string before;
  std::size_t next = 0;
  for (const ByteEdit& edit : edits) {
    const std::size_t kept = edit.offset - before.size();
    before += after.substr(next, kept);
    before += edit.before;
    next += kept + edit.after.size();
  }
  before += after.substr(next);
  return before;
}

}  // namespace edsc
