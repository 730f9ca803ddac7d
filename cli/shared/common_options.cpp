#include "shared/common_options.hpp"

#include <fmt/format.h>

#include <utility>

#include "diagnostics/print.hpp"
#include "diagnostics/unknown_rule.hpp"
#include "system/environment.hpp"
#include "system/standard_streams.hpp"
#include "text/printable.hpp"

namespace edsc {

Option add_choice(Command command, const char* name, std::string& value, const std::vector<std::string>& words,
                  const std::string& detail) {
  return command.add_option(name, value, detail).one_of(words).show_default();
}

void ColorOption::add_to(Command command) { add_choice(command, "--color", when, {"auto", "always", "never"}); }

bool ColorOption::on(std::FILE* stream) const {
  if (when != "auto") return when == "always";
  return is_terminal(stream) && !environment_variable("NO_COLOR") && !is_dumb_terminal();
}

void print_findings(const Diagnostics& diagnostics, const ColorOption& color) {
  std::string text;
  print_text(text, diagnostics, {.colour = color.on(stderr)});
  write_to_stderr(text);
}

Option take_rules(Option option, std::span<const Rule> table, const std::string& list_command) {
  std::vector<std::string> names;
  for (const Rule& rule : table) names.emplace_back(rule.id);
  option.suggest(std::move(names));
  return option.check([table, list_command](const std::string& id) {
    const auto rule = find_rule(table, id);
    if (!rule) return fmt::format("{} (see {})", unknown_rule(id, table), list_command);
    if (id == rule->row().former_id) print_to_stderr("edsc: note: the rule {} is called {} now\n", id, rule->text());
    return std::string{};
  });
}

void add_options_option(Command command, std::string& path) { command.add_option("--options", path); }

void add_node_id_option(Command command, std::optional<std::uint8_t>& node_id) {
  command
      .add_number_option(
          "--node-id", [&node_id](unsigned value) { node_id = static_cast<std::uint8_t>(value); }, "for $NODEID")
      .range(1, 127);
}

}  // namespace edsc
