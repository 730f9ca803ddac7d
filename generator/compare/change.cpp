#include "compare/change.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <utility>

namespace edsc {
namespace {

using enum ChangeId;

constexpr bool master = true;
constexpr bool pdo = true;
constexpr bool source = true;
constexpr bool none = false;

constexpr std::array kinds = {
    // The device.
    ChangeKind{identity, "identity", master, none, none, "identity",
               "a master that checks device type, vendor or product (1F84h to 1F86h) rejects it"},
    ChangeKind{revision_major, "revision-major", master, none, none, "major revision",
               "it states that the CANopen behaviour has changed"},
    ChangeKind{
        revision_unchanged, "revision-unchanged", master, none, none, "major revision",
        "a breaking change requires a higher one in 1018h:03, bits 31..16; a master that checks it (1F88h) cannot "
        "tell the devices apart"},
    ChangeKind{revision_minor, "revision-minor", none, none, none, "minor revision",
               "the CANopen behaviour is the same"},
    ChangeKind{device_name, "device-name", none, none, none, "device name", "it is for people, not for programs"},
    ChangeKind{node_id, "node-id", master, pdo, none, "node-ID", "the device uses other COB-IDs"},
    ChangeKind{dummy_removed, "dummy-removed", master, none, source, "dummy mapping removed",
               "an RPDO mapping with this dummy is rejected"},
    ChangeKind{dummy_added, "dummy-added", none, none, none, "dummy mapping added", "not used yet"},
    // Objects and entries.
    ChangeKind{object_removed, "object-removed", master, none, source, "object removed",
               "an access is aborted with 0602 0000h"},
    ChangeKind{object_added, "object-added", none, none, none, "object added", "not used yet"},
    ChangeKind{object_type, "object-type", master, none, source, "object code",
               "sub-indices and generated types change"},
    ChangeKind{entry_removed, "entry-removed", master, none, source, "sub-index removed",
               "an access is aborted with 0609 0011h"},
    ChangeKind{entry_added, "entry-added", none, none, none, "sub-index added", "not used yet"},
    ChangeKind{identifier, "identifier", none, none, source, "C++ identifier",
               "code with the old one does not compile"},
    ChangeKind{name, "name", none, none, none, "name", "the C++ identifier is the same"},
    ChangeKind{data_type, "data-type", master, none, source, "data type", "values have another length or meaning"},
    ChangeKind{access_reduced, "access-reduced", master, none, source, "access",
               "an access that was allowed is aborted"},
    ChangeKind{access_extended, "access-extended", none, none, none, "access",
               "all accesses that were allowed still are"},
    ChangeKind{access_other, "access-other", none, none, none, "access", "SDO access is unchanged"},
    ChangeKind{mapping_reduced, "mapping-reduced", master, pdo, source, "PDO mapping",
               "a PDO that maps it is rejected"},
    ChangeKind{mapping_extended, "mapping-extended", none, none, none, "PDO mapping",
               "all mappings that were possible still are"},
    ChangeKind{limit_narrowed, "limit-narrowed", master, none, source, "limit",
               "a value that was accepted is rejected"},
    ChangeKind{limit_widened, "limit-widened", none, none, none, "limit", "all values that were accepted still are"},
    ChangeKind{limit_read_only, "limit-read-only", none, none, none, "limit", "the entry is not writable"},
    ChangeKind{default_value, "default-value", none, none, none, "default",
               "a master that configures what it needs is not affected"},
    ChangeKind{service_cob_id, "service-cob-id", master, none, none, "CAN-ID", "the service uses another CAN-ID"},
    ChangeKind{service_disabled, "service-disabled", master, none, none, "bit 31 (does not exist) set",
               "the service does not exist until a master enables it"},
    ChangeKind{service_enabled, "service-enabled", none, none, none, "bit 31 (does not exist) cleared",
               "the service did not exist before"},
    ChangeKind{sync_started, "sync-started", master, pdo, none, "bit 30 (produces SYNC) set",
               "with another SYNC producer on the bus, synchronous PDOs are sent and applied at wrong times"},
    ChangeKind{sync_stopped, "sync-stopped", master, pdo, none, "bit 30 (produces SYNC) cleared",
               "no synchronous PDO is sent or applied without SYNC"},
    ChangeKind{time_started, "time-started", master, none, none, "bit 30 (produces TIME) set",
               "another TIME producer on the bus sets the clocks to another time"},
    ChangeKind{time_stopped, "time-stopped", master, none, none, "bit 30 (produces TIME) cleared",
               "consumers of its TIME do not receive it"},
    ChangeKind{time_ignored, "time-ignored", master, none, none, "bit 31 (consumes TIME) cleared",
               "a master does not set the clock of the device"},
    ChangeKind{time_consumed, "time-consumed", none, none, none, "bit 31 (consumes TIME) set",
               "a master that does not send TIME is not affected"},
    ChangeKind{frame_format, "frame-format", master, pdo, none, "bit 29 (29-bit CAN-ID)",
               "frames with 11-bit and 29-bit CAN-ID are different frames"},
    ChangeKind{sdo_dynamic, "sdo-dynamic", none, none, none, "bit 30 (assigned dynamically)", "the CAN-ID is the same"},
    ChangeKind{cob_id_flag, "cob-id-flag", none, none, none, "unused flag bit", "no service uses it"},
    ChangeKind{heartbeat_slowed, "heartbeat-slowed", master, none, none, "heartbeat time",
               "a consumer with the old time reports a lost node"},
    // PDOs.
    ChangeKind{pdo_removed, "pdo-removed", master, pdo, source, "PDO removed", "it is no longer sent or received"},
    ChangeKind{pdo_added, "pdo-added", none, none, none, "PDO added", "not used yet"},
    ChangeKind{pdo_disabled, "pdo-disabled", none, pdo, none, "PDO disabled by default (bit 31 set)",
               "not sent or received until a master enables it"},
    ChangeKind{pdo_enabled, "pdo-enabled", none, none, none, "PDO enabled by default (bit 31 cleared)",
               "its frames are new on the bus"},
    ChangeKind{pdo_cob_id, "pdo-cob-id", master, pdo, none, "CAN-ID", "the partner uses the old one"},
    ChangeKind{rtr_disabled, "rtr-disabled", none, pdo, none, "bit 30 (no remote frames) set",
               "a remote frame for the PDO is not answered"},
    ChangeKind{rtr_enabled, "rtr-enabled", none, none, none, "bit 30 (no remote frames) cleared",
               "remote frames are answered, but not required"},
    ChangeKind{pdo_transmission, "pdo-transmission", none, pdo, none, "transmission type",
               "it is sent or applied at other times"},
    ChangeKind{pdo_timing, "pdo-timing", none, none, none, "PDO timing", "the contents are the same"},
    ChangeKind{pdo_layout, "pdo-layout", master, pdo, source, "layout",
               "the partner reads other values from the frame"},
    ChangeKind{pdo_layout_extended, "pdo-layout-extended", none, none, none, "layout",
               "all values that were in the frame keep their position"},
    // Stored parameters.
    ChangeKind{stored_value_lost, "stored-value-lost", none, none, none, "stored value lost",
               "a device that has stored it starts with the default value and sends EMCY 6300h, unless its application "
               "converts the value"},
};

constexpr bool stands_in_order() {
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (static_cast<std::size_t>(kinds[i].id) != i) return false;
  }
  return kinds.size() == static_cast<std::size_t>(stored_value_lost) + 1;
}
static_assert(stands_in_order(), "the table has a row for each ChangeId, in its order");

}  // namespace

std::span<const ChangeKind> all_change_kinds() { return kinds; }

const ChangeKind& kind_of(ChangeId id) { return kinds[static_cast<std::size_t>(id)]; }

std::string message_of(const Change& change) {
  const ChangeKind& kind = kind_of(change.id);
  std::string text{kind.what};
  if (!change.old_value.empty() && !change.new_value.empty()) {
    text += fmt::format(" {} becomes {}", change.old_value, change.new_value);
  } else if (!change.old_value.empty() || !change.new_value.empty()) {
    text += fmt::format(" {}", change.old_value.empty() ? change.new_value : change.old_value);
  }
  return fmt::format("{}: {}", text, kind.reason);
}

Change& Changes::add(ChangeId id, std::string entry, std::string name, const Position& old_position,
                     const Position& new_position) {
  const ChangeKind& kind = kind_of(id);
  return all_.emplace_back(Change{id,
                                  std::move(entry),
                                  std::move(name),
                                  {},
                                  {},
                                  old_position,
                                  new_position,
                                  kind.breaks_master,
                                  kind.breaks_pdo,
                                  kind.breaks_source,
                                  id == ChangeId::stored_value_lost});
}

void Changes::keep(Audience audience) {
  if (audience == Audience::all) return;
  std::erase_if(all_, [&](Change& change) {
    const bool was_breaking = change.is_breaking();
    (audience == Audience::wire ? change.breaks_source : change.breaks_master) = false;
    if (audience == Audience::source) change.breaks_pdo = false;
    change.breaks_storage = false;
    return was_breaking && !change.is_breaking();
  });
}

void Changes::append(Changes more) {
  all_.insert(all_.end(), std::make_move_iterator(more.all_.begin()), std::make_move_iterator(more.all_.end()));
}

std::size_t Changes::breaking() const {
  return static_cast<std::size_t>(std::ranges::count_if(all_, &Change::is_breaking));
}

}  // namespace edsc
