/// The page of the monitor, served to browsers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "decode/message.hpp"
#include "monitor/monitor_state.hpp"
#include "server/listen_address.hpp"
#include "shared/command_line.hpp"
#include "web/live_rows.hpp"
#include "web/monitor_page.hpp"
#include "web/web_server.hpp"

namespace edsc {

/// `--web HOST:PORT`
Option add_web_option(Command command, std::optional<ListenAddress>& address);

class MonitorServer {
 public:
  /// `bus`: its name on the page. Prints the URL. Ends the command if the address cannot be used.
  MonitorServer(const ListenAddress& address, const std::string& bus);

  /// New information: the page lists EMCYs.
  void add(const Message& message, std::int64_t now_us);
  /// Call ten times a second. `bit_rate`: in kbit/s, for the load.
  void publish(const MonitorState& state, std::optional<unsigned> bit_rate, std::int64_t now_us);

 private:
  LiveRows rows_;
  EmergencyLog emergencies_;
  std::optional<WebServer> server_;
};

}  // namespace edsc
