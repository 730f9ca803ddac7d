#include "edit/edit_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "change/apply_changes.hpp"
#include "change/line_diff.hpp"
#include "change/sheet_text.hpp"
#include "compare/compare_devices.hpp"
#include "edit/read_changes.hpp"
#include "eds/number.hpp"
#include "overlay/overlay_file.hpp"
#include "rules/check_rules.hpp"
#include "system/path.hpp"
#include "system/write_files.hpp"
#include "text/ascii.hpp"
#include "text/counted.hpp"
#include "xdd/read_xdd.hpp"

namespace edsc::edit {
namespace {

constexpr int bad_request = 400, not_found = 404;

std::string dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string error_body(std::string_view text) { return dumped({{"error", text}}); }

std::string absolute_path(const std::string& path) {
  std::error_code error;
  const std::filesystem::path full = std::filesystem::canonical(to_native(path), error);
  return error ? path : from_native(full);
}

std::string file_name(const std::string& path) { return from_native(to_native(path).filename()); }

/// A request that cannot be understood.
struct BadRequest {
  std::string text;
};

nlohmann::json parsed(std::string_view body) {
  nlohmann::json json = nlohmann::json::parse(body, nullptr, false);
  if (!json.is_object()) throw BadRequest{"the body is not a JSON object"};
  return json;
}

std::uint64_t since_of(const nlohmann::json& request) {
  const nlohmann::json since = request.value("since", nlohmann::json(0U));
  if (!since.is_number_unsigned()) throw BadRequest{"\"since\" is a version"};
  return since.get<std::uint64_t>();
}

bool flag_of(const nlohmann::json& request, const char* name) {
  const nlohmann::json flag = request.value(name, nlohmann::json(false));
  if (!flag.is_boolean()) throw BadRequest{fmt::format("\"{}\" is true or false", name)};
  return flag.get<bool>();
}

std::string name_of(const std::vector<SheetChange>& changes) {
  const std::string first = change_text(changes.front());
  return changes.size() == 1 ? first : fmt::format("{} and {}", first, counted(changes.size() - 1, "more change"));
}

bool is_ascii(std::string_view text) {
  return std::ranges::all_of(text, [](char one) { return static_cast<unsigned char>(one) < 0x80; });
}

/// The findings of one file that another does not have, by rule and message.
Json findings_only_in(const OpenSheet& one, const OpenSheet& other) {
  std::map<std::pair<RuleId, std::string>, std::size_t> known;
  for (const Diagnostic& finding : other.diagnostics.all()) ++known[{finding.rule, finding.message}];
  Json list = Json::array();
  for (const Diagnostic& finding : one.diagnostics.all()) {
    std::size_t& same = known[{finding.rule, finding.message}];
    if (same > 0) {
      --same;
    } else {
      list.push_back(finding_json(one, finding, nullptr));
    }
  }
  return list;
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

Json conflict_json(const EditConflict& conflict) {
  return {{"id", conflict.id},
          {"line", conflict.line},
          {"base", conflict.base},
          {"mine", conflict.mine},
          {"theirs", conflict.theirs}};
}

/// Lines that have no meaning for the device, and are kept.
Json unreadable_lines(const OpenSheet& sheet) {
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

}  // namespace

/// A change that is not made, with what the page shows.
struct EditSession::Rejection {
  Json index = nullptr;  ///< of the request in its list
  std::string message;
  Json findings = Json::array();
  bool can_force = false;

  [[nodiscard]] std::string body() const {
    return dumped(
        {{"rejected", {{"index", index}, {"message", message}, {"findings", findings}, {"can_force", can_force}}}});
  }
};

EditSession::EditSession(SessionSettings settings)
    : settings_{std::move(settings)}, journal_{settings_.journal_folder, absolute_path(settings_.path)} {
  if (journal_.is_taken()) {
    problem_ = fmt::format("{}: another edsc edit has opened the file", settings_.path);
    return;
  }
  open();
}

void EditSession::open() {
  FileBytes file = read_bytes(settings_.path);
  if (!file.error.empty()) {
    problem_ = file.error;
    return;
  }
  if (file.packing != Packing::none) {
    problem_ = fmt::format("{}: a gzip file is not changed; unpack it first", settings_.path);
    return;
  }
  if (!read(file.bytes, problem_)) return;
  saved_ = bytes_ = std::move(file.bytes);
  stored_ = journal_.stored();
  if (settings_.committed) {
    std::string ignored;
    committed_ = overlay_ ? std::move(open_overlay(settings_.path, *settings_.committed, settings_.options).sheet)
                          : open_sheet(settings_.path, *settings_.committed, settings_.options, SheetChecks::reading);
    if (committed_) committed_entries_ = known_entries(*committed_);
  }
  publish();
}

bool EditSession::read(const std::string& bytes, std::string& problem) {
  const SourceFile text{settings_.path, bytes};
  if (is_xml(text)) {
    problem = fmt::format(
        "{0}: XDD and XDC are not changed; \"edsc format {0} -o FILE\" makes an EDS or DCF, and an overlay corrects "
        "the file",
        settings_.path);
    return false;
  }
  if (trim(text.line(1)).starts_with('{')) {
    problem = fmt::format("{}: a JSON file is edited as a text; \"edsc lsp\" shows its findings in an editor",
                          settings_.path);
    return false;
  }
  if (!is_overlay(text)) {
    sheet_ = open_sheet(settings_.path, bytes, settings_.options, SheetChecks::all);
    return true;
  }
  OpenOverlay overlay = open_overlay(settings_.path, bytes, settings_.options);
  if (!overlay.problem.empty() || !overlay.base) {
    problem = fmt::format("{}: {}", settings_.path, overlay.problem);
    return false;
  }
  base_entries_ = known_entries(*overlay.base);
  sheet_ = std::move(overlay.sheet);
  overlay_ = std::move(overlay);
  return true;
}

/// The bytes were read before, as a state of this session.
void EditSession::become(std::string bytes) {
  std::string problem;
  if (!read(bytes, problem)) throw Rejection{nullptr, problem};
  bytes_ = std::move(bytes);
}

std::shared_ptr<const SourceFile> EditSession::text_of(const std::string& bytes) const {
  return std::make_shared<const SourceFile>(settings_.path, bytes);
}

void EditSession::record(const EditStep& step, std::string_view before) {
  if (bytes_ == saved_) {
    journal_.clear();
    return;
  }
  if (journal_.has_begun()) {
    journal_.add(step);
  } else if (before == saved_) {
    journal_.begin(saved_, {step});
  } else {
    journal_.begin(saved_, {{"earlier edits", bytes_between(saved_, before)}, step});
  }
}

void EditSession::take_step(EditStep step, std::string bytes, std::unique_ptr<const OpenSheet> sheet) {
  const std::string before = std::exchange(bytes_, std::move(bytes));
  if (sheet) sheet_ = std::move(sheet);
  record(step, before);
  history_.add(std::move(step));
  message_.clear();
}

void EditSession::check_editable() const {
  if (stored_) throw Rejection{nullptr, "first use or discard the unsaved edits of the last session"};
  if (!conflicts_.empty()) throw Rejection{nullptr, "first decide the conflicts with the other program"};
}

// Requests.

EditAnswer EditSession::post(std::string_view action, std::string_view body) {
  try {
    const nlohmann::json request = parsed(body);
    const std::uint64_t since = since_of(request);
    (void)look_at_disk();
    if (action == "review") return {200, dumped(review())};
    if (action == "import") return {200, dumped(import(request))};
    if (action == "change") {
      change(request);
    } else if (action == "undo") {
      undo();
    } else if (action == "redo") {
      redo();
    } else if (action == "save") {
      save(request);
    } else if (action == "resolve") {
      resolve(request);
    } else if (action == "journal") {
      answer_journal(request);
    } else {
      return {not_found, error_body("unknown request")};
    }
    publish();
    return {200, update(since)};
  } catch (const BadRequest& bad) {
    return {bad_request, error_body(bad.text)};
  } catch (const Rejection& rejection) {
    publish();
    return {200, rejection.body()};
  }
}

void EditSession::change(const nlohmann::json& request) {
  const auto changes = request.find("changes");
  if (changes == request.end() || !changes->is_array()) throw BadRequest{"\"changes\" is a list"};
  check_editable();
  apply(*changes, flag_of(request, "force"));
}

void EditSession::apply(const nlohmann::json& requests, bool is_forced) {
  const RequestedChanges read = read_requests(requests, *sheet_, imported_.get());
  if (!read.problem.empty()) throw Rejection{read.problem_at, read.problem};
  if (read.changes.empty()) return;
  ChangeSettings how;
  how.force = how.utf8 = is_forced;
  AppliedChanges applied = apply_changes(*sheet_, read.changes, how);
  if (applied.is_rejected) {
    Rejection rejection;
    rejection.index = read.requests.front();
    for (std::size_t count = 1; count < read.changes.size(); ++count) {  // the first one that is rejected
      AppliedChanges first = apply_changes(*sheet_, std::span{read.changes}.first(count), how);
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
    throw Rejection{std::move(rejection)};
  }
  if (applied.edits.empty()) return;
  const std::string name = name_of(read.changes);
  if (!overlay_) {
    std::string bytes = applied.after->bytes;
    take_step({name, std::move(applied.bytes)}, std::move(bytes), std::move(applied.after));
    return;
  }
  overlay_->sheet = std::move(sheet_);
  ChangedOverlay changed = changed_overlay(settings_.path, bytes_, *overlay_, *applied.after);
  sheet_ = std::move(overlay_->sheet);
  if (!changed.problem.empty()) throw Rejection{read.requests.front(), changed.problem};
  EditStep step{name, bytes_between(bytes_, changed.bytes)};
  if (step.edits.empty()) {
    throw Rejection{
        read.requests.front(),
        "an overlay cannot hold this change, which changes no value; a finding is allowed in the options file"};
  }
  take_step(std::move(step), std::move(changed.bytes), std::move(applied.after));
}

void EditSession::undo() {
  check_editable();
  const EditStep* const step = history_.to_undo();
  if (step == nullptr) throw Rejection{nullptr, "there is nothing to undo"};
  const EditStep back{"undo: " + step->name, inverse(step->edits)};
  const std::string before = bytes_;
  become(with_edits(bytes_, back.edits));
  history_.undone();
  record(back, before);
}

void EditSession::redo() {
  check_editable();
  const EditStep* const step = history_.to_redo();
  if (step == nullptr) throw Rejection{nullptr, "there is nothing to redo"};
  const std::string before = bytes_;
  become(with_edits(bytes_, step->edits));
  record(*step, before);
  history_.redone();
}

bool EditSession::can_raise_revision() const {
  return sheet_->device && number_of(sheet_->sheet.device_info.revision_number).has_value();
}

Json EditSession::review() const {
  const auto before = overlay_ ? std::move(open_overlay(settings_.path, saved_, settings_.options).sheet)
                               : open_sheet(settings_.path, saved_, settings_.options, SheetChecks::all);
  Json review{{"diff", diff()}, {"new", Json::array()}, {"fixed", Json::array()}, {"broken", Json::array()}};
  if (before) {
    review["new"] = findings_only_in(*sheet_, *before);
    review["fixed"] = findings_only_in(*before, *sheet_);
  }
  if (committed_) review["broken"] = broken_since(*committed_, *sheet_);
  review["can_raise_revision"] = can_raise_revision();
  return review;
}

void EditSession::save(const nlohmann::json& request) {
  check_editable();
  if (flag_of(request, "raise_revision") && can_raise_revision()) {
    constexpr std::uint64_t major = 0x10000;
    const std::uint64_t revision = *number_of(sheet_->sheet.device_info.revision_number);
    apply({{{"do", "set"},
            {"section", "DeviceInfo"},
            {"key", "RevisionNumber"},
            {"value", fmt::format("0x{:08X}", (revision / major + 1) * major)}}},
          false);
  }
  // Another program may have written the file since, or something in which the edits cannot be made.
  if (const FileBytes disk = read_bytes(settings_.path); disk.error.empty() && disk.bytes != saved_) {
    throw Rejection{nullptr, "nothing was written: the file was changed by another program"};
  }
  if (const std::string error = write_files({{settings_.path, bytes_}}); !error.empty()) {
    throw Rejection{nullptr, error};
  }
  saved_ = bytes_;
  journal_.clear();
  message_.clear();
}

void EditSession::resolve(const nlohmann::json& request) {
  const nlohmann::json id = request.value("id", nlohmann::json{});
  const nlohmann::json keep = request.value("keep", nlohmann::json{});
  if (!id.is_number_unsigned() || (keep != "mine" && keep != "theirs")) {
    throw BadRequest{"\"id\" is the number of a conflict, \"keep\" is mine or theirs"};
  }
  MergedEdits resolved =
      resolve_conflict(*text_of(bytes_), bytes_, conflicts_, id.get<std::uint32_t>(), keep == "mine");
  if (!resolved.problem.empty()) throw Rejection{nullptr, resolved.problem};
  become(std::move(resolved.bytes));
  conflicts_ = std::move(resolved.conflicts);
  history_.restart({"the edits before the file was changed", bytes_between(saved_, bytes_)});
  if (conflicts_.empty()) restart_journal();
}

void EditSession::restart_journal() {
  if (const EditStep* const step = history_.to_undo()) {
    journal_.begin(saved_, {*step});
  } else {
    journal_.clear();
  }
}

void EditSession::answer_journal(const nlohmann::json& request) {
  if (!stored_) throw Rejection{nullptr, "no earlier session has left unsaved edits"};
  const bool is_used = flag_of(request, "use");
  const StoredEdits stored = *std::exchange(stored_, std::nullopt);
  if (!is_used) {
    journal_.clear();
    return;
  }
  if (stored.base != saved_) {
    merge(stored.base, stored.result(), saved_);
    return;
  }
  become(stored.result());
  journal_.begin(saved_, stored.steps);
  for (const EditStep& step : stored.steps) history_.add(step);
}

Json EditSession::import(const nlohmann::json& request) {
  const nlohmann::json text = request.value("text", nlohmann::json{});
  if (!text.is_string()) throw BadRequest{"\"text\" is the text of a file"};
  imported_ = std::make_unique<SourceFile>("import", text.get<std::string>());
  const auto sheet = open_sheet("import", text.get<std::string>(), {}, SheetChecks::reading);
  Json objects = Json::array();
  for (const ObjectDescription& one : sheet->sheet.objects) {
    objects.push_back({{"index", fmt::format("{:04X}", one.index)}, {"name", one.parameter_name.text}});
  }
  return {{"objects", std::move(objects)}};
}

// The file on the disk.

bool EditSession::look_at_disk() {
  const FileBytes disk = read_bytes(settings_.path);
  std::string message;
  if (!disk.error.empty()) {
    message = disk.error;
  } else if (disk.packing == Packing::none && disk.bytes != saved_) {
    const std::uint64_t before = version_;
    if (stored_) {
      std::string problem;
      if (read(disk.bytes, problem)) saved_ = bytes_ = disk.bytes;
    } else {
      try {
        merge(saved_, bytes_, disk.bytes);
      } catch (const Rejection& rejection) {
        message_ = rejection.message;
      }
    }
    publish();
    return version_ != before;
  }
  if (message.empty() || message == message_) return false;
  message_ = message;
  publish();
  return true;
}

/// Makes the unsaved edits in the text of the other program. Until conflicts are decided, the journal has the edits as
/// they were.
void EditSession::merge(const std::string& base, const std::string& mine, const std::string& disk) {
  MergedEdits merged = merge_edits(*text_of(base), *text_of(mine), *text_of(disk), disk);
  if (!merged.problem.empty()) throw Rejection{nullptr, merged.problem};
  become(std::move(merged.bytes));
  saved_ = disk;
  conflicts_ = std::move(merged.conflicts);
  history_.restart({"the edits before the file was changed", bytes_between(saved_, bytes_)});
  message_ = "the file was changed by another program";
  if (bytes_ != saved_) message_ += "; your edits of other lines remain";
  if (conflicts_.empty()) restart_journal();
}

// What the page shows.

Json EditSession::status() const {
  const EditStep* const undo = history_.to_undo();
  const EditStep* const redo = history_.to_redo();
  Json conflicts = Json::array();
  for (const EditConflict& one : conflicts_) conflicts.push_back(conflict_json(one));
  Json journal = nullptr;
  if (stored_) {
    Json names = Json::array();
    for (const EditStep& step : stored_->steps) names.push_back(step.name);
    journal = {{"edits", stored_->steps.size()}, {"names", std::move(names)}};
  }
  return {{"dirty", has_unsaved_edits()},
          {"undo", undo == nullptr ? Json(nullptr) : Json(undo->name)},
          {"redo", redo == nullptr ? Json(nullptr) : Json(redo->name)},
          {"edits", history_.done()},
          {"journal", std::move(journal)},
          {"conflicts", std::move(conflicts)},
          {"unreadable", unreadable_lines(*sheet_)},
          {"message", message_}};
}

void EditSession::publish() {
  SheetParts parts;
  Json file{{"name", file_name(settings_.path)},
            {"kind", overlay_               ? "overlay"
                     : sheet_->sheet.is_dcf ? "dcf"
                                            : "eds"},
            {"base", overlay_ ? Json(overlay_->base_path) : Json(nullptr)},
            {"encoding", to_string(text_of(bytes_)->encoding())},
            {"git", committed_ != nullptr}};
  parts.set("file", file);
  parts.set("status", status());
  add_objects(*sheet_, {committed_ ? &committed_entries_ : nullptr, overlay_ ? &base_entries_ : nullptr}, parts);
  add_device(*sheet_, parts);
  add_pdos(*sheet_, parts);
  add_choices(parts);
  add_standard_objects(*sheet_, parts);
  add_findings(*sheet_, !overlay_, parts);

  const std::uint64_t next = version_ + 1;
  bool is_changed = false;
  for (const auto& [name, text] : parts.texts()) {
    Part& part = parts_[name];
    if (part.text == text) continue;
    part = {text, next};
    removed_.erase(name);
    is_changed = true;
  }
  for (auto part = parts_.begin(); part != parts_.end();) {
    if (parts.texts().contains(part->first)) {
      ++part;
      continue;
    }
    removed_[part->first] = next;
    part = parts_.erase(part);
    is_changed = true;
  }
  if (is_changed) version_ = next;
}

std::string EditSession::update(std::uint64_t since) const {
  if (since > version_) since = 0;  // of an earlier server
  std::string parts;
  for (const auto& [name, part] : parts_) {
    if (part.version > since) parts += fmt::format("{}\"{}\":{}", parts.empty() ? "" : ",", name, part.text);
  }
  std::string removed;
  for (const auto& [name, version] : removed_) {
    if (version > since) removed += fmt::format("{}\"{}\"", removed.empty() ? "" : ",", name);
  }
  return fmt::format("{{\"version\":{},\"parts\":{{{}}},\"removed\":[{}]}}", version_, parts, removed);
}

EditAnswer EditSession::section(std::string_view title) const {
  const SheetText text{*sheet_->source};
  const TextSection* const section = text.find(title);
  if (section == nullptr) return {not_found, error_body("the file does not have this section")};
  Json lines = Json::array();
  const std::uint32_t first = text.first_line(*section);
  for (std::uint32_t line = first; line < section->end; ++line) lines.push_back(sheet_->source->line(line));
  return {200, dumped({{"title", section->title}, {"line", first}, {"lines", std::move(lines)}})};
}

std::string EditSession::diff_json() const { return dumped({{"diff", diff()}}); }

std::string EditSession::diff() const {
  const auto before = text_of(saved_);
  return unified_diff(*before, line_edits(*before, *text_of(bytes_)), file_name(settings_.path));
}

}  // namespace edsc::edit
