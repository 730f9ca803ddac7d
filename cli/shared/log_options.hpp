/// What the commands that read logs share: options and input.
#pragma once

#include <functional>
#include <string>

#include "decode/log/log_line.hpp"
#include "shared/command_line.hpp"
#include "shared/common_options.hpp"
#include "shared/given_nodes.hpp"

namespace edsc {

/// The value of --log-format without the option: the content of the log decides.
inline constexpr const char* automatic_format = "auto";

struct LogSettings : NodesSettings {
  std::string log = "-";
  std::string log_format = automatic_format;
  std::string interface;
  ColorOption color;

  /// The name of the log in messages.
  [[nodiscard]] std::string log_name() const { return log == "-" ? "<stdin>" : log; }
};

/// LOG, --log-format, --interface.
Option add_log_input_options(Command command, LogSettings& settings, const std::string& more = "");

/// The same, and --node, --network, --color.
Option add_log_options(Command command, LogSettings& settings);

/// --log-format, --interface.
void add_log_format_options(Command command, std::string& log_format, std::string& interface);

/// Reads the log to its end or to an interrupt: `use` gets each line or packet, and `before_waiting` is called when no
/// input is available, to flush output. Ends the command if the log cannot be read. The returned function does the same
/// for an error that occurred while reading; call it after the output of what was read.
[[nodiscard]] std::function<void()> read_log(const LogSettings& settings, const std::function<void(LogLine&)>& use,
                                             const std::function<void()>& before_waiting);

}  // namespace edsc
