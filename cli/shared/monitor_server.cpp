#include "shared/monitor_server.hpp"

#include <utility>
#include <vector>

#include "shared/exit_code.hpp"
#include "shared/output.hpp"
#include "text/printable.hpp"
#include "web/request_guard.hpp"

namespace edsc {

Option add_web_option(Command command, std::optional<ListenAddress>& address) {
  return command.add_text_option("--web", [&address](const std::string& text) { address = parse_listen_address(text); })
      .optional_value()
      .show_default("127.0.0.1:8080")
      .check(listen_address_problem);
}

MonitorServer::MonitorServer(const ListenAddress& address, const std::string& bus) {
  try {
    server_.emplace(address, monitor_page(bus), rows_);
  } catch (const CannotListen& problem) {
    fail(problem.what());
  }
  if (!RequestGuard::is_loopback(address.host)) {
    print_to_stderr("edsc: whoever sees this URL in the network can read the bus; the connection is not encrypted\n");
  }
  if (!has_plots()) print_to_stderr("edsc: this program was built without uPlot: the page has no plots\n");
  print_visibly(stdout, "{}\n", server_->url());
  flush_output();
}

void MonitorServer::add(const Message& message, std::int64_t now_us) {
  if (message.service == Service::emcy) emergencies_.add(message, now_us);
}

void MonitorServer::publish(const MonitorState& state, std::optional<unsigned> bit_rate, std::int64_t now_us) {
  std::vector<LiveRow> changed = monitor_rows(state, bit_rate, now_us);
  std::vector<std::string> removed;
  emergencies_.take(changed, removed);
  rows_.publish(std::move(changed), removed);
}

}  // namespace edsc
