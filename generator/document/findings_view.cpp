#include <fmt/format.h>

#include "compare/print_changes.hpp"
#include "diagnostics/place.hpp"
#include "document/views.hpp"
#include "system/path.hpp"
#include "text/counted.hpp"

namespace edsc::document {
namespace {

std::string line_text(const Position& composed) {
  const Position position = origin_of(composed);
  return position.line == 0 ? std::string{} : fmt::format("{}", position.line);
}

std::string place_text(const Position& composed) {
  const Position position = origin_of(composed);
  const std::string file = position.file == nullptr ? std::string{} : std::string{file_name_of(position.file->name())};
  return position.line == 0 ? file : fmt::format("{}:{}", file, position.line);
}

/// `6041h` if the change is one of an object, else empty.
std::string object_of(const Change& change) {
  const bool is_object = change.entry.size() >= 5 && change.entry[4] == 'h';
  return is_object ? change.entry.substr(0, 5) : "";
}

}  // namespace

void add_findings(const Diagnostics& diagnostics, Json& view) {
  Json rows = Json::array();
  for (const Diagnostic& one : diagnostics.all()) {
    std::string message = one.message;
    if (one.places > 1) message += fmt::format(" ({})", counted(one.places, "place"));
    rows.push_back({{"severity", to_string(one.severity)},
                    {"rule", one.rule.text()},
                    {"message", std::move(message)},
                    {"place", place_text(one.position)}});
  }
  for (const Diagnostics::Omitted& one : diagnostics.omitted()) {
    rows.push_back({{"severity", to_string(one.severity)},
                    {"rule", one.rule.text()},
                    {"message", fmt::format("{} more of this kind", one.count)},
                    {"place", place_text(Position{one.file})}});
  }
  std::string sentence = fmt::format("{}, {}, {}", counted(diagnostics.errors(), "error"),
                                     counted(diagnostics.warnings(), "warning"), counted(diagnostics.notes(), "note"));
  if (diagnostics.suppressed_findings() > 0) sentence += fmt::format(", {} allowed", diagnostics.suppressed_findings());
  view["findings_sentence"] = sentence;
  view["has_findings"] = !rows.empty();
  view["findings"] = std::move(rows);
}

void add_changes(const ComparedWith* compared, Json& view) {
  view["compared"] = compared != nullptr;
  view["has_changes"] = compared != nullptr && !compared->changes.all().empty();
  if (compared == nullptr) return;
  Json rows = Json::array();
  for (const Change& change : compared->changes.all()) {
    const bool is_in_page = change.rule != ChangeRule{"object-removed"};
    rows.push_back({{"entry", change.entry},
                    {"name", shown(change.name)},
                    {"href", is_in_page ? shown(object_of(change)) : Json(nullptr)},
                    {"message", message_of(change)},
                    {"verdict", verdict_text(change)},
                    {"class", change.is_breaking() ? "breaking" : "compatible"},
                    {"kind", change.rule.text()},
                    {"line", shown(line_text(change.new_position))}});
  }
  const std::size_t breaking = compared->changes.breaking();
  view["compared_with"] = compared->name;
  view["changes_sentence"] = fmt::format("{} breaking, {} compatible", breaking, rows.size() - breaking);
  view["changes"] = std::move(rows);
}

}  // namespace edsc::document
