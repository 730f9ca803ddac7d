#include "device/complete_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <canopen/pdo/pdo_parameters.hpp>
#include <canopen/storage/parameter_ranges.hpp>

#include "device/cob_id_parameter.hpp"
#include "device/index_range.hpp"

namespace edsc {
namespace {

using canopen::CobId;
using canopen::DataClass;

constexpr std::uint16_t first_profile_index = 0x2000;
constexpr std::uint16_t pre_defined_error_field = 0x1003;
constexpr std::uint16_t default_sdo = 0x1200;
constexpr std::uint8_t type_sub_index = 2;
constexpr std::string_view sub_index_0_clause = "7.4.4";

constexpr std::array rpdo_communication = {IndexRange{0x1400, 0x15FF}};
constexpr std::array tpdo_communication = {IndexRange{0x1800, 0x19FF}};

/// Values that count errors: 0 at start, regardless of the values in the device from which the file was made.
struct ErrorValue {
  std::uint16_t index;
  std::string_view clause;
};
constexpr ErrorValue error_values[] = {{0x1001, "7.5.2.2"}, {pre_defined_error_field, "7.5.2.4"}};

/// The values of 1010h and 1011h when read: defined bits; the others are 0.
struct StorageCapability {
  std::uint16_t index;
  std::uint64_t bits;
  std::string_view clause;
};
constexpr StorageCapability storage_capabilities[] = {{0x1010, 0x3, "7.5.2.13"}, {0x1011, 0x1, "7.5.2.14"}};
constexpr std::uint64_t on_command = 1;
constexpr std::uint64_t autonomously = 2;
constexpr std::uint16_t store_parameters = 0x1010;

std::string spelled(const Value& value) {
  if (value.plus_node_id) return fmt::format("$NODEID+0x{:X}", value.bits);
  return value.hexadecimal ? fmt::format("0x{:X}", value.bits) : fmt::format("{}", value.bits);
}

/// Whether the entry can hold the value.
bool holds(const Entry& entry, std::uint64_t bits) {
  const DataClass kind = entry.type->kind;
  if (kind != DataClass::unsigned_integer && kind != DataClass::signed_integer) return false;
  return entry.type->bits >= 64 || bits >> entry.type->bits == 0;
}

class Completion {
 public:
  Completion(Device& device, const Options& options, Diagnostics& diagnostics)
      : device_{device}, options_{options}, diagnostics_{diagnostics} {}

  void complete() {
    for (Object& object : device_.objects) {
      if (object.index >= first_profile_index) break;
      if (object.has_sub_indices()) complete_sub_index_0(object);
      for (Entry& entry : object.entries) complete(entry, object);
    }
  }

 private:
  void complete(Entry& entry, const Object& object) {
    if (const CobIdParameter* parameter = find_cob_id_parameter(entry.index, entry.sub_index)) {
      complete_cob_id(*parameter, entry);
    } else if (entry.sub_index == type_sub_index && object.has_sub_indices()) {
      if (contains(rpdo_communication, entry.index)) complete_transmission_type(true, entry);
      if (contains(tpdo_communication, entry.index)) complete_transmission_type(false, entry);
    }
    clear_error(entry);
    complete_storage_capability(entry, object);
    complete_sync_counter(entry);
    complete_error_behavior(entry, object);
  }

  // ---- sub-index 0 ----

  /// Sub-index 0 as the highest sub-index, unless it counts something else (7.4.4).
  void complete_sub_index_0(Object& object) {
    Entry& count = object.entries.front();
    if (count.sub_index != 0 || object.index == pre_defined_error_field || !count.default_value) return;
    if (!count.default_value->clause.empty()) {
      note("implied-default", count.position,
           fmt::format("{} has no default value; using {} ({})", named(count), count.default_value->bits,
                       by(count.default_value->clause)));
    }
    const std::uint8_t highest = object.highest_sub_index();
    if (contains(mapping_parameters, object.index) || count.default_value->bits == highest || !holds(count, highest)) {
      return;
    }
    diagnostics_.warning("sub-index-0-value", count.default_value->position,
                         fmt::format("{} is {}, but the highest sub-index described is {}; using {}", named(count),
                                     count.default_value->bits, highest, highest),
                         {}, fmt::format("{:+}", static_cast<std::int64_t>(count.default_value->bits) - highest));
    diagnostics_.offer_value("sub-index-0-value", count.default_value->position, fmt::format("{}", highest),
                             fmt::format("highest sub-index of {} (CiA 301, 7.4.4)", index_label(object.index)));
    set(count, highest, sub_index_0_clause);
  }

  // ---- COB-IDs ----

  void complete_cob_id(const CobIdParameter& parameter, Entry& entry) {
    Value own = predefined_cob_id(parameter, entry.index, device_.node_id, default_place(entry));
    if (!holds(entry, own.bits)) return;
    if (entry.index == default_sdo) return fix_default_sdo(parameter, std::move(own), entry);
    if (!entry.default_value) {
      note_cob_id(parameter, entry, "has no default value", own);
    } else if (is_can_id_0(parameter, *entry.default_value)) {
      own.bits |= entry.default_value->bits & flags_of(parameter);
      note_cob_id(parameter, entry, "is CAN-ID 000h, which is NMT", own);
    } else {
      return;
    }
    entry.default_value = std::move(own);
  }

  /// The bits other than the CAN-ID and the valid bit.
  static std::uint32_t flags_of(const CobIdParameter& parameter) {
    return CobId::no_rtr_bit | (parameter.has_valid_bit ? 0 : CobId::invalid_bit);
  }

  static bool is_can_id_0(const CobIdParameter& parameter, const Value& value) {
    return !value.plus_node_id && (value.bits & ~std::uint64_t{flags_of(parameter)}) == 0;
  }

  /// The COB-IDs of the default SDO are the same in every device (7.5.2.33).
  void fix_default_sdo(const CobIdParameter& parameter, Value own, Entry& entry) {
    const auto& value = entry.default_value;
    if (value && value->bits == own.bits && value->plus_node_id == own.plus_node_id) return;
    if (!value) {
      note_cob_id(parameter, entry, "has no default value", own);
    } else {
      diagnostics_.warning("default-sdo-cob-id", value->position,
                           fmt::format("{} is {}, but that of the default SDO is {}; using that ({})", named(entry),
                                       spelled(*value), spelled(own), by(own.clause)),
                           {}, "CAN-IDs");
      diagnostics_.offer_value("default-sdo-cob-id", value->position,
                               fmt::format("$NODEID+0x{:X}", parameter.predefined_of(entry.index)),
                               fmt::format("CAN-ID of the default SDO (CiA 301, {})", own.clause));
    }
    entry.default_value = std::move(own);
  }

  void note_cob_id(const CobIdParameter& parameter, const Entry& entry, std::string_view why, const Value& own) {
    const bool off = parameter.has_valid_bit && !CobId{static_cast<std::uint32_t>(own.bits)}.valid();
    note("cob-id-missing", own.position,
         fmt::format("{} {}; using {}{} ({})", named(entry), why, spelled(own), off ? ", which is disabled" : "",
                     by(own.clause)));
  }

  // ---- other values ----

  void complete_transmission_type(bool receive, Entry& entry) {
    if (!holds(entry, default_transmission_type)) return;
    const std::string_view clause = receive ? "7.5.2.35" : "7.5.2.37";
    if (!entry.default_value) {
      note("implied-default", entry.position,
           fmt::format("{} has no default value; using {}, event-driven", named(entry), default_transmission_type));
    } else if (!canopen::transmission_type_is_legal(
                   receive, static_cast<std::uint32_t>(std::min<std::uint64_t>(entry.default_value->bits, 256)))) {
      diagnostics_.warning("pdo-transmission-type", entry.default_value->position,
                           fmt::format("{}: transmission type {} is reserved; using {}, event-driven", named(entry),
                                       entry.default_value->bits, default_transmission_type));
    } else {
      return;
    }
    set(entry, default_transmission_type, clause);
  }

  void clear_error(Entry& entry) {
    const auto row = std::ranges::find(error_values, entry.index, &ErrorValue::index);
    if (row == std::end(error_values) || !entry.default_value || entry.default_value->bits == 0) return;
    if (!holds(entry, 0)) return;
    note("live-default", entry.default_value->position,
         fmt::format("{} is 0 at start, without any error ({}); its default value is not used", named(entry),
                     by(row->clause)));
    set(entry, 0, row->clause);
  }

  void complete_storage_capability(Entry& entry, const Object& object) {
    const auto row = std::ranges::find(storage_capabilities, entry.index, &StorageCapability::index);
    if (row == std::end(storage_capabilities) || (object.has_sub_indices() && entry.sub_index == 0)) return;
    if (!holds(entry, on_command)) return;
    if (!entry.default_value) {
      if (!stores_entries(entry.sub_index)) return;
      diagnostics_.note(
          "storage-default", entry.position,
          fmt::format("{} has no default value; using {}, on command ({})", named(entry), on_command, by(row->clause)));
      return set(entry, on_command, row->clause);
    }
    complete_autonomous_storage(entry, row->clause);
    if ((entry.default_value->bits & ~row->bits) == 0) return complete_unassigned_storage(entry);
    diagnostics_.warning("storage-capability", entry.default_value->position,
                         fmt::format("{} is 0x{:X}, but only the bits 0x{:X} are defined; using {}, on command",
                                     named(entry), entry.default_value->bits, row->bits, on_command));
    set(entry, on_command, row->clause);
  }

  /// Whether entries are assigned to a sub-index of 1010h and 1011h, by CiA 301 or by the options.
  [[nodiscard]] bool stores_entries(std::uint8_t sub_index) const {
    if (sub_index < canopen::first_group_sub_index) return true;
    return std::ranges::any_of(options_.stored_by, [&](const auto& row) { return row.second == sub_index; });
  }

  /// A node stores when it gets the command; what the application stores by itself is known from the options.
  void complete_autonomous_storage(Entry& entry, std::string_view clause) {
    const std::uint64_t bits = entry.default_value->bits;
    if (entry.index != store_parameters || bits > (on_command | autonomously) || (bits & autonomously) == 0) return;
    if (std::ranges::find(options_.autonomous_storage, entry.sub_index) != options_.autonomous_storage.end()) return;
    diagnostics_.note(
        "storage-autonomous", entry.default_value->position,
        fmt::format("{} is {}: the device stores by itself (bit 1), but a node stores on command; using {}; the option "
                    "storage.autonomous keeps the bit for an application that stores by itself",
                    named(entry), bits, bits & on_command),
        {}, "bit 1");
    set(entry, bits & on_command, clause);
  }

  void complete_unassigned_storage(const Entry& entry) {
    if ((entry.default_value->bits & on_command) == 0 || stores_entries(entry.sub_index)) return;
    note("storage-sub-index", entry.default_value->position,
         fmt::format("{} is {}, on command, but no entries are assigned to it; assign them by the option "
                     "storage.sub_indices, or the application handles the command",
                     named(entry), entry.default_value->bits));
  }

  void complete_sync_counter(Entry& entry) {
    if (entry.index != 0x1019 || !entry.default_value || !holds(entry, 0)) return;
    const std::uint64_t overflow = entry.default_value->bits;
    if (overflow != 1 && overflow <= 240) return;
    diagnostics_.warning(
        "sync-counter", entry.default_value->position,
        fmt::format("{} must be 0 or 2..240, not {}; using 0, SYNC is not counted", named(entry), overflow));
    set(entry, 0, "7.5.2.22");
  }

  void complete_error_behavior(Entry& entry, const Object& object) {
    if (entry.index != 0x1029 || !entry.default_value || !holds(entry, 0)) return;
    if (object.has_sub_indices() && entry.sub_index == 0) return;
    const std::uint64_t behavior = entry.default_value->bits;
    if (behavior <= 2 || behavior >= 0x80) return;
    diagnostics_.warning("error-behavior", entry.default_value->position,
                         fmt::format("{} must be 0, 1, 2, or 80h and above; {} is reserved; using 0, Pre-operational",
                                     named(entry), behavior));
    set(entry, 0, "7.5.2.32");
  }

  // ---- helpers ----

  static void set(Entry& entry, std::uint64_t bits, std::string_view clause) {
    entry.default_value = Value{.bits = bits, .position = default_place(entry), .clause = clause};
  }

  static std::string by(std::string_view clause) { return fmt::format("CiA 301, {}", clause); }

  void note(NoteRule rule, const Position& position, std::string message) {
    diagnostics_.note(rule, position, std::move(message));
  }

  Device& device_;
  const Options& options_;
  Diagnostics& diagnostics_;
};

}  // namespace

void complete_device(Device& device, const Options& options, Diagnostics& diagnostics) {
  Completion{device, options, diagnostics}.complete();
}

}  // namespace edsc
