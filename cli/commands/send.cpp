#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "commands/commands.hpp"
#include "decode/compose_pdo.hpp"
#include "decode/log/log_line.hpp"
#include "device/entry_text.hpp"
#include "lookup/find_entry.hpp"
#include "online/live_bus.hpp"
#include "shared/common_options.hpp"
#include "shared/default_scales.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/given_nodes.hpp"
#include "shared/live_device.hpp"
#include "shared/live_options.hpp"
#include "shared/with_bus.hpp"
#include "text/printable.hpp"
#include "values/little_endian.hpp"
#include "values/parse_value.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc send socketcan:can0 sync --every 10ms                    SYNC every 10 ms, until Ctrl-C
  edsc send socketcan:can0 sync --overflow 240 --every 10ms --count 500
  edsc send socketcan:can0 time                                 the time of day of this computer, UTC
  edsc send socketcan:can0 pdo 5 1 controlword=0x0F "target_velocity=1500 rpm" --eds drive.eds
  edsc send socketcan:can0 pdo 5 2 statusword=0x27 position_actual_value=0 --tpdo --eds drive.eds
  edsc send socketcan:can0 frame 181#0102)";

struct Settings {
  std::string bus;
  std::uint32_t every_us = 0;  ///< 0: one frame, or `count` of them at once
  std::optional<std::uint32_t> count;
  std::optional<std::uint32_t> can_id;
  std::optional<std::uint32_t> overflow;
  std::optional<std::vector<std::uint8_t>> time;
  NodeSettings node;
  std::string name_in_network;  ///< of the node, whose PDOs the network file configures; empty with --eds
  std::uint32_t number = 0;
  std::vector<std::string> values;
  bool transmit = false;
  canopen::Frame frame;

  canopen::Frame (*compose)(const Settings&, std::uint32_t sent) = nullptr;  ///< the subcommand; see KindRow

  void resolve() {
    take_old_form();
    const bool is_given = !node.sheet.empty();
    const NamedNode found = node.resolve();
    if (!is_given) name_in_network = found.name;
  }

 private:
  /// `5=drive.eds` of previous versions.
  void take_old_form() {
    const auto old = parse_node_file(node.written_node);
    if (!old) return;
    print_to_stderr("edsc: note: \"{0}={1}\" is written \"{0} --eds {1}\" now\n", old->node_id, old->path);
    node.written_node = fmt::format("{}", old->node_id);
    if (node.sheet.empty()) node.sheet = old->path;
  }
};

std::optional<std::uint32_t> parse_from_one(const std::string& text, std::uint32_t most) {
  const auto number = parse_count(text, most);
  return number && *number != 0 ? number : std::nullopt;
}

canopen::Frame frame_with(std::uint32_t can_id, std::span<const std::uint8_t> bytes) {
  canopen::Frame frame;
  frame.id = can_id;
  frame.extended = can_id > 0x7FF;
  frame.size = static_cast<std::uint8_t>(bytes.size());
  std::ranges::copy(bytes, frame.data.begin());
  return frame;
}

/// The counter of CiA 301, 7.2.5.3, goes from 1 to the overflow value of 1019h.
canopen::Frame compose_sync(const Settings& settings, std::uint32_t sent) {
  std::vector<std::uint8_t> counter;
  if (settings.overflow) counter.push_back(static_cast<std::uint8_t>(sent % *settings.overflow + 1));
  return frame_with(settings.can_id.value_or(canopen::function_code::sync), counter);
}

/// The present time as TIME_OF_DAY: ms after midnight, then days since 1984-01-01 (CiA 301, 7.1.6.6).
std::vector<std::uint8_t> present_time() {
  const auto now = std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const auto day = std::chrono::floor<std::chrono::days>(now);
  const auto days = static_cast<std::uint64_t>((day - time_epoch).count());
  return bytes_of(static_cast<std::uint64_t>((now - day).count()) | days << 32, 6);
}

canopen::Frame compose_time(const Settings& settings, std::uint32_t /*sent*/) {
  return frame_with(settings.can_id.value_or(canopen::function_code::time),
                    settings.time ? *settings.time : present_time());
}

/// `statusword=0x27`
PdoValue pdo_value(const NamedDevice& named, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) fail(fmt::format("\"{}\" is not of the form OBJECT=VALUE", text));
  const FoundEntry found = find_one_entry(named, text.substr(0, equals));
  if (!found.ok()) fail(found.problem);
  return {found.entry->index, found.entry->sub_index, text.substr(equals + 1)};
}

/// `who` has the device.
canopen::Frame compose_pdo_of_device(const Settings& settings, const NamedDevice& named, const std::string& who) {
  const NodeModel model{settings.node.node, named.device};
  const PdoDirection direction = settings.transmit ? PdoDirection::transmit : PdoDirection::receive;
  const auto pdo = std::ranges::find_if(
      model.pdos(), [&](const PdoLayout& one) { return one.direction == direction && one.number == settings.number; });
  if (pdo == model.pdos().end()) {
    fail(fmt::format("{} does not have {} {}", who, settings.transmit ? "TPDO" : "RPDO", settings.number));
  }
  std::vector<PdoValue> values;
  for (const std::string& text : settings.values) values.push_back(pdo_value(named, text));
  const bool has_default_scale = std::ranges::any_of(values, [&](const PdoValue& value) {
    const Entry* const entry = named.device.find(value.index, value.sub_index);
    const Quantity* const quantity = entry != nullptr ? quantity_of(*entry) : nullptr;
    return quantity != nullptr && !quantity->stated_by.empty();
  });
  if (has_default_scale) report_default_scales(settings.node.node, named.device);
  const ComposedPdo composed = compose_pdo(*pdo, values);
  if (!composed.ok()) fail(composed.problem);
  return composed.frame;
}

/// The PDO as the network file configures it, with `set` and signals.
canopen::Frame compose_pdo_of_network(const Settings& settings) {
  const std::string path = network_or_default(settings.node.network);
  const auto loaded = load_given_network(path, ColorOption{});
  const NetworkNode* const node = loaded->network.find(settings.name_in_network);
  if (node == nullptr) fail(fmt::format("node {} of {} cannot be used", settings.name_in_network, path));
  return compose_pdo_of_device(settings, node->named(), fmt::format("node {} of {}", node->name, path));
}

canopen::Frame compose_pdo_of_node(const Settings& settings, std::uint32_t /*sent*/) {
  if (!settings.name_in_network.empty()) return compose_pdo_of_network(settings);
  const std::string& path = settings.node.sheet;
  if (path.empty()) throw_required("--eds or --network");
  const auto loaded = load_live_device(path, settings.node.node);
  return compose_pdo_of_device(settings, loaded->named(), path);
}

canopen::Frame given_frame(const Settings& settings, std::uint32_t /*sent*/) { return settings.frame; }

/// Sends the frames in their period, without drift; SYNC and TIME differ from frame to frame.
int send_frames(LiveBus& bus, const Settings& settings, canopen::Frame frame) {
  const canopen::Duration period = canopen::Duration{settings.every_us};
  const bool endless = settings.every_us != 0 && !settings.count;
  const std::uint32_t count = settings.count.value_or(1);
  const bool changes = settings.compose == compose_sync || settings.compose == compose_time;
  canopen::TimePoint due = bus.now();
  for (std::uint32_t sent = 0; endless || sent < count; ++sent) {
    if (sent != 0) {
      due = due + period;
      const canopen::TimePoint present = bus.now();
      if (due > present) bus.listen(due - present);
      if (changes) frame = settings.compose(settings, sent);
    }
    bus.send_all(frame);
  }
  bus.listen(canopen::from_milliseconds(10));  // the port may still hold the last frame
  return exit_fine;
}

int run_send(const Settings& settings) {
  const canopen::Frame first = settings.compose(settings, 0);  // errors before the bus is opened
  return with_bus(settings.bus, [&](LiveBus& bus) { return send_frames(bus, settings, first); });
}

void add_can_id_option(Command command, Settings& settings) {
  const auto parse = [](const std::string& text) {
    const auto can_id = parse_count(text, 0x1FFF'FFFF);
    return can_id && !canopen::is_restricted(*can_id) ? can_id : std::nullopt;
  };
  add_parsed(command, "--id", settings.can_id, parse, "a CAN-ID up to 1FFFFFFFh, or is reserved by CiA 301",
             "default: the value of CiA 301");
}

void add_sync_options(Command command, Settings& settings) {
  const auto parse = [](const std::string& text) {
    const auto number = parse_count(text, 240);
    return number && *number >= 2 ? number : std::nullopt;
  };
  add_parsed(command, "--overflow", settings.overflow, parse, "a number from 2 to 240");
  add_can_id_option(command, settings);
}

void add_time_options(Command command, Settings& settings) {
  const auto parse = [](const std::string& text) -> std::optional<std::vector<std::uint8_t>> {
    const ParsedValue parsed = parse_value_text(*find_type("TIME_OF_DAY"), text);
    return parsed.ok() ? std::optional{parsed.bytes} : std::nullopt;
  };
  add_parsed(command, "TIME", settings.time, parse, "a time from \"1984-01-01\" to \"2163-06-06 23:59:59.999\"",
             "\"2026-01-31 12:00:00\" (default: the present time, UTC)");
  add_can_id_option(command, settings);
}

void add_pdo_options(Command command, Settings& settings) {
  add_node_argument(command, settings.node.written_node);
  add_network_option(command, settings.node.network);
  command.add_option("--eds", settings.node.sheet);
  add_parsed(
      command, "NUMBER", settings.number,
      [](const std::string& text) { return parse_from_one(text, classical_can.pdos); },
      fmt::format("a number from 1 to {}", classical_can.pdos), "number of the RPDO: 1 is 1400h")
      .required();
  command.add_option("OBJECT=VALUE", settings.values, "a value for each mapped object, by name or address");
  command.add_flag("--tpdo", settings.transmit);
}

void add_frame_options(Command command, Settings& settings) {
  const auto parse = [](const std::string& text) -> std::optional<canopen::Frame> {
    const LogLine line = parse_log_line(text);
    if (line.kind != LogLineKind::frame || text.find('#') == std::string::npos) return std::nullopt;
    return line.frame;
  };
  add_parsed(command, "FRAME", settings.frame, parse, "a frame such as 181#0102",
             "CAN-ID of 3 or 8 digits, # and bytes, or R and the length of a remote frame: 181#0102, 705#R1")
      .required();
}

/// A subcommand.
struct KindRow {
  const char* name;
  const char* description;
  canopen::Frame (*compose)(const Settings& settings, std::uint32_t sent);  ///< ends the command if it is impossible
  void (*add_options)(Command command, Settings& settings);
};

constexpr KindRow kinds[] = {
    {"sync", "send SYNC", compose_sync, add_sync_options},
    {"time", "send TIME, the time of day", compose_time, add_time_options},
    {"pdo", "send a PDO to a node, with values by name", compose_pdo_of_node, add_pdo_options},
    {"frame", "send a frame", given_frame, add_frame_options},
};

}  // namespace

void add_send_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_send, exit_code);
  add_bus_argument(command, settings.bus);
  command.add_duration("--every", 1000, 600'000'000,
                       [&settings](std::uint64_t us) { settings.every_us = static_cast<std::uint32_t>(us); });
  const auto parse_positive = [](const std::string& text) { return parse_from_one(text, 0xFFFF'FFFF); };
  add_parsed(command, "--count", settings.count, parse_positive, "a number from 1", "default: 1");
  for (const KindRow& row : kinds) {
    const Command kind = command.add_subcommand(row.name, row.description);
    kind.take_options_of_parent();
    kind.on_chosen([&settings, &row] { settings.compose = row.compose; });
    row.add_options(kind, settings);
  }
}

}  // namespace edsc
