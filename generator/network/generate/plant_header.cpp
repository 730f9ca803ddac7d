#include "network/generate/plant_header.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <canopen/emcy/emcy_consumer.hpp>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "backend/cpp/cpp_text.hpp"
#include "backend/cpp/identifier.hpp"
#include "backend/cpp/views.hpp"
#include "backend/render.hpp"
#include "device/entry_text.hpp"
#include "device/meaning/raw_unit.hpp"
#include "format/dcf/concise_dcf.hpp"
#include "network/cob_id_use.hpp"
#include "network/communication_objects.hpp"
#include "network/error_control.hpp"
#include "network/generate/plant_links.hpp"
#include "network/generate/plant_places.hpp"
#include "system/path.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

using nlohmann::ordered_json;

std::string hex_text(std::uint64_t number) { return fmt::format("0x{:X}", number); }

std::string pdo_type_name(const Pdo& pdo) {
  return fmt::format("{}{}", pdo.direction == PdoDirection::receive ? "Rpdo" : "Tpdo", pdo.number);
}

ordered_json with_separators(ordered_json rows, std::string_view separator) {
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i]["separator"] = i == 0 ? std::string_view{} : separator;
  return rows;
}

/// The name of the network file without its folders.
std::string file_comment(const Network& network) { return cpp_comment(file_name_of(network.source->name())); }

/// The names of a node that are not available for its signals: members of canopen::PlantNodeAccess.
constexpr std::string_view access_members[] = {"boot", "booted", "node_id", "plant", "state"};

/// The names that are not available for nodes: members of canopen::Plant, which would hide the node, the argument of
/// the constructor of its nodes, and a namespace of the header.
constexpr std::string_view plant_members[] = {"all_booted",    "boot",     "booted",        "command", "count",
                                              "device",        "get",      "next_deadline", "on",      "on_booted",
                                              "on_bus_status", "on_fault", "on_frame",      "on_time", "plant",
                                              "request",       "set",      "signals",       "start",   "state"};

class PlantHeader {
 public:
  PlantHeader(const Network& network, const std::string& name, const PlantParts& parts)
      : network_{network}, name_{name}, parts_{parts}, uses_{cob_id_uses(network)}, links_{pdo_links(uses_)} {
    IdentifierScope names;
    for (const std::string_view one : plant_members) static_cast<void>(names.take(std::string{one}, ""));
    for (const NetworkNode& node : network_.nodes) {
      const std::string wanted = to_cpp_identifier(node.name);
      identifiers_.push_back(names.take(wanted.empty() ? "node" : wanted, std::to_string(node.node_id)));
    }
  }

  std::string text() {
    std::string guard = "edsc_network_" + name_;
    std::ranges::transform(guard, guard.begin(), to_upper);
    ordered_json view{{"file", file_comment(network_)}, {"guard", guard},       {"namespace", name_},
                      {"nodes", node_rows()},           {"links", link_rows()}, {"network", network_view()}};
    return render(report_template("plant.hpp"), view);
  }

 private:
  [[nodiscard]] std::size_t position_in_file(const NetworkNode& node) const {
    return static_cast<std::size_t>(&node - network_.nodes.data());
  }
  [[nodiscard]] const std::string& identifier(const NetworkNode& node) const {
    return identifiers_[position_in_file(node)];
  }
  /// Position of a node in the network description, which does not have the master.
  [[nodiscard]] std::size_t slave_position(const NetworkNode& node) const {
    const NetworkNode* const master = network_.master();
    return position_in_file(node) - (master != nullptr && master < &node ? 1 : 0);
  }
  /// `::plant::axis1::Tpdo1`
  [[nodiscard]] std::string full_name(const CobIdUse& use) const {
    return fmt::format("::{}::{}::{}", name_, identifier(*use.node), pdo_type_name(*use.pdo));
  }
  [[nodiscard]] static std::string label(const NetworkNode& node) {
    const std::string& path = node.loaded->source->name();
    const std::string file = node.has_file() ? std::string{file_name_of(path)} : "no EDS";
    return cpp_comment(fmt::format("{}: node-ID {}, {}", node.name, node.node_id, file));
  }

  // Nodes with their PDOs and configuration

  [[nodiscard]] ordered_json node_rows() const {
    ordered_json rows = ordered_json::array();
    for (const NetworkNode& node : network_.nodes) {
      ordered_json bytes = configuration_rows(node);
      const bool any = !bytes.empty() && &node != network_.master();
      ordered_json texts = owner_of_error_texts(node) == &node ? error_text_rows(node) : ordered_json::array();
      const bool any_error_text = !texts.empty();
      rows.push_back({{"label", label(node)},
                      {"identifier", identifier(node)},
                      {"any_error_text", any_error_text},
                      {"error_texts", std::move(texts)},
                      {"device", parts_.devices[position_in_file(node)]},
                      {"node_id", node.node_id},
                      {"pdos", pdo_structs(node)},
                      {"any_configuration", any},
                      {"configuration", std::move(bytes)}});
    }
    return rows;
  }

  /// The names of error codes that CiA 301 does not have.
  [[nodiscard]] static ordered_json error_text_rows(const NetworkNode& node) {
    ordered_json rows = ordered_json::array();
    for (const ErrorCodeName& one : node.device().error_codes) {
      if (one.text == canopen::emergency_text(one.code)) continue;
      rows.push_back({{"code", fmt::format("0x{:04X}", one.code)}, {"text", cpp_string(one.text)}});
    }
    return rows;
  }

  /// The first node with the same device, whose table the others use.
  [[nodiscard]] const NetworkNode* owner_of_error_texts(const NetworkNode& node) const {
    const std::string& device = parts_.devices[position_in_file(node)];
    return std::ranges::find_if(
        network_.nodes.data(), network_.nodes.data() + network_.nodes.size(),
        [&](const NetworkNode& one) { return parts_.devices[position_in_file(one)] == device; });
  }

  /// The PDOs that are valid and have a layout.
  [[nodiscard]] ordered_json pdo_structs(const NetworkNode& node) const {
    ordered_json rows = ordered_json::array();
    const ordered_json of_device = pdo_rows(node.named());
    for (const CobIdUse& use : uses_) {
      if (use.node != &node || use.pdo == nullptr) continue;
      const std::string type = pdo_type_name(*use.pdo);
      const auto at = std::ranges::find_if(of_device, [&](const ordered_json& one) { return one["type"] == type; });
      if (at == of_device.end() || !has_struct(use)) continue;
      ordered_json row = *at;
      row["can_id"] = can_id_text(use.can_id, use.extended);
      row["members"] = with_separators(members(node, *use.pdo), ", ");
      rows.push_back(std::move(row));
    }
    return rows;
  }

  [[nodiscard]] static bool has_struct(const CobIdUse& use) {
    return !is_left_out(*use.pdo) && !use.pdo->multiplexed && use.pdo->mapping != nullptr && !use.pdo->entries.empty();
  }

  [[nodiscard]] static ordered_json members(const NetworkNode& node, const Pdo& pdo) {
    ordered_json rows = ordered_json::array();
    IdentifierScope names;
    for (std::size_t i = 0; i < pdo.entries.size(); ++i) {
      if (pdo.entries[i].object == nullptr) continue;
      rows.push_back({{"name", names.take(signal_identifier(node, pdo.entries[i]), "again")}, {"position", i}});
    }
    return rows;
  }

  /// One row for each entry of the concise DCF; none if it is empty.
  [[nodiscard]] ordered_json configuration_rows(const NetworkNode& node) const {
    ordered_json rows = ordered_json::array();
    const std::string& stream = parts_.concise_dcfs[position_in_file(node)];
    const auto entries = read_concise_dcf(stream);
    if (!entries || entries->empty()) return rows;
    const char* begin = stream.data();
    const auto add = [&](const char* end, const std::string& comment) {
      std::string bytes;
      for (; begin != end; ++begin) bytes += fmt::format("0x{:02X},", static_cast<unsigned char>(*begin));
      rows.push_back({{"bytes", bytes}, {"comment", comment}});
    };
    add(begin + sizeof(std::uint32_t), fmt::format("number of entries: {}", entries->size()));
    for (const ConciseEntry& entry : *entries) {
      const Entry* const known = node.device().find(entry.index, entry.sub_index);
      add(entry.data.data() + entry.data.size(),
          fmt::format("{} {}", entry_label(entry.index, entry.sub_index), cpp_comment(known ? known->name : "")));
    }
    return rows;
  }

  // Links

  [[nodiscard]] ordered_json link_rows() const {
    ordered_json rows = ordered_json::array();
    for (const PdoLink& link : links_) {
      if (!has_struct(*link.sender) || !has_struct(*link.receiver)) continue;
      rows.push_back({{"comment", cpp_comment(link_text(link))},
                      {"produced", full_name(*link.sender)},
                      {"consumed", full_name(*link.receiver)}});
    }
    return rows;
  }

  [[nodiscard]] static std::string link_text(const PdoLink& link) {
    return fmt::format("{} to {}, {}", named(*link.sender), named(*link.receiver),
                       can_id_text(link.sender->can_id, link.sender->extended));
  }

  // The network for canopen::Plant

  struct Signals {
    ordered_json received = ordered_json::array();
    ordered_json sent = ordered_json::array();
  };

  [[nodiscard]] Signals signals_of(const NetworkNode& node) const {
    Signals signals;
    IdentifierScope names;
    for (const std::string_view member : access_members) static_cast<void>(names.take(std::string{member}, ""));
    std::set<std::pair<bool, const Entry*>> known;
    for (const PdoLink& link : links_) {
      const bool is_received = link.sender->node == &node && link.receiver->node == network_.master();
      const bool is_sent = link.receiver->node == &node && link.sender->node == network_.master();
      if ((!is_received && !is_sent) || !has_struct(*link.sender) || !has_struct(*link.receiver)) continue;
      for (const LinkedValue& value : linked_values(link)) {
        const PdoEntry& entry =
            is_received ? link.sender->pdo->entries[value.sent] : link.receiver->pdo->entries[value.taken];
        if (!known.emplace(is_received, entry.object).second) continue;
        const std::string name = names.take(signal_identifier(node, entry), is_sent ? "command" : "signal");
        (is_received ? signals.received : signals.sent).push_back(signal_row(node, link, value, entry, name));
      }
    }
    return signals;
  }

  [[nodiscard]] ordered_json signal_row(const NetworkNode& node, const PdoLink& link, const LinkedValue& value,
                                        const PdoEntry& entry, const std::string& name) const {
    const Meaning* const meaning = entry.object->meaning.get();
    const Quantity* const quantity = quantity_with_unit(*entry.object);
    const std::string unit = quantity != nullptr ? " in " + raw_unit_text(*quantity) : "";
    const std::string values = meaning != nullptr && meaning->values ? ", " + values_text(*meaning->values) : "";
    const bool is_limited = entry.object->low_limit || entry.object->high_limit;
    return {{"name", name},
            {"type", fmt::format("::{}::signals::{}::{}", name_, identifier(node), name)},
            {"comment",
             cpp_comment(fmt::format("{} {}{}, {}, bits {}..{}{}", named(*entry.object), entry.object->type->name, unit,
                                     link_text(link), value.first_bit, value.first_bit + entry.bits - 1U, values))},
            {"tpdo", full_name(*link.sender)},
            {"rpdo", full_name(*link.receiver)},
            {"sent", value.sent},
            {"taken", value.taken},
            {"nodiscard", is_limited ? "[[nodiscard]] " : ""}};
  }

  /// `0 off, 1 heating`; at most eight names.
  [[nodiscard]] static std::string values_text(const Enumeration& values) {
    constexpr std::size_t max_names = 8;
    std::string text;
    for (const NamedValue& one : std::span{values.values}.first(std::min(max_names, values.values.size()))) {
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", one.value, one.name);
    }
    return values.values.size() > max_names ? text + ", ..." : text;
  }

  [[nodiscard]] ordered_json network_view() const {
    const NetworkNode* const master = network_.master();
    if (master == nullptr) return nullptr;
    ordered_json slaves = ordered_json::array();
    ordered_json received = ordered_json::array();
    ordered_json sent = ordered_json::array();
    ordered_json places = ordered_json::array();
    ordered_json errors = ordered_json::array();
    for (const NetworkNode& node : network_.nodes) {
      if (&node == master) continue;
      add_places(places, node);
      const NetworkNode& owner = *owner_of_error_texts(node);
      if (!error_text_rows(owner).empty()) {
        errors.push_back({{"node", identifier(node)}, {"texts_of", identifier(owner)}});
      }
      Signals signals = signals_of(node);
      for (const ordered_json& one : signals.received) received.push_back({{"type", one["type"]}});
      for (const ordered_json& one : signals.sent) sent.push_back({{"type", one["type"]}});
      ordered_json row = slave_row(*master, node);
      row["any_signal"] = !signals.received.empty() || !signals.sent.empty();
      row["received"] = std::move(signals.received);
      row["sent_signals"] = std::move(signals.sent);
      slaves.push_back(std::move(row));
    }
    const std::size_t count = slaves.size();
    return {{"master_name", cpp_comment(master->name)},
            {"master_device", parts_.devices[position_in_file(*master)]},
            {"master_id", master->node_id},
            {"start_up", hex_text(value_of(master->device(), 0x1F80).value_or(0))},
            {"boot_time_us", value_of(master->device(), 0x1F89).value_or(0) * 1000},
            {"count", count},
            {"slaves", with_separators(std::move(slaves), ", ")},
            {"place_count", places.size()},
            {"places", std::move(places)},
            {"error_count", errors.size()},
            {"errors", std::move(errors)},
            {"received_list", with_separators(std::move(received), ", ")},
            {"sent_list", with_separators(std::move(sent), ", ")}};
  }

  void add_places(ordered_json& rows, const NetworkNode& node) const {
    for (const PlantPlaceRow& place : plant_places(network_, node, parts_.concise_dcfs[position_in_file(node)])) {
      rows.push_back({{"node", identifier(node)},
                      {"index", hex_text(place.index)},
                      {"sub_index", place.sub_index},
                      {"file", cpp_string(place.file)},
                      {"line", place.line}});
    }
  }

  /// The row of the network list (CiA 302-2): 1F81h and 1F84h to 1F88h of the master, where they are not 0; otherwise
  /// the identity in the EDS of the node.
  [[nodiscard]] ordered_json slave_row(const NetworkNode& master, const NetworkNode& node) const {
    const auto number = [&](std::uint16_t list, std::uint16_t index, std::uint8_t sub_index) {
      const std::uint64_t of_master = value_of(master.device(), list, node.node_id).value_or(0);
      return hex_text(of_master != 0 ? of_master : value_of(node.device(), index, sub_index).value_or(0));
    };
    const WrittenNumber& serial = node.description->serial_number;
    const std::uint64_t serial_of_master = value_of(master.device(), 0x1F88, node.node_id).value_or(0);
    const std::uint64_t assignment =
        value_of(master.device(), communication::slave_assignment, node.node_id).value_or(0);
    return {{"label", label(node)},
            {"identifier", identifier(node)},
            {"class_name", to_camel_case(identifier(node)) + "Node"},
            {"text_name", cpp_string(node.name)},
            {"position", slave_position(node)},
            {"emcy", emcy_cob_id(node)},
            {"assignment", hex_text(assignment != 0 ? assignment : slave_assignment(node.device()))},
            {"device_type", number(0x1F84, 0x1000, 0)},
            {"vendor_id", number(0x1F85, communication::identity, 1)},
            {"product_code", number(0x1F86, communication::identity, 2)},
            {"revision_number", number(0x1F87, communication::identity, 3)},
            {"serial_number", hex_text(serial ? serial->value : serial_of_master)},
            {"heartbeat_time", heartbeat_timeout(master, node)},
            {"any_configuration", !configuration_rows(node).empty()},
            {"any_sdo_timeout", sdo_timeout_ms(network_.description, *node.description).has_value()},
            {"sdo_timeout", sdo_timeout_ms(network_.description, *node.description).value_or(0)}};
  }

  /// Bits of an EMCY COB-ID that a received frame has; 0x80000000: the node does not send EMCY.
  [[nodiscard]] static std::string emcy_cob_id(const NetworkNode& node) {
    constexpr std::uint64_t invalid = 0x8000'0000;
    return hex_text(value_of(node.device(), 0x1014).value_or(invalid) & 0xBFFF'FFFF);
  }

  /// 1016h of the master for this node; 0 if it does not have it.
  [[nodiscard]] static std::uint64_t heartbeat_timeout(const NetworkNode& master, const NetworkNode& node) {
    const Object* const consumers = master.device().find(communication::consumer_heartbeat);
    if (consumers == nullptr) return 0;
    for (const Entry& entry : consumers->entries) {
      if (entry.sub_index == 0 || !entry.default_value) continue;
      const std::uint64_t value = entry.default_value->bits;
      if ((value >> 16 & 0xFF) == node.node_id) return value & 0xFFFF;
    }
    return 0;
  }

  const Network& network_;
  const std::string& name_;
  const PlantParts& parts_;
  std::vector<CobIdUse> uses_;
  std::vector<PdoLink> links_;
  std::vector<std::string> identifiers_;
};

}  // namespace

std::string plant_header(const Network& network, const std::string& name, const PlantParts& parts) {
  return PlantHeader{network, name, parts}.text();
}

std::string devices_header(const Network& network, const PlantParts& parts, const std::vector<OutputFile>& headers) {
  uLong checksum = crc32(0, nullptr, 0);
  for (const OutputFile& header : headers) {
    checksum = crc32_z(checksum, reinterpret_cast<const Bytef*>(header.content.data()), header.content.size());
  }
  return render(report_template("network-devices.hpp"),
                {{"file", file_comment(network)},
                 {"checksum", fmt::format("{:08X}", checksum)},
                 {"headers", std::set<std::string>{parts.devices.begin(), parts.devices.end()}}});
}

}  // namespace edsc
