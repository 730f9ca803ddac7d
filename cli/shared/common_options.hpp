/// Options that many commands have.
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "rules/rule.hpp"
#include "shared/command_line.hpp"

namespace edsc {

/// An option that accepts one of these words.
Option add_choice(Command command, const char* name, std::string& value, const std::vector<std::string>& words,
                  const std::string& detail = "");

/// An option or argument whose text `parse` converts to a value; nothing is an error: `"x" is not a data type`.
template <class Value, class Parse>
Option add_parsed(Command command, const std::string& name, Value& value, Parse parse, const std::string& expected,
                  const std::string& detail = "") {
  const auto set = [&value, parse](const std::string& text) {
    if (const auto parsed = parse(text)) value = *parsed;
  };
  return command.add_text_option(name, set, detail).check([parse, expected](const std::string& text) {
    return parse(text) ? std::string{} : "\"" + text + "\" is not " + expected;
  });
}

/// `--color auto|always|never`.
struct ColorOption {
  std::string when = "auto";
  void add_to(Command command);
  [[nodiscard]] bool on(std::FILE* stream) const;
};

/// Prints findings as text to standard error.
void print_findings(const Diagnostics& diagnostics, const ColorOption& color);

/// Accepts the ids of the rules in this table, and completes them. A former id is accepted with a note.
Option take_rules(Option option, std::span<const Rule> table, const std::string& list_command);

/// `--options FILE` of a device.
void add_options_option(Command command, std::string& path);

/// A node-ID option, checked to be 1..127.
void add_node_id_option(Command command, std::optional<std::uint8_t>& node_id);

}  // namespace edsc
