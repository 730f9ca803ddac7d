#include "edit/edit_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "change/apply_changes.hpp"
#include "change/line_diff.hpp"
#include "change/open_sheet.hpp"
#include "rules/check_rules.hpp"
#include "system/path.hpp"
#include "system/write_files.hpp"

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

/// The findings of one state of a file that another does not have, by rule and message.
Json findings_only_in(const EditedFile& one, const EditedFile& other) {
  std::map<std::pair<RuleId, std::string>, std::size_t> known;
  for (const Diagnostic& finding : other.diagnostics().all()) ++known[{finding.rule, finding.message}];
  Json list = Json::array();
  for (const Diagnostic& finding : one.diagnostics().all()) {
    std::size_t& same = known[{finding.rule, finding.message}];
    if (same > 0) {
      --same;
    } else {
      list.push_back(one.finding(finding));
    }
  }
  return list;
}

std::string rejection_body(const EditRejection& rejection) {
  return dumped({{"rejected",
                  {{"index", rejection.index ? Json(*rejection.index) : Json(nullptr)},
                   {"message", rejection.message},
                   {"findings", rejection.findings},
                   {"can_force", rejection.can_force}}}});
}

Json conflict_json(const EditConflict& conflict) {
  return {{"id", conflict.id},
          {"line", conflict.line},
          {"base", conflict.base},
          {"mine", conflict.mine},
          {"theirs", conflict.theirs}};
}

}  // namespace

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
  file_ = open_edited_file({settings_.path, settings_.options, settings_.committed}, file.bytes, problem_);
  if (!file_) return;
  saved_ = bytes_ = std::move(file.bytes);
  stored_ = journal_.stored();
  publish();
}

/// The bytes were read before, as a state of this session.
void EditSession::become(std::string bytes) {
  std::string problem;
  auto file = file_->with_bytes(bytes, problem);
  if (!file) throw EditRejection{{}, problem};
  file_ = std::move(file);
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

void EditSession::take_step(ChangedFile changed) {
  const std::string before = std::exchange(bytes_, std::move(changed.bytes));
  file_ = std::move(changed.after);
  record(changed.step, before);
  history_.add(std::move(changed.step));
  message_.clear();
}

void EditSession::check_editable() const {
  if (stored_) throw EditRejection{{}, "first use or discard the unsaved edits of the last session"};
  if (!conflicts_.empty()) throw EditRejection{{}, "first decide the conflicts with the other program"};
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
  } catch (const EditRejection& rejection) {
    publish();
    return {200, rejection_body(rejection)};
  }
}

void EditSession::change(const nlohmann::json& request) {
  const auto changes = request.find("changes");
  if (changes == request.end() || !changes->is_array()) throw BadRequest{"\"changes\" is a list"};
  check_editable();
  apply(*changes, flag_of(request, "force"));
}

void EditSession::apply(const nlohmann::json& requests, bool is_forced) {
  ChangedFile changed = file_->changed({requests, is_forced, imported_.get()});
  if (changed.rejection) throw EditRejection{*std::move(changed.rejection)};
  if (!changed.step.edits.empty()) take_step(std::move(changed));
}

void EditSession::undo() {
  check_editable();
  const EditStep* const step = history_.to_undo();
  if (step == nullptr) throw EditRejection{{}, "there is nothing to undo"};
  const EditStep back{"undo: " + step->name, inverse(step->edits)};
  const std::string before = bytes_;
  become(with_edits(bytes_, back.edits));
  history_.undone();
  record(back, before);
}

void EditSession::redo() {
  check_editable();
  const EditStep* const step = history_.to_redo();
  if (step == nullptr) throw EditRejection{{}, "there is nothing to redo"};
  const std::string before = bytes_;
  become(with_edits(bytes_, step->edits));
  record(*step, before);
  history_.redone();
}

Json EditSession::review() const {
  std::string ignored;
  const auto before = file_->with_bytes(saved_, ignored);
  Json review{{"diff", diff()}, {"new", Json::array()}, {"fixed", Json::array()}};
  if (before) {
    review["new"] = findings_only_in(*file_, *before);
    review["fixed"] = findings_only_in(*before, *file_);
  }
  review["broken"] = file_->broken_since_commit();
  review["can_raise_revision"] = !file_->requests_for_major_revision().empty();
  return review;
}

void EditSession::save(const nlohmann::json& request) {
  check_editable();
  if (flag_of(request, "raise_revision")) apply(file_->requests_for_major_revision(), false);
  // Another program may have written the file since, or something in which the edits cannot be made.
  if (const FileBytes disk = read_bytes(settings_.path); disk.error.empty() && disk.bytes != saved_) {
    throw EditRejection{{}, "nothing was written: the file was changed by another program"};
  }
  if (const std::string error = write_files({{settings_.path, bytes_}}); !error.empty()) {
    throw EditRejection{{}, error};
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
  if (!resolved.problem.empty()) throw EditRejection{{}, resolved.problem};
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
  if (!stored_) throw EditRejection{{}, "no earlier session has left unsaved edits"};
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
      if (auto file = file_->with_bytes(disk.bytes, problem)) {
        file_ = std::move(file);
        saved_ = bytes_ = disk.bytes;
      }
    } else {
      try {
        // With conflicts, the bytes have the lines of the other program in place of edits.
        const bool has_conflicts = !conflicts_.empty();
        const std::string base = has_conflicts ? conflict_base_ : saved_;
        const std::string mine = has_conflicts ? conflict_mine_ : bytes_;
        merge(base, mine, disk.bytes);
      } catch (const EditRejection& rejection) {
        message_ = rejection.message;
      }
    }
    publish();
    return version_ != before;
  }
  const bool is_outdated = file_->is_outdated();
  if (!is_outdated && (message.empty() || message == message_)) return false;
  const std::uint64_t before = version_;
  if (is_outdated) become(bytes_);
  if (!message.empty()) message_ = message;
  publish();
  return version_ != before;
}

/// Makes the unsaved edits in the text of the other program. Until conflicts are decided, the journal has the edits as
/// they were.
void EditSession::merge(const std::string& base, const std::string& mine, const std::string& disk) {
  MergedEdits merged = merge_edits(*text_of(base), *text_of(mine), *text_of(disk), disk);
  if (!merged.problem.empty()) throw EditRejection{{}, merged.problem};
  become(std::move(merged.bytes));
  saved_ = disk;
  conflicts_ = std::move(merged.conflicts);
  if (!conflicts_.empty()) {
    conflict_base_ = base;
    conflict_mine_ = mine;
  }
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
          {"unreadable", file_->unreadable_lines()},
          {"message", message_}};
}

void EditSession::publish() {
  EditParts parts;
  const EditedFileFacts facts = file_->facts();
  parts.set("file", {{"name", file_name(settings_.path)},
                     {"kind", facts.kind},
                     {"base", facts.base ? Json(*facts.base) : Json(nullptr)},
                     {"encoding", to_string(text_of(bytes_)->encoding())},
                     {"git", facts.is_committed}});
  parts.set("status", status());
  file_->add_parts(parts);

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
  const Json section = file_->section(title);
  if (section.is_null()) return {not_found, error_body("the file does not have this section")};
  return {200, dumped(section)};
}

std::string EditSession::diff_json() const { return dumped({{"diff", diff()}}); }

std::string EditSession::diff() const {
  const auto before = text_of(saved_);
  return unified_diff(*before, line_edits(*before, *text_of(bytes_)), file_name(settings_.path));
}

}  // namespace edsc::edit
