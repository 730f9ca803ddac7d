/// Options that many commands have.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// `--color auto|always|never`, and what it comes to on this stream.
struct ColorOption {
  std::string when = "auto";
  void add_to(CLI::App& command);
  [[nodiscard]] bool on(std::FILE* stream) const;
};

/// Prints findings as text to a stream, `with_allowed` with the number of those that are allowed.
void print_findings(std::FILE* stream, const Diagnostics& diagnostics, const ColorOption& color, bool with_allowed = false);

/// What `--keep-going` does, of each command that has it.
inline constexpr const char* keep_going_help =
    "for the file of another manufacturer: its errors are warnings, and what is wrong is left out";

/// A node-ID option, checked to be 1..127.
void add_node_id_option(CLI::App& command, std::optional<std::uint8_t>& node_id);

}  // namespace edsc
