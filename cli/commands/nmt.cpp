#include <fmt/format.h>

#include <canopen/nmt/error_control.hpp>
#include <canopen/nmt_master/nmt_master.hpp>

#include "commands/commands.hpp"
#include "online/live_bus.hpp"
#include "online/nmt_text.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_options.hpp"
#include "shared/with_bus.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc nmt socketcan:can0 start all                     all nodes Operational
  edsc nmt socketcan:can0 pre-operational 5             one node
  edsc nmt socketcan:can0 reset-node 5 --wait 3000      and wait for its boot-up message, for three seconds at most)";

struct Settings {
  std::string bus;
  const NmtCommandText* command = nullptr;
  std::uint8_t node = 0;  ///< 0: all
  unsigned wait_ms = 0;
};

/// Waits until the node reports the state that the command leads to.
class Confirmation {
 public:
  Confirmation(LiveBus& bus, const Settings& settings) : bus_{bus}, settings_{settings} {
    bus.on_frame = [this](const canopen::Frame& frame, canopen::TimePoint) {
      const auto message = canopen::error_control_message(frame);
      if (!message || message->node_id.value() != settings_.node) return;
      reported_ = message->state;
      if (reported_ == settings_.command->leads_to) confirmed_ = true;
    };
  }
  ~Confirmation() { bus_.on_frame = nullptr; }
  Confirmation(const Confirmation&) = delete;
  Confirmation& operator=(const Confirmation&) = delete;

  [[nodiscard]] bool comes_in_time() {
    constexpr canopen::Duration look_again = canopen::from_milliseconds(10);
    const canopen::TimePoint begin = bus_.now();
    const canopen::Duration span{settings_.wait_ms * 1000U};
    while (!confirmed_ && bus_.now() - begin < span) bus_.listen(look_again);
    return confirmed_;
  }

  /// Why the state is not confirmed: the last state that the node reported, or that it sent nothing.
  [[nodiscard]] std::string reason() const {
    if (reported_) return fmt::format("the last state that it reported is {}", nmt_state_text(*reported_));
    if (settings_.command->leads_to == canopen::NmtState::initialisation) return "it has not sent a boot-up message";
    return fmt::format("it has not sent a heartbeat; 1017h may be 0 (edsc read {} {} 1017h --type u16)", settings_.bus,
                       settings_.node);
  }

 private:
  LiveBus& bus_;
  const Settings& settings_;
  bool confirmed_ = false;
  std::optional<canopen::NmtState> reported_;  ///< last
};

int run_nmt(const Settings& settings) {
  return with_bus(settings.bus, [&](LiveBus& bus) {
    Confirmation confirmation{bus, settings};
    bus.send_all(canopen::nmt_frame(settings.command->command, canopen::NodeId{settings.node}));
    bus.listen(canopen::from_milliseconds(10));  // the port may still hold the frame
    if (settings.wait_ms == 0 || confirmation.comes_in_time()) return exit_fine;
    print_visibly(stderr, "edsc: node {} did not report {} within {} ms: {}\n", settings.node,
                  nmt_state_text(settings.command->leads_to), settings.wait_ms, confirmation.reason());
    return exit_device_failed;
  });
}

}  // namespace

void add_nmt_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("nmt", "start, stop or reset nodes");
  command->footer(examples);
  auto settings = std::make_shared<Settings>();
  add_bus_argument(*command, settings->bus);
  std::vector<std::string> names;
  for (const NmtCommandText& row : nmt_command_texts) names.emplace_back(row.text);
  command
      ->add_option_function<std::string>(
          "COMMAND", [settings](const std::string& text) { settings->command = find_nmt_command(text); },
          "start, stop, pre-operational, reset-node or reset-communication")
      ->required()
      ->check(CLI::IsMember(names));
  command
      ->add_option_function<std::string>(
          "NODE",
          [settings](const std::string& text) {
            settings->node = static_cast<std::uint8_t>(text == "all" ? 0 : parse_count(text).value_or(0));
          },
          "node-ID, 1..127, or all")
      ->required()
      ->check([](const std::string& text) {
        const bool known = text == "all" || (parse_count(text, 127).value_or(0) != 0);
        return known ? std::string{} : "\"" + text + "\" is not a node-ID from 1 to 127 or \"all\"";
      });
  command->add_option("--wait", settings->wait_ms, "ms to wait until the node reports its new state")
      ->check(CLI::Range(1, 600'000));
  command->callback([settings, &exit_code] {
    if (settings->wait_ms != 0 && settings->node == 0) {
      throw CLI::ValidationError("--wait", "waits for one node, not for all");
    }
    exit_code = run_nmt(*settings);
  });
}

}  // namespace edsc
