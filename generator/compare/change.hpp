/// The table of changes between two versions of a device, and what each breaks.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

enum class ChangeId : std::uint8_t {
  identity,
  revision_major,
  revision_unchanged,
  revision_minor,
  device_name,
  node_id,
  dummy_removed,
  dummy_added,
  object_removed,
  object_added,
  object_type,
  entry_removed,
  entry_added,
  identifier,
  name,
  data_type,
  access_reduced,
  access_extended,
  access_other,
  mapping_reduced,
  mapping_extended,
  limit_narrowed,
  limit_widened,
  limit_read_only,
  default_value,
  service_cob_id,
  service_disabled,
  service_enabled,
  sync_started,
  sync_stopped,
  time_started,
  time_stopped,
  time_ignored,
  time_consumed,
  frame_format,
  sdo_dynamic,
  cob_id_flag,
  heartbeat_slowed,
  pdo_removed,
  pdo_added,
  pdo_disabled,
  pdo_enabled,
  pdo_cob_id,
  rtr_disabled,
  rtr_enabled,
  pdo_transmission,
  pdo_timing,
  pdo_layout,
  pdo_layout_extended,
  stored_value_lost,
};

struct ChangeKind {
  ChangeId id;
  std::string_view name;    ///< as `edsc diff` prints it; stable
  bool breaks_master;       ///< breaks programs that access the device by SDO, or supervise it
  bool breaks_pdo;          ///< breaks devices that send its RPDOs or receive its TPDOs
  bool breaks_source;       ///< breaks code that is compiled against the generated headers
  std::string_view what;    ///< the changed property
  std::string_view reason;  ///< why it is breaking, or why not
};

[[nodiscard]] std::span<const ChangeKind> all_change_kinds();
[[nodiscard]] const ChangeKind& kind_of(ChangeId id);

/// One difference. On a side without the entry, the position is the whole file.
struct Change {
  ChangeId id;
  std::string entry;      ///< `6040h:00`, `1018h`, `TPDO 1` or `device`
  std::string name;       ///< of the entry; may be empty
  std::string old_value;  ///< empty if there is none
  std::string new_value;
  Position old_position;
  Position new_position;
  bool breaks_master = false;
  bool breaks_pdo = false;
  bool breaks_source = false;
  bool breaks_storage = false;  ///< parameters that the device has stored are not loaded

  [[nodiscard]] bool is_breaking() const { return breaks_master || breaks_pdo || breaks_source || breaks_storage; }
};

/// The property, its old and new value, and the consequence, in one sentence.
[[nodiscard]] std::string message_of(const Change& change);

/// The audience of a comparison.
enum class Audience : std::uint8_t {
  all,
  wire,    ///< masters and PDO partners: devices on the same bus
  source,  ///< code that is compiled against the generated headers
};

/// Collects changes; the table states what each breaks, unless the caller does.
class Changes {
 public:
  Change& add(ChangeId id, std::string entry, std::string name, const Position& old_position,
              const Position& new_position);

  /// Drops the changes that break only other audiences; the others then break only this audience.
  void keep(Audience audience);
  /// Adds the changes of another device.
  void append(Changes more);

  [[nodiscard]] const std::vector<Change>& all() const { return all_; }
  [[nodiscard]] std::size_t breaking() const;

 private:
  std::vector<Change> all_;
};

}  // namespace edsc
