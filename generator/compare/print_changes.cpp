#include "compare/print_changes.hpp"

#include <fmt/format.h>

#include "text/source_file.hpp"

namespace edsc {
namespace {

std::string place_text(const Position& position) {
  const std::string file = position.file != nullptr ? position.file->name() : "";
  return position.line == 0 ? file : fmt::format("{}:{}", file, position.line);
}

nlohmann::ordered_json place_json(const Position& position) {
  return {{"file", position.file != nullptr ? position.file->name() : ""},
          {"line", position.line},
          {"column", position.line == 0 ? 0 : position.column}};
}

std::string_view verdict_of(const Change& change) {
  if (change.breaks_master && change.breaks_pdo) return "breaks master and PDO partner";
  if (change.breaks_master) return "breaks master";
  return change.breaks_pdo ? "breaks PDO partner" : "compatible";
}

nlohmann::ordered_json text_or_null(const std::string& text) {
  return text.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
}

nlohmann::ordered_json change_json(const Change& change) {
  nlohmann::ordered_json breaks = nlohmann::ordered_json::array();
  if (change.breaks_master) breaks.push_back("master");
  if (change.breaks_pdo) breaks.push_back("pdo");
  return {{"kind", kind_of(change.id).name},
          {"entry", change.entry},
          {"name", change.name},
          {"old", text_or_null(change.old_value)},
          {"new", text_or_null(change.new_value)},
          {"breaks", std::move(breaks)},
          {"message", message_of(change)},
          {"old_position", place_json(change.old_position)},
          {"new_position", place_json(change.new_position)}};
}

}  // namespace

std::string changes_as_text(const Changes& changes, bool colour) {
  std::string text;
  for (const Change& change : changes.all()) {
    const std::string_view start = !colour ? "" : change.is_breaking() ? "\x1B[1;31m" : "\x1B[1;32m";
    const std::string name = change.name.empty() ? "" : fmt::format(" \"{}\"", change.name);
    text += fmt::format("{}: {}{}{}: {}{}: {} [{}] (was {})\n", place_text(change.new_position), start,
                        verdict_of(change), colour ? "\x1B[0m" : "", change.entry, name, message_of(change),
                        kind_of(change.id).name, place_text(change.old_position));
  }
  return text +
         fmt::format("{} breaking, {} compatible\n", changes.breaking(), changes.all().size() - changes.breaking());
}

nlohmann::ordered_json changes_as_json(const Changes& changes) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Change& change : changes.all()) list.push_back(change_json(change));
  return {{"version", 1},
          {"changes", std::move(list)},
          {"breaking", changes.breaking()},
          {"compatible", changes.all().size() - changes.breaking()}};
}

}  // namespace edsc
