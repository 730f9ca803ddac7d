#include <fmt/format.h>

#include <canopen/nmt_master/nmt_master.hpp>

#include "commands/commands.hpp"
#include "online/error_control_watch.hpp"
#include "online/live_bus.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_options.hpp"
#include "shared/node_names.hpp"
#include "shared/with_bus.hpp"
#include "text/duration.hpp"
#include "values/nmt_text.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc nmt socketcan:can0 start all                     all nodes Operational
  edsc nmt socketcan:can0 pre-operational 5             one node
  edsc nmt socketcan:can0 reset-node 5 --wait 3s        and wait for its boot-up message, for three seconds at most)";

struct Settings {
  std::string bus;
  const NmtCommandText* command = nullptr;
  std::string written_node;
  std::string network;
  std::uint8_t node = 0;  ///< 0: all
  std::uint32_t wait_us = 0;

  void resolve() {
    if (written_node != "all") node = find_node_id("NODE", written_node, network);
  }
};

/// What the node has reported since the command.
struct Reports {
  std::optional<canopen::NmtState> last;
  bool confirmed = false;  ///< the state that the command leads to
};

/// Why the state is not confirmed.
std::string reason(const Settings& settings, const Reports& reports) {
  if (reports.last) return fmt::format("the last state that it reported is {}", nmt_state_text(*reports.last));
  if (settings.command->leads_to == canopen::NmtState::initialisation) return "it has not sent a boot-up message";
  return fmt::format("it has not sent a heartbeat; 1017h may be 0 (edsc read {} {} 1017h --type u16)", settings.bus,
                     settings.node);
}

void wait_for_state(LiveBus& bus, const Settings& settings, const Reports& reports) {
  constexpr canopen::Duration look_again = canopen::from_milliseconds(10);
  const canopen::TimePoint begin = bus.now();
  const canopen::Duration span{settings.wait_us};
  while (!reports.confirmed && bus.now() - begin < span) bus.listen(look_again);
  if (reports.confirmed) return;
  fail(fmt::format("node {} did not report {} within {}: {}", settings.node, nmt_state_text(settings.command->leads_to),
                   duration_text(settings.wait_us), reason(settings, reports)),
       exit_device_failed);
}

int run_nmt(const Settings& settings) {
  if (settings.wait_us != 0 && settings.node == 0) {
    throw_invalid("--wait", "waits for one node, not for all");
  }
  return with_bus(settings.bus, [&](LiveBus& bus) {
    Reports reports;
    const ErrorControlWatch watch{bus, settings.node, [&](canopen::NmtState state) {
                                    reports.last = state;
                                    if (state == settings.command->leads_to) reports.confirmed = true;
                                  }};
    bus.send_all(canopen::nmt_frame(settings.command->command, canopen::NodeId{settings.node}));
    bus.listen(canopen::from_milliseconds(10));  // the port may still hold the frame
    if (settings.wait_us != 0) wait_for_state(bus, settings, reports);
    return exit_fine;
  });
}

}  // namespace

void add_nmt_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_nmt, exit_code);
  add_bus_argument(command, settings.bus);
  std::vector<std::string> names;
  for (const NmtCommandText& row : nmt_command_texts) names.emplace_back(row.argument);
  command
      .add_text_option(
          "COMMAND",
          [&settings](const std::string& text) {
            settings.command = find_nmt_command(&NmtCommandText::argument, std::string_view{text});
          },
          "what the nodes do")
      .required()
      .one_of(names);
  add_node_argument(command, settings.written_node, "node-ID, 1..127, a name from the network file, or all");
  add_network_option(command, settings.network);
  command.add_duration("--wait", 1000, 600'000'000,
                       [&settings](std::uint64_t us) { settings.wait_us = static_cast<std::uint32_t>(us); });
}

}  // namespace edsc
