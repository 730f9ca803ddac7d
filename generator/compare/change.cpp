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
               "a master that checks device type, vendor or product (1F84h to 1F86h) refuses it"},
    ChangeKind{revision_major, "revision-major", master, none, none, "major revision",
               "it says that the CANopen behaviour is another"},
    ChangeKind{revision_unchanged, "revision-unchanged", master, none, none, "major revision",
               "a breaking change needs a higher one in 1018h:03, bits 31..16; a master that checks it (1F88h) takes the "
               "device for the old one"},
    ChangeKind{revision_minor, "revision-minor", none, none, none, "minor revision", "the CANopen behaviour is the same"},
    ChangeKind{device_name, "device-name", none, none, none, "device name", "people read it, programs do not"},
    ChangeKind{node_id, "node-id", master, pdo, none, "node-ID", "the device is found under other COB-IDs"},
    ChangeKind{dummy_removed, "dummy-removed", master, none, source, "dummy mapping removed",
               "a mapping of an RPDO that has this dummy is refused"},
    ChangeKind{dummy_added, "dummy-added", none, none, none, "dummy mapping added", "nobody uses it yet"},
    // Objects and entries.
    ChangeKind{object_removed, "object-removed", master, none, source, "object removed",
               "an access is aborted with 0602 0000h"},
    ChangeKind{object_added, "object-added", none, none, none, "object added", "nobody uses it yet"},
    ChangeKind{object_type, "object-type", master, none, source, "object code", "sub-indices and generated types are others"},
    ChangeKind{entry_removed, "entry-removed", master, none, source, "sub-index removed",
               "an access is aborted with 0609 0011h"},
    ChangeKind{entry_added, "entry-added", none, none, none, "sub-index added", "nobody uses it yet"},
    ChangeKind{identifier, "identifier", none, none, source, "C++ identifier", "code with the old one does not compile"},
    ChangeKind{name, "name", none, none, none, "name", "the C++ identifier is the same"},
    ChangeKind{data_type, "data-type", master, none, source, "data type", "values have another length or meaning"},
    ChangeKind{access_reduced, "access-reduced", master, none, source, "access", "what was read or written is aborted"},
    ChangeKind{access_extended, "access-extended", none, none, none, "access", "what was allowed still is"},
    ChangeKind{access_other, "access-other", none, none, none, "access", "by SDO the same is allowed"},
    ChangeKind{mapping_reduced, "mapping-reduced", master, pdo, source, "PDO mapping", "a PDO that carries it is refused"},
    ChangeKind{mapping_extended, "mapping-extended", none, none, none, "PDO mapping", "what could be mapped still can"},
    ChangeKind{limit_narrowed, "limit-narrowed", master, none, source, "limit", "a value that was taken is refused"},
    ChangeKind{limit_widened, "limit-widened", none, none, none, "limit", "a value that was taken still is"},
    ChangeKind{limit_read_only, "limit-read-only", none, none, none, "limit", "nobody writes it"},
    ChangeKind{default_value, "default-value", none, none, none, "default",
               "a master that configures what it needs does not see it"},
    ChangeKind{service_cob_id, "service-cob-id", master, none, none, "CAN-ID", "the service uses another one"},
    ChangeKind{service_disabled, "service-disabled", master, none, none, "bit 31 (does not exist) set",
               "the service does not exist until a master enables it"},
    ChangeKind{service_enabled, "service-enabled", none, none, none, "bit 31 (does not exist) cleared",
               "the service did not exist before"},
    ChangeKind{sync_started, "sync-started", master, pdo, none, "bit 30 (produces SYNC) set",
               "with another SYNC producer on the bus, synchronous PDOs are sent and taken over at wrong times"},
    ChangeKind{sync_stopped, "sync-stopped", master, pdo, none, "bit 30 (produces SYNC) cleared",
               "no synchronous PDO is sent or taken over without a SYNC"},
    ChangeKind{time_started, "time-started", master, none, none, "bit 30 (produces TIME) set",
               "another TIME producer on the bus sets the clocks to another time"},
    ChangeKind{time_stopped, "time-stopped", master, none, none, "bit 30 (produces TIME) cleared",
               "what consumes its TIME does not get it"},
    ChangeKind{time_ignored, "time-ignored", master, none, none, "bit 31 (consumes TIME) cleared",
               "a master does not set the clock of the device"},
    ChangeKind{time_consumed, "time-consumed", none, none, none, "bit 31 (consumes TIME) set",
               "a master that sends no TIME does not notice"},
    ChangeKind{frame_format, "frame-format", master, pdo, none, "bit 29 (29-bit CAN-ID)",
               "a frame of the other format is another frame"},
    ChangeKind{sdo_dynamic, "sdo-dynamic", none, none, none, "bit 30 (assigned dynamically)",
               "the CAN-ID is the same"},
    ChangeKind{cob_id_flag, "cob-id-flag", none, none, none, "unused flag bit", "no service uses it"},
    ChangeKind{heartbeat_slowed, "heartbeat-slowed", master, none, none, "heartbeat time",
               "a consumer that waits as long as before reports a lost node"},
    // PDOs.
    ChangeKind{pdo_removed, "pdo-removed", master, pdo, source, "PDO removed", "nobody sends or takes it any more"},
    ChangeKind{pdo_added, "pdo-added", none, none, none, "PDO added", "nobody waits for it yet"},
    ChangeKind{pdo_disabled, "pdo-disabled", none, pdo, none, "PDO off by default (bit 31 set)",
               "no frame until a master switches it on"},
    ChangeKind{pdo_enabled, "pdo-enabled", none, none, none, "PDO on by default (bit 31 cleared)",
               "its frames were not there before"},
    ChangeKind{pdo_cob_id, "pdo-cob-id", master, pdo, none, "CAN-ID", "the partner uses another one"},
    ChangeKind{rtr_disabled, "rtr-disabled", none, pdo, none, "bit 30 (no remote frames) set",
               "a partner that requests the PDO with a remote frame gets no answer"},
    ChangeKind{rtr_enabled, "rtr-enabled", none, none, none, "bit 30 (no remote frames) cleared",
               "a remote frame is answered, but need not be sent"},
    ChangeKind{pdo_transmission, "pdo-transmission", none, pdo, none, "transmission type",
               "it is sent or taken over at other times"},
    ChangeKind{pdo_timing, "pdo-timing", none, none, none, "PDO timing", "the contents are the same"},
    ChangeKind{pdo_layout, "pdo-layout", master, pdo, source, "layout", "the partner finds other values in the frame"},
    ChangeKind{pdo_layout_extended, "pdo-layout-extended", none, none, none, "layout",
               "what was in the frame before still is, at its place"},
};

constexpr bool stands_in_order() {
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (static_cast<std::size_t>(kinds[i].id) != i) return false;
  }
  return kinds.size() == static_cast<std::size_t>(pdo_layout_extended) + 1;
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
  return all_.emplace_back(Change{
      id, std::move(entry), std::move(name), {}, {}, old_position, new_position, kind.breaks_master, kind.breaks_pdo,
      kind.breaks_source});
}

void Changes::keep(Audience audience) {
  if (audience == Audience::all) return;
  std::erase_if(all_, [&](Change& change) {
    const bool was_breaking = change.is_breaking();
    (audience == Audience::wire ? change.breaks_source : change.breaks_master) = false;
    if (audience == Audience::source) change.breaks_pdo = false;
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
