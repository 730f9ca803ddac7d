#include "shared/common_options.hpp"

#include <unistd.h>

#include <cstdlib>

#include "diagnostics/print.hpp"

namespace edsc {

void ColorOption::add_to(CLI::App& command) {
  command.add_option("--color", when, "colour the findings: auto (on a terminal, NO_COLOR unset), always, never")
      ->check(CLI::IsMember({"auto", "always", "never"}))
      ->capture_default_str();
}

bool ColorOption::on(std::FILE* stream) const {
  if (when != "auto") return when == "always";
  return isatty(fileno(stream)) != 0 && std::getenv("NO_COLOR") == nullptr;
}

void print_findings(std::FILE* stream, const Diagnostics& diagnostics, const ColorOption& color, bool with_allowed) {
  print_text(stream, diagnostics, color.on(stream), with_allowed);
}

void add_node_id_option(CLI::App& command, std::optional<std::uint8_t>& node_id) {
  command
      .add_option_function<unsigned>(
          "--node-id", [&node_id](unsigned value) { node_id = static_cast<std::uint8_t>(value); },
          "evaluate $NODEID formulas for this node-ID (1..127)")
      ->check(CLI::Range(1, 127));
}

}  // namespace edsc
