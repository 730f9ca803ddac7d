#include "compare/print_changes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>
#include <vector>

#include "diagnostics/place.hpp"
#include "text/markdown.hpp"
#include "text/printable.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

std::vector<std::string_view> broken_by(const Change& change) {
  std::vector<std::string_view> broken;
  if (change.breaks.master) broken.push_back("master");
  if (change.breaks.pdo) broken.push_back("PDO partner");
  if (change.breaks.source) broken.push_back("source code");
  if (change.breaks.storage) broken.push_back("stored values");
  return broken;
}

std::string markdown_row(const Change& change) {
  const std::string name = change.name.empty() ? "" : " " + markdown_text(change.name);
  const std::uint32_t number = origin_of(change.new_position).line;
  const std::string line = number == 0 ? "-" : fmt::format("{}", number);
  const std::vector<std::string_view> broken = broken_by(change);
  return fmt::format("| {}{} | {} | {} | {} | `{}` |\n", change.entry, name, markdown_text(message_of(change)),
                     broken.empty() ? "-" : fmt::format("{}", fmt::join(broken, ", ")), line, change.rule.text());
}

std::string markdown_table(const Changes& changes, bool breaking) {
  std::string rows;
  for (const Change& change : changes.all()) {
    if (change.is_breaking() == breaking) rows += markdown_row(change);
  }
  return "| Entry | Change | Breaks | Line | Kind |\n| --- | --- | --- | ---: | --- |\n" + rows;
}

nlohmann::ordered_json text_or_null(const std::string& text) {
  return text.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
}

nlohmann::ordered_json change_json(const Change& change) {
  nlohmann::ordered_json breaks = nlohmann::ordered_json::array();
  if (change.breaks.master) breaks.push_back("master");
  if (change.breaks.pdo) breaks.push_back("pdo");
  if (change.breaks.source) breaks.push_back("source");
  if (change.breaks.storage) breaks.push_back("storage");
  return {{"kind", change.rule.text()},
          {"entry", change.entry},
          {"name", change.name},
          {"old", text_or_null(change.old_value)},
          {"new", text_or_null(change.new_value)},
          {"breaks", std::move(breaks)},
          {"message", message_of(change)},
          {"old_position", json_of_place(change.old_position)},
          {"new_position", json_of_place(change.new_position)}};
}

}  // namespace

std::string text_of_place(const Position& composed) {
  const Position position = origin_of(composed);
  const std::string file = position.file != nullptr ? position.file->name() : "";
  return position.line == 0 ? file : fmt::format("{}:{}", file, position.line);
}

nlohmann::ordered_json json_of_place(const Position& composed) {
  const Position position = origin_of(composed);
  return {{"file", position.file != nullptr ? position.file->name() : ""},
          {"line", position.line},
          {"column", position.line == 0 ? 0 : position.column}};
}

std::string verdict_text(const Change& change) {
  const std::vector<std::string_view> broken = broken_by(change);
  if (broken.empty()) return "compatible";
  std::string text{"breaks "};
  for (std::size_t i = 0; i < broken.size(); ++i) {
    if (i > 0) text += i + 1 < broken.size() ? ", " : " and ";
    text += broken[i];
  }
  return text;
}

std::string changes_as_text(const Changes& changes, bool colour) {
  std::string text;
  for (const Change& change : changes.all()) {
    const std::string_view start = !colour ? "" : change.is_breaking() ? "\x1B[1;31m" : "\x1B[1;32m";
    const std::string name = change.name.empty() ? "" : fmt::format(" \"{}\"", change.name);
    text +=
        fmt::format("{}: {}{}{}: {}{}: {} [{}] (was {})\n", printable(text_of_place(change.new_position)), start,
                    verdict_text(change), colour ? "\x1B[0m" : "", change.entry, printable(name),
                    printable(message_of(change)), change.rule.text(), printable(text_of_place(change.old_position)));
  }
  return text +
         fmt::format("{} breaking, {} compatible\n", changes.breaking(), changes.all().size() - changes.breaking());
}

std::string changes_as_markdown(const Changes& changes, std::string_view before, std::string_view after) {
  const std::size_t breaking = changes.breaking();
  const std::size_t compatible = changes.all().size() - breaking;
  std::string text = fmt::format("### {} against {}\n\n**{} breaking**, {} compatible\n", markdown_text(after),
                                 markdown_text(before), breaking, compatible);
  if (breaking > 0) text += "\n" + markdown_table(changes, true);
  if (compatible > 0) {
    text += fmt::format("\n<details>\n<summary>{} compatible</summary>\n\n{}\n</details>\n", compatible,
                        markdown_table(changes, false));
  }
  return text;
}

std::string new_file_as_markdown(std::string_view name) { return fmt::format("### {} is new\n", markdown_text(name)); }

nlohmann::ordered_json changes_as_json(const Changes& changes) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Change& change : changes.all()) list.push_back(change_json(change));
  return {{"schema", 2},
          {"changes", std::move(list)},
          {"breaking", changes.breaking()},
          {"compatible", changes.all().size() - changes.breaking()}};
}

}  // namespace edsc
