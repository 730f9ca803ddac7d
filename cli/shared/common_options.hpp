/// Options that many commands have.
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "shared/command_line.hpp"

namespace edsc {

/// An option that accepts one of these words.
Option add_choice(Command command, const char* name, std::string& value, const std::vector<std::string>& words,
                  const char* description);

/// An option or argument whose text `parse` converts to a value; nothing is an error: `"x" is not a data type`.
template <class Value, class Parse>
Option add_parsed(Command command, const std::string& name, Value& value, Parse parse, const std::string& expected,
                  const std::string& description) {
  const auto set = [&value, parse](const std::string& text) {
    if (const auto parsed = parse(text)) value = *parsed;
  };
  return command.add_text_option(name, set, description).check([parse, expected](const std::string& text) {
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

/// `--options FILE` of a device.
void add_options_option(Command command, std::string& path);

/// Help text of `--all`.
inline constexpr const char* all_findings_help =
    "list the findings that follow from others too, and all places of each cause";

/// Help text of `--keep-going`.
inline constexpr const char* keep_going_help =
    "for the EDS of a purchased device: errors become warnings, and what is wrong is left out";

/// A node-ID option, checked to be 1..127.
void add_node_id_option(Command command, std::optional<std::uint8_t>& node_id);

}  // namespace edsc
