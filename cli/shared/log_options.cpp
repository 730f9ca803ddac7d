#include "shared/log_options.hpp"

#include <fmt/format.h>

#include <csignal>
#include <cstring>

#include "decode/formats/log_formats.hpp"
#include "eds/number.hpp"
#include "pdo/mapping_fault.hpp"
#include "shared/default_scales.hpp"
#include "shared/exit_code.hpp"
#include "system/input_file.hpp"
#include "system/waiting_signals.hpp"

namespace edsc {
namespace {

constexpr const char* automatic = "auto";

/// `5=drive.eds`, or `axis1.dcf` with its own node-ID.
struct NodeArgument {
  std::optional<std::uint8_t> node_id;
  std::string path;
};

NodeArgument parse_node_argument(const std::string& text) {
  const std::size_t equals = text.find('=');
  const auto number =
      equals == std::string::npos ? std::nullopt : parse_unsigned(std::string_view{text}.substr(0, equals));
  if (!number) return {std::nullopt, text};
  if (*number < 1 || *number > 127) fail(fmt::format("--node {}: a node-ID must be 1 to 127", text));
  return {static_cast<std::uint8_t>(*number), text.substr(equals + 1)};
}

/// Warnings and invalid mappings are for `edsc check`: a PDO is decoded as mapped.
void print_errors(const Diagnostics& diagnostics, const ColorOption& color) {
  Diagnostics errors;
  for (const Diagnostic& one : diagnostics.all()) {
    if (one.severity == Severity::error && !is_mapping_rule(one.rule)) errors.report(one);
  }
  print_findings(errors, color);
}

/// The device of a node. Errors in its EDS are printed; the rest is used.
std::unique_ptr<LoadedDevice> load_node(NodeArgument& argument, const ColorOption& color) {
  Diagnostics diagnostics;
  LoadSettings load;
  load.path = argument.path;
  load.node_id = argument.node_id;
  load.check = false;
  auto loaded = load_device(load, diagnostics);
  print_errors(diagnostics, color);
  if (loaded->unreadable || !loaded->device) fail(fmt::format("--node: {} cannot be used", argument.path));
  if (!argument.node_id) argument.node_id = loaded->device->node_id;
  if (!argument.node_id) {
    fail(fmt::format("--node {0}: the file does not state a node-ID; use --node 5={0}", argument.path));
  }
  return loaded;
}

}  // namespace

Option add_log_options(Command command, LogSettings& settings) {
  const Option log = command.add_option(
      "LOG", settings.log,
      "log of candump, CANoe (asc), PCAN-View (trc), tcpdump or Wireshark; \"-\" for standard input");
  std::vector<std::string> formats{automatic};
  std::string help = "auto: by its content";
  for (const LogFormat* const row : log_formats) {
    formats.emplace_back(row->name);
    help += fmt::format("; {}: {}", row->name, row->description);
  }
  add_choice(command, "--log-format", settings.log_format, formats, help);
  command.add_option("--node", settings.nodes).one_value_each();
  command.add_option("--interface", settings.interface);
  settings.color.add_to(command);
  return log;
}

std::vector<KnownNode> LogNodes::known() const {
  std::vector<KnownNode> nodes;
  for (const auto& [node_id, device] : loaded) {
    nodes.push_back({node_id, &*device->device, device->options.inhibit_time_unit()});
  }
  return nodes;
}

LogNodes load_log_nodes(const LogSettings& settings) {
  LogNodes nodes;
  for (const std::string& text : settings.nodes) {
    NodeArgument argument = parse_node_argument(text);
    auto loaded = load_node(argument, settings.color);
    if (nodes.loaded.contains(*argument.node_id)) {
      fail(fmt::format("--node {}: node {} is given twice", text, *argument.node_id));
    }
    if (const auto& commissioning = loaded->device->information.commissioning) {
      nodes.labels.set_name(*argument.node_id, commissioning->node_name);
    }
    report_default_scales(*argument.node_id, *loaded->device);
    nodes.loaded.emplace(*argument.node_id, std::move(loaded));
  }
  return nodes;
}

std::function<void()> read_log(const LogSettings& settings, const std::function<void(LogLine&)>& use,
                               const std::function<void()>& before_waiting) {
  const InputFile file{settings.log};
  if (!file.error().empty()) fail(fmt::format("{}: {}", settings.log, file.error()));
  // An interrupt ends the log, so that the summary is printed; the second one ends the program.
  const WaitingSignals interrupts({SIGINT}, WaitingSignals::Second::ends_program);
  LogInput input{[&](char* to, std::size_t most) -> std::ptrdiff_t {
    before_waiting();
    return file.read_some(to, most, interrupts);
  }};
  const LogFormat* const named = find_format(settings.log_format);
  const std::string_view conversion = named == nullptr ? conversion_of(input.beginning()) : std::string_view{};
  if (!conversion.empty()) fail(fmt::format("{}: {}", settings.log_name(), conversion));
  const LogFormat& format = named != nullptr ? *named : detect_format(input);
  std::string problem;
  const auto source = format.open(input, problem);
  LogLine line;
  while (source != nullptr && source->next(line)) use(line);
  if (input.error() != 0) problem = std::strerror(input.error());
  if (source == nullptr && input.error() == 0)
    problem = fmt::format("not a log of format {}: {}", format.name, problem);
  return [problem, path = settings.log] {
    if (!problem.empty()) fail(fmt::format("{}: {}", path, problem));
  };
}

}  // namespace edsc
