#include "network/master_sheet.hpp"
#include "network/communication_objects.hpp"
#include "network/error_control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <memory>
#include <string_view>
#include <utility>

#include "eds/number.hpp"
#include "format/dcf/parameter_text.hpp"
#include "network/node_settings.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

constexpr unsigned mapping_entries = 8;

/// An entry of the EDS. `name` may contain characters of any kind.
struct SheetEntry {
  std::uint8_t sub_index = 0;
  std::string name;
  canopen::DataType type = canopen::DataType::unsigned32;
  std::string_view access = "rw";
  std::string value;
  bool is_mappable = false;
};

/// The text of an EDS, object by object.
class SheetText {
 public:
  explicit SheetText(std::string_view name) {
    text_ = fmt::format(
        "[FileInfo]\nFileName={}.eds\nFileVersion=1\nFileRevision=0\nEDSVersion=4.0\n\n"
        "[DeviceInfo]\nVendorName=\nProductName={}\nBaudRate_10=1\nBaudRate_20=1\nBaudRate_50=1\nBaudRate_125=1\n"
        "BaudRate_250=1\nBaudRate_500=1\nBaudRate_800=1\nBaudRate_1000=1\nSimpleBootUpMaster=1\nSimpleBootUpSlave=0\n"
        "Granularity=1\nDynamicChannelsSupported=0\nGroupMessaging=0\nLSS_Supported=0\n\n"
        "[DummyUsage]\nDummy0001=0\nDummy0002=1\nDummy0003=1\nDummy0004=1\nDummy0005=1\nDummy0006=1\nDummy0007=1\n\n",
        name, name);
  }

  void add_var(std::uint16_t index, SheetEntry entry) {
    indices_.push_back(index);
    text_ += fmt::format("[{:04X}]\nParameterName={}\nObjectType=0x7\n{}\n", index, entry.name, keys_of(entry));
  }

  void add_record(std::uint16_t index, std::string_view name, const std::vector<SheetEntry>& entries,
                  std::string_view count_access = "const") {
    add_group(index, name, ObjectType::record, entries, count_access);
  }

  /// Elements of one data type, not necessarily consecutive.
  void add_array(std::uint16_t index, std::string_view name, const std::vector<SheetEntry>& entries) {
    add_group(index, name, ObjectType::array, entries, "const");
  }

  [[nodiscard]] std::string finish() {
    std::ranges::sort(indices_);
    const auto list = [&](std::string_view section, auto belongs) {
      std::string lines;
      unsigned count = 0;
      for (const std::uint16_t index : indices_) {
        if (belongs(index)) lines += fmt::format("{}=0x{:04X}\n", ++count, index);
      }
      text_ += fmt::format("[{}]\nSupportedObjects={}\n{}\n", section, count, lines);
    };
    const auto is_mandatory = [](std::uint16_t index) { return index <= 0x1001 || index == 0x1018; };
    const auto is_of_manufacturer = [](std::uint16_t index) { return index >= 0x2000 && index < 0x6000; };
    list("MandatoryObjects", is_mandatory);
    list("OptionalObjects", [&](std::uint16_t index) { return !is_mandatory(index) && !is_of_manufacturer(index); });
    list("ManufacturerObjects", is_of_manufacturer);
    return std::move(text_);
  }

 private:
  void add_group(std::uint16_t index, std::string_view name, ObjectType type, const std::vector<SheetEntry>& entries,
                 std::string_view count_access) {
    indices_.push_back(index);
    text_ += fmt::format("[{:04X}]\nParameterName={}\nObjectType=0x{:X}\nSubNumber={}\n\n", index, name,
                         static_cast<unsigned>(type), entries.size() + 1);
    const bool is_mapping = count_access == "rw";
    const SheetEntry count{0,
                           "Highest sub-index supported",
                           canopen::DataType::unsigned8,
                           count_access,
                           is_mapping ? "0" : std::to_string(entries.empty() ? 0 : entries.back().sub_index),
                           false};
    add_entry(index, count);
    for (const SheetEntry& entry : entries) add_entry(index, entry);
  }

  void add_entry(std::uint16_t index, const SheetEntry& entry) {
    const ObjectType type = entry.type == canopen::DataType::domain ? ObjectType::domain : ObjectType::var;
    text_ += fmt::format("[{:04X}sub{:X}]\nParameterName={}\nObjectType=0x{:X}\n{}\n", index, entry.sub_index,
                         entry.name, static_cast<unsigned>(type), keys_of(entry));
  }

  static std::string keys_of(const SheetEntry& entry) {
    if (entry.type == canopen::DataType::domain) {
      return fmt::format("DataType=0x{:04X}\nAccessType={}\n", static_cast<unsigned>(entry.type), entry.access);
    }
    return fmt::format("DataType=0x{:04X}\nAccessType={}\nDefaultValue={}\nPDOMapping={}\n",
                       static_cast<unsigned>(entry.type), entry.access, entry.value, entry.is_mappable ? 1 : 0);
  }

  std::string text_;
  std::vector<std::uint16_t> indices_;
};

std::string hex(std::uint32_t number) { return fmt::format("0x{:X}", number); }

class MasterSheet {
 public:
  MasterSheet(const NetworkNode& master, const Network& network, const SignalPlan& plan)
      : master_{master}, network_{network}, plan_{plan}, sheet_{master.name} {}

  std::string text() {
    using enum canopen::DataType;
    sheet_.add_var(0x1000, {0, "Device type", unsigned32, "ro", "0"});
    sheet_.add_var(0x1001, {0, "Error register", unsigned8, "ro", "0"});
    sheet_.add_var(0x1005, {0, "COB-ID SYNC", unsigned32, "rw", "0x80"});
    sheet_.add_var(0x1006, {0, "Communication cycle period", unsigned32, "rw", "0"});
    sheet_.add_var(0x1007, {0, "Synchronous window length", unsigned32, "rw", "0"});
    add_heartbeat();
    sheet_.add_record(communication::identity, "Identity object", {{1, "Vendor-ID", unsigned32, "ro", "0"}});
    if (network_.description.sync.overflow) {
      sheet_.add_var(0x1019, {0, "Synchronous counter overflow value", unsigned8, "rw", "0"});
    }
    // The master does not leave Operational if it loses a node.
    sheet_.add_array(0x1029, "Error behaviour", {{1, "Communication error", unsigned8, "rw", "1"}});
    if (network_.master() == &master_) add_sdo_clients();  // each server has one client
    add_pdos(PdoDirection::receive);
    add_pdos(PdoDirection::transmit);
    add_slaves();
    add_data();
    return sheet_.finish();
  }

 private:
  /// The other nodes.
  template <class Visit>
  void for_each_slave(Visit visit) const {
    for (const NetworkNode& node : network_.nodes) {
      if (&node != &master_) visit(node);
    }
  }

  void add_heartbeat() {
    using enum canopen::DataType;
    std::vector<SheetEntry> consumers;
    for_each_slave([&](const NetworkNode& node) {
      const NodeDescription& description = *node.description;
      const auto of_device = static_cast<std::uint32_t>(heartbeat_time(node.device()));
      const std::uint32_t of_master = description.heartbeat_ms ? description.heartbeat_ms->value : 0;
      const std::uint32_t produced = node.has_file() ? of_device : of_master;
      if (produced == 0 || (produced == 0xFFFF && !description.heartbeat_timeout_ms)) return;
      const std::uint32_t timeout =
          description.heartbeat_timeout_ms ? description.heartbeat_timeout_ms->value : std::min(produced * 2, 0xFFFFu);
      const auto sub_index = static_cast<std::uint8_t>(consumers.size() + 1);
      consumers.push_back({sub_index, node.name, unsigned32, "rw", hex(std::uint32_t{node.node_id} << 16 | timeout)});
    });
    if (!consumers.empty()) sheet_.add_array(0x1016, "Consumer heartbeat time", consumers);
    sheet_.add_var(0x1017, {0, "Producer heartbeat time", unsigned16, "rw", "0"});
  }

  void add_sdo_clients() {
    using enum canopen::DataType;
    std::uint16_t index = 0x1280;
    for_each_slave([&](const NetworkNode& node) {
      namespace code = canopen::function_code;
      sheet_.add_record(index++, fmt::format("SDO client parameter of {}", node.name),
                        {{1, "COB-ID client to server", unsigned32, "rw", hex(code::sdo_request + node.node_id)},
                         {2, "COB-ID server to client", unsigned32, "rw", hex(code::sdo_response + node.node_id)},
                         {3, "Node-ID of the SDO server", unsigned8, "rw", std::to_string(node.node_id)}});
    });
  }

  /// The slaves with their configuration (CiA 302-3, 1F22h) and their identity (CiA 302-2, 1F80h, 1F81h, 1F84h to
  /// 1F88h).
  void add_slaves() {
    using enum canopen::DataType;
    sheet_.add_var(0x1F80, {0, "NMT startup", unsigned32, "rw", "0x1"});
    add_for_slaves(0x1F22, "Concise DCF", domain, [](const NetworkNode&) { return std::string{}; });
    add_for_slaves(communication::slave_assignment, "NMT slave assignment", unsigned32,
                   [](const NetworkNode& node) { return hex(slave_assignment(node.device())); });
    add_for_slaves(0x1F84, "Device type identification", unsigned32,
                   [](const NetworkNode& node) { return identity_value(node, 0x1000, 0); });
    add_for_slaves(0x1F85, "Vendor identification", unsigned32,
                   [](const NetworkNode& node) { return identity_value(node, communication::identity, 1); });
    add_for_slaves(0x1F86, "Product code", unsigned32,
                   [](const NetworkNode& node) { return identity_value(node, communication::identity, 2); });
    add_for_slaves(0x1F87, "Revision number", unsigned32,
                   [](const NetworkNode& node) { return identity_value(node, communication::identity, 3); });
    add_for_slaves(0x1F88, "Serial number", unsigned32, [](const NetworkNode& node) {
      const WrittenNumber& serial = node.description->serial_number;
      return hex(serial ? serial->value : 0);
    });
  }

  /// 0 if the EDS of the node does not state it: the master does not compare it.
  static std::string identity_value(const NetworkNode& node, std::uint16_t index, std::uint8_t sub_index) {
    return hex(static_cast<std::uint32_t>(value_of(node.device(), index, sub_index).value_or(0)));
  }

  /// An ARRAY with the value of each slave at its node-ID.
  template <class ValueOf>
  void add_for_slaves(std::uint16_t index, std::string_view name, canopen::DataType type, ValueOf value_of_node) {
    std::vector<SheetEntry> entries;
    for_each_slave([&](const NetworkNode& node) {
      entries.push_back({node.node_id, node.name, type, "rw", value_of_node(node)});
    });
    std::ranges::sort(entries, {}, &SheetEntry::sub_index);
    if (!entries.empty()) sheet_.add_array(index, name, entries);
  }

  void add_pdos(PdoDirection direction) {
    using enum canopen::DataType;
    const bool receives = direction == PdoDirection::receive;
    const auto is_of_master = [&](const PlannedPdo& pdo) {
      return pdo.node == master_.name && pdo.direction == direction;
    };
    const auto count = static_cast<std::uint16_t>(std::ranges::count_if(plan_.pdos, is_of_master));
    for (std::uint16_t number = 1; number <= count; ++number) {
      const PdoParameterIndices indices = parameters_of(direction, number);
      std::vector<SheetEntry> communication{{1, "COB-ID", unsigned32, "rw", "0x80000000"},
                                            {2, "Transmission type", unsigned8, "rw", "255"}};
      if (!receives) communication.push_back({3, "Inhibit time", unsigned16, "rw", "0"});
      communication.push_back({5, "Event timer", unsigned16, "rw", "0"});
      sheet_.add_record(indices.communication,
                        fmt::format("{}PDO {} communication parameter", receives ? "R" : "T", number), communication);
      std::vector<SheetEntry> mapping;
      for (unsigned entry = 1; entry <= mapping_entries; ++entry) {
        mapping.push_back(
            {static_cast<std::uint8_t>(entry), fmt::format("Mapped object {}", entry), unsigned32, "rw", "0"});
      }
      sheet_.add_record(indices.mapping, fmt::format("{}PDO {} mapping parameter", receives ? "R" : "T", number),
                        mapping, "rw");
    }
  }

  /// The initial value of one that is sent: the default value of the receiver, so that a PDO with several values
  /// changes only those that the application has set.
  static std::string initial_value(const MasterEntry& entry) {
    const Entry& original = *entry.original;
    if (!entry.is_sent || !original.default_value) return "0";
    const std::string bytes = bytes_of(*original.default_value, *original.type);
    const std::vector<std::uint8_t> data{bytes.begin(), bytes.end()};
    return parameter_text(original, data).value_or("0");
  }

  /// A RECORD for each node and direction: the values sent to it, and those received from it.
  void add_data() {
    std::vector<MasterEntry> entries = plan_.master_entries;
    std::ranges::sort(entries, {}, [](const MasterEntry& one) { return std::pair{one.index, one.sub_index}; });
    for (auto first = entries.begin(); first != entries.end();) {
      const auto last =
          std::find_if(first, entries.end(), [&](const MasterEntry& one) { return one.index != first->index; });
      std::vector<SheetEntry> record;
      for (auto one = first; one != last; ++one) {
        record.push_back({one->sub_index, one->name, one->original->type->type, one->is_sent ? "rwr" : "rww",
                          initial_value(*one), true});
      }
      sheet_.add_record(first->index, first->is_sent ? commands_name(first->node) : first->node, record);
      first = last;
    }
  }

  const NetworkNode& master_;
  const Network& network_;
  const SignalPlan& plan_;
  SheetText sheet_;
};

/// The text of the EDS is not a file that the user can open: values are where the network file implies them.
void move_positions(DataSheet& sheet, const NetworkNode& master, const Network& network) {
  const auto move = [&](EntryDescription& entry) {
    for (Position* const position :
         {&entry.position, &entry.access_type.position, &entry.default_value.position, &entry.pdo_mapping.position}) {
      *position = master.position;
    }
  };
  for (ObjectDescription& object : sheet.objects) {
    move(object);
    for (SubObjectDescription& entry : object.sub_objects) {
      move(entry);
      if (object.index != communication::consumer_heartbeat || entry.sub_index == 0) continue;
      const std::uint64_t value = parse_unsigned(entry.default_value.text).value_or(0);
      for (const NetworkNode& node : network.nodes) {
        if ((value >> 16 & 0xFF) != node.node_id) continue;
        const NodeDescription& of_node = *node.description;
        entry.default_value.position = of_node.heartbeat_timeout_ms ? of_node.heartbeat_timeout_ms->position
                                       : of_node.heartbeat_ms       ? of_node.heartbeat_ms->position
                                                                    : node.position;
      }
    }
  }
}

}  // namespace

void add_master_sheet(NetworkNode& master, Network& network, const SignalPlan& plan) {
  auto loaded = std::make_unique<LoadedDevice>();
  loaded->source =
      std::make_unique<SourceFile>(fmt::format("{}.eds", master.name), MasterSheet{master, network, plan}.text());
  LoadSettings settings;
  settings.node_id = master.node_id;
  settings.name = master.name;
  settings.check = false;
  Diagnostics of_sheet;  // empty: the text is ours
  read_sheet(*loaded, of_sheet);
  move_positions(loaded->sheet, master, network);
  resolve_sheet(*loaded, settings, of_sheet);
  master.loaded = loaded.get();
  network.files.push_back(std::move(loaded));
}

}  // namespace edsc
