/// Behaviour of a device that an EDS has no words for. The defaults are those of CiA 301.
#pragma once

#include <cstdint>
#include <optional>

#include "canopen/cob_id.hpp"

namespace canopen {

/// Whether 1010h stores the value of an entry.
enum class Storing : std::uint8_t {
  by_access,  ///< parameters are, process data are not
  always,
  never,
  with_node_id,  ///< it is, and the value counts for the node-ID that it was stored with; "load" leaves it
};

struct DeviceOptions {
  /// Bits of 1400h..15FFh:01 and 1800h..19FFh:01 that a write changes; the others keep their value silently.
  std::uint32_t pdo_cob_id_writable = 0xFFFF'FFFF;
  /// CAN-IDs that PDOs may not have besides those of CiA 301, the first and the last: 0609 0030h. First 1, last 0: none.
  RestrictedCanIds pdo_reserved_can_ids{1, 0};
  /// PDOs may have 29-bit CAN-IDs. If not, a write with bit 29 set is refused: 0609 0030h.
  bool pdo_extended_ids = true;
  /// TPDOs may answer remote frames. If not, bit 30 of their COB-ID must be 1 and types 252 and 253 are refused: 0609
  /// 0030h.
  bool tpdo_remote_frames = true;
  /// Bit 30 of 1800h..19FFh:01 may be 1. If not: 0609 0030h.
  bool tpdo_remote_frames_can_be_disabled = true;
  /// TPDOs may be of types 252 and 253. If not: 0609 0030h.
  bool tpdo_remote_types = true;
  /// What 1 in 1800h..19FFh:03 stands for, in us.
  std::uint16_t inhibit_time_unit = 100;
  /// 1800h..19FFh:03 may change while the PDO is valid. If not: 0800 0022h.
  bool inhibit_time_writable_while_valid = false;
  /// TPDOs of types 254 and 255 are sent when a mapped object changes and on entering Operational; if not, by their
  /// event timer alone.
  bool event_driven_on_change = true;
  /// A TPDO of type 0 is sent at the next SYNC after a mapped object has changed; if not, at every SYNC.
  bool tpdo_acyclic_on_change = true;
  /// The mapping of a PDO may be written while the PDO is valid, as long as its number of mapped objects is 0. If not:
  /// 0601 0000h.
  bool pdo_mapping_writable_while_valid = false;
  /// The answer to a number of mapped objects that gives no valid mapping.
  std::uint32_t pdo_mapping_abort_code = 0x0604'0042;
  /// Multiplex PDOs: 254 and 255 mapped objects.
  bool mpdo = false;
  /// Bits of 1005h that a write changes; the others keep their value silently.
  std::uint32_t sync_cob_id_writable = 0xFFFF'FFFF;
  /// Bits of 1014h that a write changes; the others keep their value silently.
  std::uint32_t emcy_cob_id_writable = 0xFFFF'FFFF;
  /// The CAN-ID in 1014h may change while EMCY is valid. If not: 0609 0030h.
  bool emcy_cob_id_writable_while_valid = false;
  /// 1015h takes multiples of this: 0609 0030h for others.
  std::uint16_t emcy_inhibit_time_step = 1;
  /// Of the EMCYs that wait in Stopped the last one is sent. If not, all of them.
  bool emcy_stopped_keeps_last = false;
  /// The emergency error code of an EMCY that goes out before a reset over NMT, with the manufacturer's bit of 1001h. 0:
  /// none.
  std::uint16_t reset_emergency = 0;
  /// 1003h keeps the EMCYs that tell the end of an error, too.
  bool error_history_keeps_resets = false;
  /// The answer to a write of anything but 0 to 1003h:00.
  std::uint32_t error_history_abort_code = 0x0609'0030;
  /// Expedited uploads tell how many bytes are valid. If not, they answer 42h.
  bool sdo_upload_size_indicated = true;
  /// A value that is too long is answered with 0607 0012h, one that is too short with 0607 0013h. If not, both: 0607
  /// 0010h.
  bool sdo_length_codes = true;
  /// The SDO server takes block transfers. If not, it answers their initiate with 0504 0001h.
  bool sdo_block_transfer = false;
  /// A segmented or block transfer in which nothing comes for this many milliseconds is aborted: 0504 0000h. 0: never.
  /// Without a value: see `sdo_timeout_of`.
  std::optional<std::uint16_t> sdo_timeout = std::nullopt;
  /// The answer to a write of anything but "save" to 1010h or "load" to 1011h.
  std::uint32_t storage_signature_abort_code = 0x0800'0020;
  /// After "load" the values in use stay over NMT resets: the defaults come with the next power-on.
  bool restore_needs_power_cycle = false;
};

/// The SDO timeout of a device in milliseconds; 0: none. A server in a block download takes every frame for a segment,
/// so that a client that has gone would leave it deaf: one with block transfer has a timeout by default.
[[nodiscard]] constexpr std::uint16_t sdo_timeout_of(const DeviceOptions& options) {
  constexpr std::uint16_t with_blocks = 1000;
  return options.sdo_timeout.value_or(options.sdo_block_transfer ? with_blocks : std::uint16_t{0});
}

}  // namespace canopen
