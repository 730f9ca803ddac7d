#include "shared/log_options.hpp"

#include <fmt/format.h>

#include <csignal>
#include <cstring>

#include "decode/formats/log_formats.hpp"
#include "shared/exit_code.hpp"
#include "system/input_file.hpp"
#include "system/waiting_signals.hpp"

namespace edsc {

void add_log_format_options(Command command, std::string& log_format, std::string& interface) {
  std::vector<std::string> formats{automatic_format};
  std::string help = "auto: by its content";
  for (const LogFormat* const row : log_formats) {
    formats.emplace_back(row->name);
    help += fmt::format("; {}: {}", row->name, row->description);
  }
  add_choice(command, "--log-format", log_format, formats, help);
  command.add_option("--interface", interface);
}

Option add_log_input_options(Command command, LogSettings& settings, const std::string& more) {
  const Option log = command.add_option(
      "LOG", settings.log,
      "log of candump, CANoe (asc), PCAN-View (trc), tcpdump or Wireshark; \"-\" for standard input" + more);
  add_log_format_options(command, settings.log_format, settings.interface);
  return log;
}

Option add_log_options(Command command, LogSettings& settings) {
  const Option log = add_log_input_options(command, settings);
  add_nodes_options(command, settings);
  settings.color.add_to(command);
  return log;
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
