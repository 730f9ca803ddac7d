#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "commands/commands.hpp"
#include "device/behaving_node.hpp"
#include "device/load_sheet.hpp"
#include "device/node_host.hpp"
#include "device/value_overlay.hpp"
#include "load/load_device.hpp"
#include "lookup/find_entry.hpp"
#include "network/error_control.hpp"
#include "network/node_configuration.hpp"
#include "network/presence_watch.hpp"
#include "server/candump_line.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/frame_log.hpp"
#include "shared/given_nodes.hpp"
#include "shared/live_network.hpp"
#include "shared/live_options.hpp"
#include "shared/monitor_feed.hpp"
#include "shared/monitor_server.hpp"
#include "shared/node_behaviour.hpp"
#include "shared/output.hpp"
#include "shared/parse_number.hpp"
#include "shared/with_bus.hpp"
#include "system/path.hpp"
#include "text/duration.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc network run socketcan:vcan0 plant.json                    all nodes that are not on the bus, until Ctrl-C
  edsc network run socketcan:can0 plant.json --except axis1      never this one
  edsc network run socketcan:can0 plant.json --only axis1,axis2  no other
  edsc network run socketcan:can0 plant.json --scripts --device-profile   with behaviour beyond the protocol
  edsc network run socketcan:can0 plant.json --log plant.log     record the frames of the bus
  edsc network run socketcan:can0 plant.json --web               the page of edsc monitor, with the simulated nodes marked)";

struct Settings {
  std::string bus;
  std::string path;
  std::vector<std::string> only, except;
  std::uint64_t absent_us = 1'000'000;
  std::string log;
  std::optional<ListenAddress> web;
  bool scripts = false;
  bool device_profile = false;
  bool quiet = false;
};

/// The nodes of `axis1,axis2` and `5`.
std::vector<const NetworkNode*> nodes_of(const std::string& option, const std::vector<std::string>& texts,
                                         const Network& network) {
  std::vector<const NetworkNode*> nodes;
  for (const std::string& text : texts) {
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t comma = std::min(text.find(',', begin), text.size());
      const std::string name = text.substr(begin, comma - begin);
      begin = comma + 1;
      const NetworkNode* node = network.find(name);
      if (const auto number = parse_number(name); node == nullptr && number) {
        const auto at = std::ranges::find(network.nodes, *number, [](const NetworkNode& one) { return one.node_id; });
        node = at == network.nodes.end() ? nullptr : &*at;
      }
      if (node == nullptr) fail(fmt::format("{}: {}", option, network.unknown_node(name)));
      nodes.push_back(node);
    }
  }
  return nodes;
}

/// The nodes that may be simulated. A master with a file is one of them only if --only names it: the program that is
/// being tested is usually the master.
std::vector<const NetworkNode*> chosen_nodes(const Settings& settings, const Network& network) {
  std::vector<const NetworkNode*> chosen = nodes_of("--only", settings.only, network);
  const std::vector<const NetworkNode*> except = nodes_of("--except", settings.except, network);
  for (const NetworkNode* node : chosen) {
    if (!node->has_file()) fail(fmt::format("--only: {} has no EDS or DCF in the network file", label(*node)));
  }
  if (chosen.empty()) {
    for (const NetworkNode& node : network.nodes) {
      if (node.has_file() && !node.is_master) chosen.push_back(&node);
    }
  }
  std::erase_if(chosen, [&](const NetworkNode* node) { return std::ranges::find(except, node) != except.end(); });
  if (chosen.empty()) fail(settings.path + ": no node with an EDS or DCF is left");
  return chosen;
}

/// The tables of a node, with the values of the network file as default values.
std::shared_ptr<const Sheet> sheet_of(const NetworkNode& node, bool quiet) {
  ValueOverlay values;
  const Entry* const serial_number = node.device().find(0x1018, 4);
  if (const WrittenNumber& written = node.description->serial_number;
      written && written->value != 0 && serial_number != nullptr) {
    Value value;
    value.bits = written->value;
    values.set(*serial_number, value);
  }
  Diagnostics of_mapping;
  const Device device = with_values(node.device(), values, node.loaded->options, of_mapping);
  LoadedSheet made = load_sheet(device, node.loaded->options);
  for (const std::string& note : made.notes) {
    if (!quiet || !made.sheet) print_to_stderr("edsc: {}: {}\n", label(node), note);
  }
  if (!made.sheet) throw Exit{exit_input_has_errors};
  return std::move(made.sheet);
}

/// NAME.behaviour.json beside NAME.eds, if it exists; else empty.
std::string script_beside(const NetworkNode& node) {
  std::filesystem::path path = to_native(input_files(*node.loaded).front());
  path.replace_extension(".behaviour.json");
  std::error_code error;
  return std::filesystem::exists(path, error) ? from_native(path) : std::string{};
}

/// The page of the monitor with the frames of the bus, also those that this program sends.
class PlantPage {
 public:
  PlantPage(const Settings& settings, const GivenNodes& nodes, canopen::TimePoint now)
      : feed_{nodes, now}, server_{*settings.web, settings.bus}, published_{now} {
    if (const WrittenNumber& bit_rate = nodes.network->network.description.bit_rate) {
      bit_rate_ = static_cast<unsigned>(bit_rate->value);
    }
  }

  void add(const canopen::Frame& frame, canopen::TimePoint now) {
    if (const Message* const message = feed_.add(frame, now)) server_.add(*message, feed_.now_us());
  }
  void set_simulated(std::uint8_t node_id, bool is_simulated) { feed_.state().set_simulated(node_id, is_simulated); }

  /// Updates the page ten times a second.
  void on_time(canopen::TimePoint now) {
    if (now - published_ < canopen::from_milliseconds(100)) return;
    published_ = now;
    feed_.pass(now);
    server_.publish(feed_.state(), bit_rate_, feed_.now_us());
  }

 private:
  MonitorFeed feed_;
  MonitorServer server_;
  std::optional<unsigned> bit_rate_;
  canopen::TimePoint published_;
};

/// Simulates the absent nodes of a network.
class PlantRun {
 public:
  PlantRun(LiveBus& bus, const Settings& settings, const Network& network, const std::vector<const NetworkNode*>& nodes,
           const GivenNodes& given)
      : bus_{bus},
        settings_{settings},
        host_{bus},
        watch_{canopen::Duration{static_cast<std::uint32_t>(settings.absent_us)}, bus.now()} {
    if (settings.web) page_.emplace(settings, given, bus.now());
    if (!settings.log.empty()) log_.emplace(settings.log, interface_of(settings.bus));
    for (const NetworkNode* node : nodes) {
      add(*node);
      const auto heartbeat_ms = static_cast<std::uint16_t>(heartbeat_time(node->device()));
      watch_.add(node->node_id, own_cob_ids(network, *node), canopen::from_milliseconds(heartbeat_ms));
      nodes_.push_back({node, Presence::unknown});
    }
    bus.on_frame = [this](const canopen::Frame& frame, canopen::TimePoint now) {
      record(frame, bus_.received_at(), now);
      watch_.on_frame(frame, now);
    };
    bus.on_sent = [this](const canopen::Frame& frame, canopen::TimePoint now) { record(frame, now, now); };
  }
  PlantRun(const PlantRun&) = delete;
  PlantRun& operator=(const PlantRun&) = delete;
  ~PlantRun() {
    bus_.on_frame = nullptr;
    bus_.on_sent = nullptr;
  }

  int run() {
    const auto turn = [this] {
      watch_.on_time(bus_.now(), [this](const canopen::Frame& frame) { return bus_.send(frame); });
      for (std::size_t place = 0; place < nodes_.size(); ++place) follow(place);
      if (page_) page_->on_time(bus_.now());
      if (log_ && !log_->flush()) fail_to_write();
      return true;
    };
    host_.run(turn, [] { return canopen::from_milliseconds(100); });
    return exit_fine;
  }

 private:
  struct Node {
    const NetworkNode* node;
    Presence presence;  ///< as the simulation follows it
  };

  void add(const NetworkNode& node) {
    EntryFinder& names = names_.emplace_back(node.loaded->named());
    NodeBehaviour behaviour;
    if (const std::string script = settings_.scripts ? script_beside(node) : ""; !script.empty())
      add_script(behaviour, script, names, ColorOption{});
    if (settings_.device_profile) static_cast<void>(add_device_profile(behaviour, node.device(), names));
    BehavingNode* added = nullptr;
    host_.add(canopen::NodeId{node.node_id}, [&](canopen::SimulatedBus& port, canopen::SimulatedMemory& memory) {
      BehavingNodeSettings of_node{
          .sheet = sheet_of(node, settings_.quiet), .memory = {}, .seed = node.node_id, .profile = behaviour.profile};
      auto made = std::make_unique<BehavingNode>(std::move(of_node), port, memory);
      added = made.get();
      return made;
    });
    added->behaviour().report = [&node](const std::string& problem) {
      print_to_stderr("edsc: {}: {}\n", label(node), problem);
    };
    added->behaviour().add(behaviour.script);
  }

  void record(const canopen::Frame& frame, canopen::TimePoint at, canopen::TimePoint now) {
    if (page_) page_->add(frame, now);
    if (log_ && !log_->write(frame, at, now)) fail_to_write();
  }

  [[noreturn]] void fail_to_write() {
    fail(fmt::format("{}: {}", settings_.log, errno != 0 ? std::strerror(errno) : "cannot be written"));
  }

  /// Switches a node on or off after its device left or appeared.
  void follow(std::size_t place) {
    const Presence present = watch_.presence(place), before = std::exchange(nodes_[place].presence, present);
    if (present == before) return;
    if (page_) page_->set_simulated(nodes_[place].node->node_id, present == Presence::absent);
    if (present == Presence::absent) {
      report(*nodes_[place].node, before == Presence::unknown ? "simulated" : "the device left; simulated");
      host_.switch_on(place);
    } else {
      host_.switch_off(place);
      report(*nodes_[place].node,
             before == Presence::unknown ? "present; not simulated" : "the device appeared; not simulated");
    }
  }

  void report(const NetworkNode& node, std::string_view what) const {
    if (settings_.quiet) return;
    print_visibly(stdout, "{} \"{}\" on {}: {}\n", label(node), node.device().product_name, settings_.bus, what);
    flush_output();
  }

  LiveBus& bus_;
  const Settings& settings_;
  NodeHost host_;
  PresenceWatch watch_;
  std::optional<FrameLog> log_;
  std::optional<PlantPage> page_;
  std::vector<Node> nodes_;
  std::deque<EntryFinder> names_;  ///< of the nodes
};

int run_plant(const Settings& settings) {
  LiveNetworkSettings load;
  load.path = settings.path;
  const LiveNetwork live = load_live_network(load);
  const Network& network = live.loaded->network;
  const std::vector<const NetworkNode*> nodes = chosen_nodes(settings, network);
  std::vector<std::string> inputs{settings.path};
  for (const NetworkNode& node : network.nodes) {
    if (!node.loaded) continue;
    for (std::string& name : input_files(*node.loaded)) inputs.push_back(std::move(name));
  }
  refuse_input(settings.log, inputs);
  GivenNodes given;
  if (settings.web) {
    NodesSettings of_page;
    of_page.network = settings.path;
    given = load_given_nodes(of_page, ColorOption{});
  }
  return with_bus(settings.bus, [&](LiveBus& bus) { return PlantRun{bus, settings, network, nodes, given}.run(); });
}

}  // namespace

void add_network_run_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_plant, exit_code);
  add_bus_argument(command, settings.bus);
  command.add_option("FILE", settings.path, "network file (JSON)").required();
  command.add_option("--only", settings.only, "nodes, such as axis1,axis2; also a master with an EDS").one_value_each();
  command.add_option("--except", settings.except).one_value_each().excludes("--only");
  command.add_duration("--absent", 100'000, 60'000'000, [&settings](std::uint64_t us) { settings.absent_us = us; })
      .show_default(duration_text(settings.absent_us));
  command.add_flag("--scripts", settings.scripts);
  command.add_flag("--device-profile", settings.device_profile, "nodes of other profiles follow only the protocol");
  command.add_option("--log", settings.log);
  add_web_option(command, settings.web);
  command.add_flag("--quiet", settings.quiet);
}

}  // namespace edsc
