#include "change/apply_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>
#include <variant>

#include "change/change_applier.hpp"
#include "change/line_diff.hpp"
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

/// The errors of a file that another one does not have. A renamed object changes the text of its errors: if one was
/// renamed, those of a rule are new only as far as there are more of them.
std::vector<Diagnostic> errors_only_in(const OpenSheet& after, const OpenSheet& before, bool is_renamed) {
  std::map<std::pair<RuleId, std::string>, std::size_t> old_errors;
  std::map<RuleId, std::int64_t> more;
  for (const Diagnostic& one : before.diagnostics.all()) {
    if (one.severity != Severity::error) continue;
    ++old_errors[{one.rule, one.message}];
    --more[one.rule];
  }
  std::vector<Diagnostic> errors;
  for (const Diagnostic& one : after.diagnostics.all()) {
    if (one.severity == Severity::error) ++more[one.rule];
  }
  for (const Diagnostic& one : after.diagnostics.all()) {
    if (one.severity != Severity::error || (is_renamed && more[one.rule] <= 0)) continue;
    std::size_t& same = old_errors[{one.rule, one.message}];
    if (same > 0) {
      --same;
    } else {
      errors.push_back(one);
    }
  }
  return errors;
}

std::vector<Diagnostic> new_errors(const OpenSheet& after, const OpenSheet& before, bool is_renamed) {
  if (after.diagnostics.errors() == 0) return {};
  if (before.checks == SheetChecks::all) return errors_only_in(after, before, is_renamed);
  return errors_only_in(after, *open_sheet(before.source->name(), before.bytes, before.options, SheetChecks::all),
                        is_renamed);
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
  applied.new_errors = new_errors(*applied.after, before, is_renamed);
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
