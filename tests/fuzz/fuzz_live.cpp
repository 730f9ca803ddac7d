/// Arbitrary answers to the commands for a bus: `scan`, `save` and `configure` end, send only requests, and report the
/// values of the node; `monitor` shows arbitrary frames.
///
/// An input is a byte that selects the command and what follows the steps, and a sequence of steps (steps.hpp).
#include <nlohmann/json.hpp>

#include <span>

#include "configure/configuration_plan.hpp"
#include "configure/configure_node.hpp"
#include "configure/read_configuration.hpp"
#include "decode/decoder.hpp"
#include "format/dcf/parameter_text.hpp"
#include "live_port.hpp"
#include "load/load_device.hpp"
#include "monitor/monitor_view.hpp"
#include "online/scan.hpp"
#include "values/value_bytes.hpp"

namespace edsc::fuzz {
namespace {

/// An axis, and a configuration of it: all default values of its EDS.
class Axis {
 public:
  Axis() {
    Diagnostics diagnostics;
    LoadSettings settings;
    settings.path = EDSC_SOURCE_DIR "/tests/bus/decode/axis.dcf";
    settings.node_id = LivePort::node_id;
    settings.check = false;
    loaded_ = load_device(settings, diagnostics);
    require(loaded_->device.has_value(), "the data sheet can be read");
    for (const LiveEntry& entry : configuration_entries(device())) {
      if (is_left_out(entry) || !entry.entry->default_value) continue;
      const std::string bytes = bytes_of(*entry.entry->default_value, *entry.type);
      values_.push_back({entry, {bytes.begin(), bytes.end()}, {}});
    }
    require(values_.size() > 20, "there is much to configure");
    for (const Object& object : device().objects) {
      for (const Entry& entry : object.entries) {
        const std::size_t bytes = entry.type->bits == 0 ? 9 : (entry.type->bits + 7u) / 8u;
        defaults_.values[key(entry.index, entry.sub_index)] = Bytes(bytes, 0);
      }
    }
  }

  [[nodiscard]] const Device& device() const { return *loaded_->device; }
  [[nodiscard]] const std::vector<ConfigurationValue>& values() const { return values_; }
  /// A node whose values are 0.
  [[nodiscard]] const ObedientServer& defaults() const { return defaults_; }

  static std::uint32_t key(std::uint16_t index, std::uint8_t sub_index) {
    return std::uint32_t{index} << 8 | sub_index;
  }

 private:
  std::unique_ptr<LoadedDevice> loaded_;
  std::vector<ConfigurationValue> values_;
  ObedientServer defaults_;
};

void scan_node(LiveBus& bus) {
  std::vector<FoundNode> found;
  scan(bus, {{LivePort::node_id}, 20, 20}, found);
  require(found.size() <= 1, "a node is found once");
  for (const FoundNode& node : found) require(node.node_id == LivePort::node_id, "a node that was asked is found");
}

void read_node(LiveBus& bus, const Axis& axis) {
  SdoAccess node{bus, canopen::NodeId{LivePort::node_id}, {20, 4096}};
  const std::vector<LiveEntry> entries = configuration_entries(axis.device());
  const NodeConfiguration found = read_configuration(node, axis.device(), entries, [](std::size_t) {});
  require(found.values.size() + found.unread.size() + found.process_data.size() <= entries.size(),
          "each entry counts once");
  for (const ReadValue& value : found.values) {
    const unsigned bits = value.entry.type->bits;
    require(value.bytes.size() <= 4096, "a value has no more bytes than allowed");
    require(bits == 0 || value.bytes.size() == (bits + 7u) / 8u || !parameter_text(*value.entry.entry, value.bytes),
            "a value that does not have the size of its type is not saved");
  }
}

void configure(LiveBus& bus, const Axis& axis, const ObedientServer& server, bool undisturbed) {
  SdoAccess node{bus, canopen::NodeId{LivePort::node_id}, {20, 4096}};
  const auto steps = plan_configuration(axis.values(), &axis.device());
  const ConfigurationResult result =
      configure_node(node, steps, {[](std::size_t, std::size_t) {}, [] { return false; }});
  require(result.written <= result.values && result.verified <= result.written, "what is verified was written");
  if (!undisturbed) return;
  require(result.done() && result.verified == result.values, "an obedient node is configured");
  for (const ConfigurationValue& value : axis.values()) {
    const auto found = server.values.find(Axis::key(value.entry.index, value.entry.sub_index));
    require(found != server.values.end() && found->second == value.bytes,
            "an obedient node has the values of the configuration");
  }
}

void monitor(Steps steps, const Axis& axis) {
  Decoder decoder{{{LivePort::node_id, &axis.device()}}};
  MonitorState state;
  const MonitorView view{"bus", 500, false};
  Message message;
  state.start(0);
  std::int64_t now_us = 0;
  for (const Step& step : steps) {
    canopen::Frame frame;
    frame.id = (step.number | step.other << 8u) & 0x7FFu;
    frame.size = step.choice % 9u;
    frame.remote = step.what == 0xFF;
    frame.data = step.data;
    now_us += step.what * 1000;
    decoder.decode({frame, true, now_us}, message);
    (void)state.add(frame, message, now_us);
    state.pass(now_us);
  }
  state.end(now_us);
  for (const std::string& line : monitor_lines(state, view, now_us)) {
    for (std::string_view rest = line; !rest.empty(); rest.remove_prefix(first_sequence(rest).length)) {
      require(first_sequence(rest).is_visible, "a line of the table has no hidden characters");
    }
  }
  require(nlohmann::json::accept(json_text(monitor_json(state, view, now_us))), "the summary is JSON");
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc::fuzz;
  static const Axis axis;
  if (size == 0) return 0;
  const Steps steps{data + 1, size - 1};
  ObedientServer server = axis.defaults();
  auto port = std::make_unique<LivePort>(steps, (data[0] & 0x80) != 0, server);
  const unsigned command = data[0] % 4;
  port->reads_only = command != 2;
  edsc::LiveBus bus{std::move(port)};
  const bool undisturbed = data[0] < 0x80 && steps.begin() == steps.end();
  switch (command) {
    case 0: scan_node(bus); break;
    case 1: read_node(bus, axis); break;
    case 2: configure(bus, axis, server, undisturbed); break;
    default: monitor(steps, axis); break;
  }
  return 0;
}
