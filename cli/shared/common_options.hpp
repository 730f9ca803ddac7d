/// Options that many commands have.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// `--color auto|always|never`.
struct ColorOption {
  std::string when = "auto";
  void add_to(CLI::App& command);
  [[nodiscard]] bool on(std::FILE* stream) const;
};

/// Prints findings as text to a stream; `with_allowed` adds the number of allowed findings.
void print_findings(std::FILE* stream, const Diagnostics& diagnostics, const ColorOption& color,
                    bool with_allowed = false);

/// Help text of `--keep-going`.
inline constexpr const char* keep_going_help =
    "for the EDS of a purchased device: errors become warnings, and what is wrong is left out";

/// A node-ID option, checked to be 1..127.
void add_node_id_option(CLI::App& command, std::optional<std::uint8_t>& node_id);

}  // namespace edsc
