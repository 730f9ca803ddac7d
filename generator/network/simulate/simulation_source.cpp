#include "network/simulate/simulation_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <chrono>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "backend/cpp/cpp_text.hpp"
#include "backend/cpp/headers.hpp"
#include "backend/cpp/identifier.hpp"
#include "network/generate/node_dcf.hpp"
#include "network/simulate/changing_objects.hpp"
#include "system/path.hpp"

namespace edsc {
namespace {

constexpr std::uint32_t default_sync = 0x80;
constexpr std::uint32_t default_sdo_ms = 10;

std::int64_t in_microseconds(Nanoseconds time) {
  return std::chrono::duration_cast<std::chrono::microseconds>(time).count();
}

/// `{0x01, 0x02, ...}` in lines.
std::string byte_list(std::string_view bytes) {
  std::string list;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i % 20 == 0) list += "\n    ";
    list += fmt::format("0x{:02X},", static_cast<unsigned char>(bytes[i]));
    if (i % 20 != 19) list += ' ';
  }
  return list;
}

class SourceWriter {
 public:
  SourceWriter(const Network& network, const NetworkTiming& timing, Diagnostics& diagnostics)
      : network_{network}, timing_{timing}, uses_{cob_id_uses(network)}, diagnostics_{diagnostics} {}

  SimulationSource write() {
    std::string nodes;
    for (std::size_t i = 0; i < network_.nodes.size(); ++i) nodes += node_text(network_.nodes[i], i);
    std::string text = fmt::format(
        "// Written by edsc network simulate.\n"
        "#include <canopen_sim/network_simulation/network_simulation.hpp>\n\n"
        "namespace simulation = canopen::network_simulation;\n\n{}\nnamespace {{\n\n",
        declarations_);
    text += tables_ + messages_text();
    text += fmt::format("constexpr simulation::PlannedNode nodes[] = {{\n{}}};\n\n", nodes) + plan_text();
    text +=
        "\n}  // namespace\n\nint main(int argc, char** argv) { "
        "return simulation::simulate_network(argc, argv, plan); }\n";
    source_.files.push_back({"simulate.cpp", std::move(text)});
    source_.sources.insert(source_.sources.begin(), "simulate.cpp");
    return std::move(source_);
  }

 private:
  /// The file, its options, `keep_going`, and of a DCF the node-ID, which is part of its device.
  using DeviceKey = std::tuple<std::string, std::string, bool, unsigned>;

  std::string node_text(const NetworkNode& node, std::size_t place) {
    const std::string device = device_of(node);
    tables_ += dcf_text(node, place) + changes_text(node, place);
    return fmt::format("    {{{}, {}, &make_{}, {}, 0x{:X}, 0x{:X}, {}}},\n", cpp_string(node.name), node.node_id,
                       device, dcf_name(place), emcy_can_id(node), babbling_can_id(node), changes_name(place));
  }

  /// The namespace of the device of a node; its files are added if it is the first node with them.
  std::string device_of(const NetworkNode& node) {
    const LoadedDevice& loaded = *node.loaded;
    const bool keep_going = node.description->keep_going && node.description->keep_going->value;
    const DeviceKey key{loaded.source->name(), loaded.options_source ? loaded.options_source->name() : "", keep_going,
                        loaded.sheet.is_dcf ? node.node_id : 0};
    const auto known = devices_.find(key);
    if (known != devices_.end()) return known->second;
    const std::string name = unique_name(to_namespace(stem_of(loaded.source->name())));
    devices_.emplace(key, name);
    add_device(node, name, keep_going);
    return name;
  }

  std::string unique_name(const std::string& name) {
    std::string unique = name;
    for (unsigned number = 2; !names_.insert(unique).second; ++number) unique = fmt::format("{}_{}", name, number);
    return unique;
  }

  void add_device(const NetworkNode& node, const std::string& name, bool keep_going) {
    const LoadedDevice& loaded = *node.loaded;
    const auto node_id = loaded.sheet.is_dcf ? std::optional{node.node_id} : std::nullopt;
    std::ranges::move(headers_of(device_for(loaded, node_id, keep_going), loaded.options, name, diagnostics_),
                      std::back_inserter(source_.files));
    const std::string function = fmt::format(
        "std::unique_ptr<canopen::SimulatedNode> make_{}(canopen::SimulatedBus& bus, canopen::SimulatedMemory& memory)",
        name);
    declarations_ += function + ";\n";
    source_.sources.push_back(name + ".cpp");
    source_.files.push_back(
        {name + ".cpp", fmt::format("// Written by edsc network simulate.\n"
                                    "#include <{0}/device.hpp>\n"
                                    "#include <canopen_sim/network_simulation/heartbeat_watch.hpp>\n\n"
                                    "{1} {{\n"
                                    "  return canopen::network_simulation::make_node_of<{0}::Device>(bus, memory);\n"
                                    "}}\n",
                                    name, function)});
  }

  std::string dcf_text(const NetworkNode& node, std::size_t place) {
    const NodeDcf dcf = make_node_dcf(network_, node, node_file(node, "dcf"), diagnostics_);
    return fmt::format("// {}\nconstexpr std::uint8_t {}[] = {{{}\n}};\n", cpp_comment(node.name), dcf_name(place),
                       byte_list(dcf.concise));
  }

  std::string changes_text(const NetworkNode& node, std::size_t place) {
    std::string rows;
    std::string objects;
    for (const ChangingPdo& pdo : changing_pdos(node, uses_, timing_)) {
      const std::string name = fmt::format("objects_{}_{}", place, pdo.message);
      objects += fmt::format("constexpr simulation::PlannedObject {}[] = {{\n", name);
      for (const ChangingObject& one : pdo.objects) {
        objects += fmt::format("    {{0x{:04X}, 0x{:02X}, {}, 0x{:X}, 0x{:X}}},\n", one.index, one.sub_index, one.bytes,
                               one.low, one.range);
      }
      objects += "};\n";
      rows += fmt::format("    {{{}, {}, {}, {}, {}}},\n", pdo.message, in_microseconds(pdo.interval),
                          pdo.is_event_driven && pdo.has_receiver, pdo.is_event_driven && !pdo.has_event_timer, name);
    }
    if (rows.empty())
      return fmt::format("constexpr std::span<const simulation::PlannedChange> {};\n\n", changes_name(place));
    return fmt::format("{}constexpr simulation::PlannedChange {}[] = {{\n{}}};\n\n", objects, changes_name(place),
                       rows);
  }

  static std::string dcf_name(std::size_t place) { return fmt::format("dcf_{}", place); }
  static std::string changes_name(std::size_t place) { return fmt::format("changes_{}", place); }

  [[nodiscard]] const CobIdUse* first_sent(const NetworkNode& node, FrameService service) const {
    const CobIdUse* first = nullptr;
    for (const CobIdUse& use : uses_) {
      if (use.node != &node || use.service != service || !use.transmits || use.extended) continue;
      if (first == nullptr || use.can_id < first->can_id) first = &use;
    }
    return first;
  }

  [[nodiscard]] std::uint32_t emcy_can_id(const NetworkNode& node) const {
    const CobIdUse* const emcy = first_sent(node, FrameService::emcy);
    return emcy != nullptr ? emcy->can_id : 0;
  }

  /// Its PDO of highest priority; of a node without one its heartbeat.
  [[nodiscard]] std::uint32_t babbling_can_id(const NetworkNode& node) const {
    const CobIdUse* const pdo = first_sent(node, FrameService::pdo);
    return pdo != nullptr ? pdo->can_id : canopen::function_code::error_control + node.node_id;
  }

  [[nodiscard]] std::string messages_text() const {
    std::string rows;
    for (const TimedMessage& one : timing_.messages) {
      rows += fmt::format("    {{0x{:X}, {}, {}, {}}},  // {}\n", one.message.can_id, one.message.extended,
                          one.message.remote, one.is_synchronous, cpp_comment(one.name));
    }
    return fmt::format("constexpr simulation::PlannedMessage messages[] = {{\n{}}};\n\n", rows);
  }

  [[nodiscard]] std::string plan_text() const {
    std::uint32_t sync = default_sync;
    for (const CobIdUse& use : uses_) {
      if (use.service == FrameService::sync && use.transmits) sync = use.can_id;
    }
    const WrittenNumber& sdo_ms = network_.description.assume.sdo_ms;
    const NetworkNode* const master = network_.master();
    const std::ptrdiff_t place = master != nullptr ? master - network_.nodes.data() : std::ssize(network_.nodes);
    return fmt::format("constexpr simulation::NetworkPlan plan{{\n    {}, {}, 0x{:X}, {}, nodes, messages}};\n",
                       network_.description.bit_rate->value * 1000, (sdo_ms ? sdo_ms->value : default_sdo_ms) * 1000,
                       sync, place);
  }

  const Network& network_;
  const NetworkTiming& timing_;
  std::vector<CobIdUse> uses_;
  Diagnostics& diagnostics_;
  SimulationSource source_;
  std::map<DeviceKey, std::string> devices_;  ///< their namespaces
  std::set<std::string> names_;
  std::string declarations_;
  std::string tables_;
};

}  // namespace

SimulationSource simulation_source(const Network& network, const NetworkTiming& timing, Diagnostics& diagnostics) {
  return SourceWriter{network, timing, diagnostics}.write();
}

}  // namespace edsc
