#include "edit/edited_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "change/apply_changes.hpp"
#include "change/change.hpp"
#include "change/open_sheet.hpp"
#include "change/sheet_text.hpp"
#include "compare/compare_devices.hpp"
#include "edit/edited_overlay.hpp"
#include "edit/read_changes.hpp"
#include "edit/sheet_parts.hpp"
#include "eds/number.hpp"
#include "overlay/overlay_file.hpp"
#include "rules/check_rules.hpp"
#include "text/ascii.hpp"
#include "text/counted.hpp"
#include "xdd/read_xdd.hpp"

namespace edsc::edit {
namespace {

std::string name_of(const std::vector<SheetChange>& changes) {
  const std::string first = change_text(changes.front());
  return changes.size() == 1 ? first : fmt::format("{} and {}", first, counted(changes.size() - 1, "more change"));
}

bool is_ascii(std::string_view text) {
  return std::ranges::all_of(text, [](char one) { return static_cast<unsigned char>(one) < 0x80; });
}

Json broken_since(const OpenSheet& before, const OpenSheet& after) {
  Json list = Json::array();
  if (!before.device || !after.device) return list;
  const Changes changes =
      compare_devices(NamedDevice{*before.device, *before.names}, NamedDevice{*after.device, *after.names});
  for (const Change& change : changes.all()) {
    if (!change.is_breaking()) continue;
    Json whom = Json::array();
    if (change.breaks.master) whom.push_back("masters");
    if (change.breaks.pdo) whom.push_back("PDO partners");
    if (change.breaks.source) whom.push_back("source code");
    if (change.breaks.storage) whom.push_back("stored parameters");
    list.push_back({{"message", fmt::format("{}: {}", change.entry, message_of(change))}, {"breaks", std::move(whom)}});
  }
  return list;
}

/// Lines that have no meaning for the device, and are kept.
Json unreadable_lines_of(const OpenSheet& sheet) {
  Json lines = Json::array();
  for (const Diagnostic& one : sheet.diagnostics.all()) {
    if (one.rule != AnyRule{"stray-line"} || one.position.file != sheet.source.get()) continue;
    const auto add = [&](std::uint32_t line) { lines.push_back({{"line", line}, {"text", sheet.source->line(line)}}); };
    add(one.position.line);
    for (const Note& note : one.notes) {
      if (note.position.file == sheet.source.get()) add(note.position.line);
    }
  }
  return lines;
}

/// What does not change with the bytes.
struct SheetContext {
  std::string path;
  Options options;
  std::shared_ptr<const OpenSheet> committed;  ///< null without one
  KnownEntries committed_entries;
};

/// The first request that the file rejects, and why.
EditRejection rejection_of(const OpenSheet& sheet, const RequestedChanges& read, AppliedChanges applied,
                           const ChangeSettings& how) {
  EditRejection rejection;
  rejection.index = read.requests.front();
  for (std::size_t count = 1; count < read.changes.size(); ++count) {
    AppliedChanges first = apply_changes(sheet, std::span{read.changes}.first(count), how);
    if (!first.is_rejected) {
      rejection.index = read.requests[count];
      continue;
    }
    applied = std::move(first);
    rejection.index = read.requests[count - 1];
    break;
  }
  rejection.can_force = applied.problem.empty() || !is_ascii(applied.problem);
  for (const Diagnostic& one : applied.new_errors) {
    rejection.findings.push_back(finding_json(*applied.after, one, nullptr));
  }
  rejection.message = !applied.problem.empty()      ? applied.problem
                      : !applied.objections.empty() ? applied.objections.front()
                      : !applied.new_errors.empty() ? applied.new_errors.front().message
                                                    : "the change is rejected";
  return rejection;
}

class EditedSheet : public EditedFile {
 public:
  EditedSheet(std::shared_ptr<const SheetContext> context, std::shared_ptr<const OpenSheet> sheet)
      : context_{std::move(context)}, sheet_{std::move(sheet)} {}

  [[nodiscard]] std::unique_ptr<const EditedFile> with_bytes(const std::string& bytes,
                                                             std::string& problem) const override;

  [[nodiscard]] ChangedFile changed(const EditRequests& requests) const override {
    const RequestedChanges read = read_requests(requests.list, *sheet_, requests.imported);
    if (!read.problem.empty()) return {EditRejection{read.problem_at, read.problem}, {}, {}, {}};
    if (read.changes.empty()) return {};
    ChangeSettings how;
    how.force = how.utf8 = requests.is_forced;
    AppliedChanges applied = apply_changes(*sheet_, read.changes, how);
    if (applied.is_rejected) return {rejection_of(*sheet_, read, std::move(applied), how), {}, {}, {}};
    if (applied.edits.empty()) return {};
    ChangedFile changed = made_of(std::move(applied));
    if (changed.rejection) changed.rejection->index = read.requests.front();
    changed.step.name = name_of(read.changes);
    return changed;
  }

  [[nodiscard]] EditedFileFacts facts() const override {
    return {sheet_->sheet.is_dcf ? "dcf" : "eds", std::nullopt, context_->committed != nullptr};
  }
  [[nodiscard]] const Diagnostics& diagnostics() const override { return sheet_->diagnostics; }
  [[nodiscard]] Json finding(const Diagnostic& one) const override { return finding_json(*sheet_, one, nullptr); }
  [[nodiscard]] Json broken_since_commit() const override {
    return context_->committed ? broken_since(*context_->committed, *sheet_) : Json::array();
  }
  [[nodiscard]] nlohmann::json requests_for_major_revision() const override {
    const auto revision = number_of(sheet_->sheet.device_info.revision_number);
    if (!sheet_->device || !revision) return nlohmann::json::array();
    constexpr std::uint64_t major = 0x10000;
    nlohmann::json requests = nlohmann::json::array();
    requests.push_back({{"do", "set"},
                        {"section", "DeviceInfo"},
                        {"key", "RevisionNumber"},
                        {"value", fmt::format("0x{:08X}", (*revision / major + 1) * major)}});
    return requests;
  }
  [[nodiscard]] Json unreadable_lines() const override { return unreadable_lines_of(*sheet_); }

  void add_parts(EditParts& parts) const override { add_parts_with({earlier_commit(), nullptr}, true, parts); }

  [[nodiscard]] Json section(std::string_view title) const override {
    const SheetText text{*sheet_->source};
    const TextSection* const section = text.find(title);
    if (section == nullptr) return nullptr;
    Json lines = Json::array();
    const std::uint32_t first = text.first_line(*section);
    for (std::uint32_t line = first; line < section->end; ++line) lines.push_back(sheet_->source->line(line));
    return {{"title", section->title}, {"line", first}, {"lines", std::move(lines)}};
  }

 protected:
  /// The file that the changes make, or why it cannot have them.
  [[nodiscard]] virtual ChangedFile made_of(AppliedChanges applied) const {
    std::string bytes = applied.after->bytes;
    return {{},
            {{}, std::move(applied.bytes)},
            std::move(bytes),
            std::make_unique<EditedSheet>(context_, std::move(applied.after))};
  }

  [[nodiscard]] const std::shared_ptr<const SheetContext>& context() const { return context_; }
  [[nodiscard]] const KnownEntries* earlier_commit() const {
    return context_->committed ? &context_->committed_entries : nullptr;
  }
  /// `can_allow`: a comment of the file can allow a finding.
  void add_parts_with(const EarlierEntries& earlier, bool can_allow, EditParts& parts) const {
    add_objects(*sheet_, earlier, parts);
    add_device(*sheet_, parts);
    add_pdos(*sheet_, parts);
    add_choices(parts);
    add_standard_objects(*sheet_, parts);
    add_findings(*sheet_, can_allow, parts);
  }

 private:
  std::shared_ptr<const SheetContext> context_;
  std::shared_ptr<const OpenSheet> sheet_;
};

/// Shows the device that an overlay makes of its base, and writes changes to the overlay.
class EditedOverlay final : public EditedSheet {
 public:
  EditedOverlay(std::shared_ptr<const SheetContext> context, std::string bytes, OpenOverlay overlay,
                std::shared_ptr<const KnownEntries> base_entries)
      : EditedSheet{std::move(context), overlay.sheet},
        bytes_{std::move(bytes)},
        overlay_{std::move(overlay)},
        base_entries_{std::move(base_entries)} {}

  [[nodiscard]] EditedFileFacts facts() const override {
    return {"overlay", overlay_.base_path, EditedSheet::facts().is_committed};
  }
  void add_parts(EditParts& parts) const override {
    add_parts_with({earlier_commit(), base_entries_.get()}, false, parts);
  }

 private:
  [[nodiscard]] ChangedFile made_of(AppliedChanges applied) const override {
    ChangedOverlay changed = changed_overlay(context()->path, bytes_, overlay_, *applied.after);
    if (!changed.problem.empty()) return {EditRejection{{}, changed.problem}, {}, {}, {}};
    EditStep step{{}, bytes_between(bytes_, changed.bytes)};
    if (step.edits.empty()) {
      return {EditRejection{{},
                            "an overlay cannot hold this change, which changes no value; a finding is allowed in the "
                            "options file"},
              {},
              {},
              {}};
    }
    OpenOverlay after = overlay_;
    after.sheet = std::move(applied.after);
    auto file = std::make_unique<EditedOverlay>(context(), changed.bytes, std::move(after), base_entries_);
    return {{}, std::move(step), std::move(changed.bytes), std::move(file)};
  }

  std::string bytes_;
  OpenOverlay overlay_;
  std::shared_ptr<const KnownEntries> base_entries_;
};

std::unique_ptr<const EditedFile> read_sheet_file(std::shared_ptr<const SheetContext> context, const std::string& bytes,
                                                  std::string& problem) {
  const SourceFile text{context->path, bytes};
  if (is_xml(text)) {
    problem = fmt::format(
        "{0}: XDD and XDC are not changed; \"edsc format {0} -o FILE\" makes an EDS or DCF, and an overlay corrects "
        "the file",
        context->path);
    return nullptr;
  }
  if (trim(text.line(1)).starts_with('{')) {
    problem =
        fmt::format("{}: a JSON file is edited as a text; \"edsc lsp\" shows its findings in an editor", context->path);
    return nullptr;
  }
  if (!is_overlay(text)) {
    std::shared_ptr<const OpenSheet> sheet = open_sheet(context->path, bytes, context->options, SheetChecks::all);
    return std::make_unique<EditedSheet>(std::move(context), std::move(sheet));
  }
  OpenOverlay overlay = open_overlay(context->path, bytes, context->options);
  if (!overlay.problem.empty() || !overlay.base) {
    problem = fmt::format("{}: {}", context->path, overlay.problem);
    return nullptr;
  }
  auto base_entries = std::make_shared<const KnownEntries>(known_entries(*overlay.base));
  return std::make_unique<EditedOverlay>(std::move(context), bytes, std::move(overlay), std::move(base_entries));
}

std::unique_ptr<const EditedFile> EditedSheet::with_bytes(const std::string& bytes, std::string& problem) const {
  return read_sheet_file(context_, bytes, problem);
}

}  // namespace

std::unique_ptr<const EditedFile> open_edited_sheet(EditedFileSettings settings, const std::string& bytes,
                                                    std::string& problem) {
  auto context = std::make_shared<SheetContext>();
  context->path = std::move(settings.path);
  context->options = std::move(settings.options);
  if (settings.committed) {
    const bool is_of_overlay = is_overlay(SourceFile{context->path, bytes});
    context->committed = is_of_overlay
                             ? open_overlay(context->path, *settings.committed, context->options).sheet
                             : open_sheet(context->path, *settings.committed, context->options, SheetChecks::reading);
    if (context->committed) context->committed_entries = known_entries(*context->committed);
  }
  return read_sheet_file(std::move(context), bytes, problem);
}

}  // namespace edsc::edit
