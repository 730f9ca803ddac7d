#include "network/generate/lely.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "device/index_range.hpp"
#include "eds/ini.hpp"
#include "eds/number.hpp"
#include "format/dcf/concise_dcf.hpp"
#include "network/communication_objects.hpp"
#include "network/error_control.hpp"
#include "network/generate/node_dcf.hpp"
#include "system/path.hpp"
#include "text/snake_case.hpp"
#include "values/little_endian.hpp"

namespace edsc {
namespace {

constexpr std::array sdo_clients = {IndexRange{0x1280, 0x12FF}};
constexpr std::uint32_t profile_bits = 0xFFFF;  // of 1000h
constexpr std::uint64_t drive_profile = 402;

// The DCF of the master

/// Removes objects from [OptionalObjects] and numbers the others again.
void remove_from_list(DocumentSection& list) {
  std::vector<DocumentEntry> kept;
  for (DocumentEntry& entry : list.entries) {
    const bool is_element = parse_unsigned(entry.key).has_value();
    const auto index = parse_unsigned(entry.value);
    if (is_element && index && contains(sdo_clients, static_cast<std::uint16_t>(*index))) continue;
    kept.push_back(std::move(entry));
  }
  unsigned count = 0;
  for (DocumentEntry& entry : kept) {
    if (parse_unsigned(entry.key)) entry.key = fmt::format("{}", ++count);
  }
  for (DocumentEntry& entry : kept) {
    if (entry.key == "SupportedObjects") entry.value = fmt::format("{}", count);
  }
  list.entries = std::move(kept);
}

/// The entry of 1F22h with a file: Lely's loader reads the file when the entry is read.
void upload_file(DocumentSection& section) {
  const auto find = [&](std::string_view key) { return std::ranges::find(section.entries, key, &DocumentEntry::key); };
  const auto file = find("DownloadFile");
  if (file == section.entries.end()) return;
  file->key = "UploadFile";
  if (const auto access = find("AccessType"); access != section.entries.end()) access->value = "ro";
  std::erase_if(section.entries, [](const DocumentEntry& one) { return one.key == "PDOMapping"; });
}

std::string master_text(Document dcf) {
  std::erase_if(dcf.sections, [](const DocumentSection& section) {
    return is_object_section(section.kind.kind) && contains(sdo_clients, section.kind.index);
  });
  for (DocumentSection& section : dcf.sections) {
    if (section.kind.kind == SectionKind::optional_objects) remove_from_list(section);
    const bool is_entry = section.kind.kind == SectionKind::sub_object;
    if (is_entry && section.kind.index == communication::concise_dcf) upload_file(section);
  }
  return to_text(dcf);
}

// bus.yml

/// A text as a scalar of YAML.
std::string yaml_text(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return quoted + "\"";
}

/// The bytes as a number of `sdo`: dcfgen writes integers of 8, 16, 32 and 64 bits.
std::optional<std::string> number_text(const Entry& entry, std::string_view data) {
  using enum canopen::DataClass;
  const canopen::DataTypeRow& type = *entry.type;
  if (type.kind != boolean && type.kind != unsigned_integer && type.kind != signed_integer) return std::nullopt;
  const bool has_usual_size = type.bits == 1 || type.bits == 8 || type.bits == 16 || type.bits == 32 || type.bits == 64;
  if (!has_usual_size || data.size() != bytes_for(type.bits)) return std::nullopt;
  const std::vector<std::uint8_t> bytes{data.begin(), data.end()};
  const std::uint64_t number = number_of(bytes);
  if (type.kind == signed_integer) return fmt::format("{}", sign_extended(number, type.bits));
  return fmt::format("0x{:X}", number);
}

/// Keys of `bus.yml` that are not nodes, or are the master.
constexpr std::string_view reserved_keys[] = {"master", "options", "defaults"};

class BusYml {
 public:
  BusYml(const Network& network, const NetworkNode& master) : network_{network}, master_{master} {}

  std::string text(const std::vector<LelyNode>& nodes, std::vector<std::string>& notes) {
    text_ = fmt::format("# The network of {} for dcfgen of Lely and for ros2_canopen\n",
                        file_name_of(network_.source->name()));
    add_master();
    for (const LelyNode& one : nodes) {
      if (one.node != &master_) add_slave(one, notes);
    }
    return std::move(text_);
  }

 private:
  void add(std::string_view key, const std::string& value) { text_ += fmt::format("  {}: {}\n", key, value); }
  void add_number(std::string_view key, std::uint64_t number) { add(key, fmt::format("{}", number)); }
  void add_if_stated(std::string_view key, const WrittenNumber& number) {
    if (number) add_number(key, number->value);
  }

  void add_driver(std::string_view name, std::string_view package) {
    add("driver", yaml_text(fmt::format("ros2_canopen::{}", name)));
    add("package", yaml_text(package));
  }

  void add_master() {
    text_ += "\nmaster:\n";
    add_number("node_id", master_.node_id);
    add_if_stated("baudrate", network_.description.bit_rate);
    add_driver("MasterDriver", "canopen_master_driver");
    const Device& device = master_.device();
    if (const std::uint64_t time = heartbeat_time(device); time != 0) add_number("heartbeat_producer", time);
    const SyncDescription& sync = network_.description.sync;
    if (sync.producer && sync.producer->value == master_.name) {
      add_if_stated("sync_period", sync.period_us);
      add_if_stated("sync_window", sync.window_us);
      add_if_stated("sync_overflow", sync.overflow);
    }
    if (const auto behaviour = value_of(device, 0x1029, 1))
      text_ += fmt::format("  error_behavior: {{1: {}}}\n", *behaviour);
    if (const auto time = value_of(device, 0x1F89)) add_number("boot_time", *time);
  }

  /// The name of a node is a key, and names a node of ROS and a file.
  std::string key_of(const NetworkNode& node) {
    std::string key = to_snake_case(node.name);
    if (key.empty() || std::ranges::find(reserved_keys, key) != std::end(reserved_keys) || !keys_.insert(key).second) {
      key = fmt::format("{}{}{}", key, key.empty() ? "node_" : "_", node.node_id);
      keys_.insert(key);
    }
    return key;
  }

  void add_slave(const LelyNode& one, std::vector<std::string>& notes) {
    const NetworkNode& node = *one.node;
    const Device& device = node.device();
    text_ += fmt::format("\n{}:\n", yaml_text(key_of(node)));
    add("dcf", yaml_text(lely_dcf_file(node)));
    add_number("node_id", node.node_id);
    add_if_stated("serial_number", node.description->serial_number);
    if ((value_of(device, 0x1000).value_or(0) & profile_bits) == drive_profile) {
      add_driver("Cia402Driver", "canopen_402_driver");
    } else {
      add_driver("ProxyDriver", "canopen_proxy_driver");
    }
    add_heartbeat(node);
    add_values(one, notes);
  }

  /// dcfgen computes 1016h of the master as a multiple of the producer heartbeat time, rounded down.
  void add_heartbeat(const NetworkNode& node) {
    const std::uint64_t time = heartbeat_time(node.device());
    const Object* const consumers = master_.device().find(communication::consumer_heartbeat);
    if (time == 0 || consumers == nullptr) return;
    for (const Entry& entry : consumers->entries) {
      if (entry.sub_index == 0 || !entry.default_value) continue;
      const std::uint64_t value = entry.default_value->bits;
      if ((value >> 16 & 0xFF) != node.node_id) continue;
      const std::uint64_t timeout = value & 0xFFFF;
      if (timeout % time == 0) return add_number("heartbeat_multiplier", timeout / time);
      return add("heartbeat_multiplier",
                 fmt::format("{:.6f}", (static_cast<double>(timeout) + 0.5) / static_cast<double>(time)));
    }
  }

  /// The entries of the concise DCF. Without one, dcfgen does not configure the node.
  void add_values(const LelyNode& one, std::vector<std::string>& notes) {
    const auto entries = read_concise_dcf(one.concise_dcf);
    if (!entries) return;
    std::string rows;
    for (const ConciseEntry& value : *entries) {
      const Entry* const entry = one.node->device().find(value.index, value.sub_index);
      if (entry == nullptr) continue;
      if (const auto number = number_text(*entry, value.data)) {
        rows += fmt::format("    - {{index: 0x{:04X}, sub_index: 0x{:02X}, value: {}}}\n", value.index, value.sub_index,
                            *number);
      } else {
        notes.push_back(fmt::format("{}: {} ({})", one.node->name, named(*entry), entry->type->name));
      }
    }
    if (!rows.empty()) text_ += "  sdo:\n" + rows;
  }

  const Network& network_;
  const NetworkNode& master_;
  std::string text_;
  std::set<std::string> keys_;
};

}  // namespace

/// File names may not differ in case only.
std::string lely_dcf_file(const NetworkNode& node) {
  std::string file = node_file(node, "dcf");
  return equal_ignoring_case(file, "master.dcf") ? fmt::format("master_{}.dcf", node.node_id) : file;
}

LelyFiles lely_files(const Network& network, const NetworkNode& master, std::vector<LelyNode> nodes) {
  LelyFiles files;
  files.bus_yml = {"bus.yml", BusYml{network, master}.text(nodes, files.notes)};
  const auto own = std::ranges::find(nodes, &master, &LelyNode::node);
  if (own != nodes.end()) files.master_dcf = {lely_dcf_file(master), master_text(std::move(own->dcf))};
  return files;
}

}  // namespace edsc
