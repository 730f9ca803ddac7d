#include "compare/change.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace edsc {
namespace {

using enum ChangeId;

constexpr bool master = true;
constexpr bool pdo = true;
constexpr bool none = false;

constexpr std::array kinds = {
    // The device.
    ChangeKind{identity, "identity", master, none, "identity",
               "a master that checks device type, vendor or product (1F84h to 1F86h) refuses it"},
    ChangeKind{revision_major, "revision-major", master, none, "major revision",
               "it says that the CANopen behaviour is another"},
    ChangeKind{revision_minor, "revision-minor", none, none, "minor revision", "the CANopen behaviour is the same"},
    ChangeKind{device_name, "device-name", none, none, "device name", "people read it, programs do not"},
    ChangeKind{node_id, "node-id", master, pdo, "node-ID", "the device is found under other COB-IDs"},
    ChangeKind{dummy_removed, "dummy-removed", master, none, "dummy mapping removed",
               "a mapping of an RPDO that has this dummy is refused"},
    ChangeKind{dummy_added, "dummy-added", none, none, "dummy mapping added", "nobody uses it yet"},
    // Objects and entries.
    ChangeKind{object_removed, "object-removed", master, none, "object removed",
               "an access is aborted with 0602 0000h"},
    ChangeKind{object_added, "object-added", none, none, "object added", "nobody uses it yet"},
    ChangeKind{object_type, "object-type", master, none, "object code", "sub-indices and generated types are others"},
    ChangeKind{entry_removed, "entry-removed", master, none, "sub-index removed",
               "an access is aborted with 0609 0011h"},
    ChangeKind{entry_added, "entry-added", none, none, "sub-index added", "nobody uses it yet"},
    ChangeKind{identifier, "identifier", master, none, "C++ identifier", "code with the old one does not compile"},
    ChangeKind{name, "name", none, none, "name", "the C++ identifier is the same"},
    ChangeKind{data_type, "data-type", master, none, "data type", "values have another length or meaning"},
    ChangeKind{access_reduced, "access-reduced", master, none, "access", "what was read or written is aborted"},
    ChangeKind{access_extended, "access-extended", none, none, "access", "what was allowed still is"},
    ChangeKind{access_other, "access-other", none, none, "access", "by SDO the same is allowed"},
    ChangeKind{mapping_reduced, "mapping-reduced", master, pdo, "PDO mapping", "a PDO that carries it is refused"},
    ChangeKind{mapping_extended, "mapping-extended", none, none, "PDO mapping", "what could be mapped still can"},
    ChangeKind{limit_narrowed, "limit-narrowed", master, none, "limit", "a value that was taken is refused"},
    ChangeKind{limit_widened, "limit-widened", none, none, "limit", "a value that was taken still is"},
    ChangeKind{limit_read_only, "limit-read-only", none, none, "limit", "nobody writes it"},
    ChangeKind{default_value, "default-value", none, none, "default",
               "a master that configures what it needs does not see it"},
    ChangeKind{service_cob_id, "service-cob-id", master, none, "COB-ID", "the service is found under another one"},
    ChangeKind{heartbeat_slowed, "heartbeat-slowed", master, none, "heartbeat time",
               "a consumer that waits as long as before reports a lost node"},
    // PDOs.
    ChangeKind{pdo_removed, "pdo-removed", master, pdo, "PDO removed", "nobody sends or takes it any more"},
    ChangeKind{pdo_added, "pdo-added", none, none, "PDO added", "nobody waits for it yet"},
    ChangeKind{pdo_disabled, "pdo-disabled", none, pdo, "PDO off by default", "no frame until a master switches it on"},
    ChangeKind{pdo_enabled, "pdo-enabled", none, none, "PDO on by default", "its frames were not there before"},
    ChangeKind{pdo_cob_id, "pdo-cob-id", master, pdo, "COB-ID", "the partner looks for another one"},
    ChangeKind{pdo_transmission, "pdo-transmission", none, pdo, "transmission type",
               "it is sent or taken over at other times"},
    ChangeKind{pdo_timing, "pdo-timing", none, none, "PDO timing", "the contents are the same"},
    ChangeKind{pdo_layout, "pdo-layout", master, pdo, "layout", "the partner finds other values in the frame"},
    ChangeKind{pdo_layout_extended, "pdo-layout-extended", none, none, "layout",
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
      id, std::move(entry), std::move(name), {}, {}, old_position, new_position, kind.breaks_master, kind.breaks_pdo});
}

std::size_t Changes::breaking() const {
  return static_cast<std::size_t>(std::ranges::count_if(all_, &Change::is_breaking));
}

}  // namespace edsc
