/// What the commands that read logs share: options, EDS files of the nodes, and input.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "decode/decoder.hpp"
#include "decode/log/log_line.hpp"
#include "decode/log/print_message.hpp"
#include "load/load_device.hpp"
#include "shared/command_line.hpp"
#include "shared/common_options.hpp"

namespace edsc {

struct LogSettings {
  std::string log = "-";
  std::string log_format = "auto";
  std::vector<std::string> nodes;
  std::string interface;
  ColorOption color;

  /// The name of the log in messages.
  [[nodiscard]] std::string log_name() const { return log == "-" ? "<stdin>" : log; }
};

/// LOG, --log-format, --node, --interface, --color.
Option add_log_options(Command command, LogSettings& settings);

struct LogNodes {
  std::map<std::uint8_t, std::unique_ptr<LoadedDevice>> loaded;  ///< by node-ID
  NodeLabels labels;

  [[nodiscard]] std::vector<KnownNode> known() const;
};

/// The devices of --node. Errors in their EDS are printed; ends the command if one cannot be used.
[[nodiscard]] LogNodes load_log_nodes(const LogSettings& settings);

/// Reads the log to its end or to an interrupt: `use` gets each line or packet, and `before_waiting` is called when no
/// input is available, to flush output. Ends the command if the log cannot be read. The returned function does the same
/// for an error that occurred while reading; call it after the output of what was read.
[[nodiscard]] std::function<void()> read_log(const LogSettings& settings, const std::function<void(LogLine&)>& use,
                                             const std::function<void()>& before_waiting);

}  // namespace edsc
