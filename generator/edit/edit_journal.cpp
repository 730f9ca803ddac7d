#include "edit/edit_journal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "change/apply_changes.hpp"
#include "system/checksum.hpp"
#include "system/environment.hpp"
#include "system/read_file.hpp"

namespace edsc::edit {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view begin_record = "begin";
constexpr std::string_view step_record = "step";

/// Any bytes as UTF-8: each byte is the code point with its number.
std::string text_of_bytes(std::string_view bytes) {
  std::string text;
  for (const char one : bytes) {
    const auto byte = static_cast<unsigned char>(one);
    if (byte < 0x80) {
      text += one;
    } else {
      text += static_cast<char>(0xC0 | (byte >> 6));
      text += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return text;
}

std::string bytes_of_text(std::string_view text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto first = static_cast<unsigned char>(text[i]);
    if (first < 0x80 || i + 1 == text.size()) {
      bytes += text[i];
    } else {
      bytes += static_cast<char>(((first & 0x03) << 6) | (static_cast<unsigned char>(text[++i]) & 0x3F));
    }
  }
  return bytes;
}

Json as_json(const EditStep& step) {
  Json edits = Json::array();
  for (const ByteEdit& edit : step.edits) {
    edits.push_back({edit.offset, text_of_bytes(edit.before), text_of_bytes(edit.after)});
  }
  return {{step_record, text_of_bytes(step.name)}, {"edits", std::move(edits)}};
}

EditStep step_of(const Json& json) {
  EditStep step{bytes_of_text(json.at(step_record).get<std::string>()), {}};
  for (const Json& edit : json.at("edits")) {
    step.edits.push_back({edit.at(0).get<std::size_t>(), bytes_of_text(edit.at(1).get<std::string>()),
                          bytes_of_text(edit.at(2).get<std::string>())});
  }
  return step;
}

/// Whether the edits are of these bytes.
bool fits(std::string_view bytes, const std::vector<ByteEdit>& edits) {
  std::size_t next = 0;
  for (const ByteEdit& edit : edits) {
    if (edit.offset < next || edit.offset > bytes.size()) return false;
    if (bytes.substr(edit.offset, edit.before.size()) != edit.before) return false;
    next = edit.offset + edit.before.size();
  }
  return true;
}

/// A beginning with the steps that were read after it.
struct Beginning {
  StoredEdits edits;
  std::string now;         ///< the bytes after the last step
  std::size_t needed = 1;  ///< steps that were written with it
  bool is_broken = true;   ///< by a line that is not a step: what follows is not used

  [[nodiscard]] bool is_complete() const { return edits.steps.size() >= needed; }
};

/// Adds what a line has to the beginnings, of which the last one is read.
void read_record(std::string_view line, std::vector<Beginning>& beginnings) {
  if (line.empty()) return;
  const Json json = Json::parse(line, nullptr, false);
  try {
    if (json.contains(begin_record)) {
      const std::string base = bytes_of_text(json.at(begin_record).get<std::string>());
      beginnings.push_back({{base, {}}, base, json.at("steps").get<std::size_t>(), false});
      return;
    }
    Beginning& last = beginnings.back();
    EditStep step = step_of(json);
    if (!last.is_broken && fits(last.now, step.edits)) {
      last.now = with_edits(last.now, step.edits);
      last.edits.steps.push_back(std::move(step));
      return;
    }
  } catch (const Json::exception&) {  // not a record of this version
  }
  beginnings.back().is_broken = true;
}

}  // namespace

std::string StoredEdits::result() const {
  std::string bytes = base;
  for (const EditStep& step : steps) bytes = with_edits(bytes, step.edits);
  return bytes;
}

EditJournal::EditJournal(const std::string& folder, const std::string& file) {
  if (folder.empty()) {
    problem_ = "there is no home folder for the journal";
    return;
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    problem_ = fmt::format("{}: {}", folder, error.message());
    return;
  }
  constexpr std::size_t max_name = 100;
  const std::string name = std::filesystem::path{file}.filename().string().substr(0, max_name);
  file_ = LockedFile{fmt::format("{}/{}-{:08x}.journal", folder, name, checksum(file))};
}

EditJournal::~EditJournal() { file_.remove_if_empty(); }

std::optional<StoredEdits> EditJournal::stored() const {
  std::string bytes;
  if (!file_ || !read_file(file_.path(), bytes).empty()) return std::nullopt;
  std::vector<Beginning> beginnings(1);
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = bytes.find('\n', at);
    if (end == std::string::npos) break;
    read_record(std::string_view{bytes}.substr(at, end - at), beginnings);
    at = end + 1;
  }
  const auto last =
      std::find_if(beginnings.rbegin(), beginnings.rend(), [](const Beginning& one) { return one.is_complete(); });
  if (last == beginnings.rend() || last->now == last->edits.base) return std::nullopt;
  return std::move(last->edits);
}

void EditJournal::begin(const std::string& base, const std::vector<EditStep>& steps) {
  // The first line end ends a line that was not written completely.
  std::string text = "\n" + Json{{begin_record, text_of_bytes(base)}, {"steps", steps.size()}}.dump() + "\n";
  for (const EditStep& step : steps) text += as_json(step).dump() + "\n";
  file_.append(text);
  has_begun_ = true;
}

void EditJournal::add(const EditStep& step) { file_.append(as_json(step).dump() + "\n"); }

void EditJournal::clear() {
  has_begun_ = false;
  file_.clear();
}

std::string journal_folder() {
  if (const auto state = environment_variable("XDG_STATE_HOME"); state && state->starts_with('/')) {
    return *state + "/edsc";
  }
  const auto home = environment_variable("HOME");
  return home && !home->empty() ? *home + "/.local/state/edsc" : "";
}

}  // namespace edsc::edit
