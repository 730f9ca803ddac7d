/// Behaviour of a device that an EDS cannot express. The defaults are those of CiA 301.
#pragma once

#include <cstdint>
#include <optional>

#include "canopen/can/cob_id.hpp"

namespace canopen {

/// Whether 1010h stores the value of an entry.
enum class Storing : std::uint8_t {
  by_access,  ///< parameters are stored, process data are not
  always,
  never,
  with_node_id,  ///< stored, and valid only for the node-ID that it was stored with; not affected by "load"
  first_group,   ///< stored by 1010h:05 and :01; those after it by 1010h:06 to :0E and :01
};

/// Entries that a sub-index of 1010h from 05h to 0Eh stores, and :01 with all others.
[[nodiscard]] constexpr Storing stored_by(std::uint8_t sub_index) {
  return static_cast<Storing>(static_cast<std::uint8_t>(Storing::first_group) + sub_index - 5);
}
/// Returns the sub-index of `stored_by`.
[[nodiscard]] constexpr std::uint8_t sub_index_of(Storing storing) {
  return static_cast<std::uint8_t>(static_cast<std::uint8_t>(storing) -
                                   static_cast<std::uint8_t>(Storing::first_group) + 5);
}

struct DeviceOptions {
  /// Bits of 1400h..15FFh:01 and 1800h..19FFh:01 that a write can change; the others silently keep their value.
  std::uint32_t pdo_cob_id_writable = 0xFFFF'FFFF;
  /// First and last CAN-ID of a range that PDOs may not use, in addition to those of CiA 301: 0609 0030h. {1, 0}: none.
  RestrictedCanIds pdo_reserved_can_ids{1, 0};
  /// First and last CAN-ID of a range that PDOs may use although CiA 301, 7.3.5 restricts it, as an application profile
  /// defines them: 180h of CiA 417. {1, 0}: none.
  RestrictedCanIds pdo_allowed_can_ids{1, 0};
  /// PDOs may have 29-bit CAN-IDs. If false, a write with bit 29 set is rejected: 0609 0030h.
  bool pdo_extended_ids = true;
  /// TPDOs respond to remote frames. If false, bit 30 of their COB-ID must be 1, and transmission types 252 and 253 are
  /// rejected: 0609 0030h.
  bool tpdo_remote_frames = true;
  /// Bit 30 of 1800h..19FFh:01 may be 1. If false: 0609 0030h.
  bool tpdo_remote_frames_can_be_disabled = true;
  /// TPDOs may have transmission types 252 and 253. If false: 0609 0030h.
  bool tpdo_remote_types = true;
  /// Unit of 1800h..19FFh:03, in us.
  std::uint16_t inhibit_time_unit = 100;
  /// 1800h..19FFh:03 may change while the PDO is valid. If false: 0800 0022h.
  bool inhibit_time_writable_while_valid = false;
  /// 1800h..19FFh:06 may change while the PDO is valid. If false: 0800 0022h.
  bool sync_start_writable_while_valid = false;
  /// TPDOs of transmission types 254 and 255 are sent when a mapped object changes and on entering Operational. If
  /// false, only their event timer sends them.
  bool event_driven_on_change = true;
  /// A TPDO of transmission type 0 is sent at the next SYNC after a mapped object has changed. If false, at every SYNC.
  bool tpdo_acyclic_on_change = true;
  /// The mapping of a PDO may be written while the PDO is valid, as long as its number of mapped objects is 0. If
  /// false: 0601 0000h.
  bool pdo_mapping_writable_while_valid = false;
  /// Abort code for a number of mapped objects that does not result in a valid mapping.
  std::uint32_t pdo_mapping_abort_code = 0x0604'0042;
  /// Multiplex PDOs are supported: 254 and 255 mapped objects.
  bool mpdo = false;
  /// Bits of 1005h that a write can change; the others silently keep their value.
  std::uint32_t sync_cob_id_writable = 0xFFFF'FFFF;
  /// Bits of 1014h that a write can change; the others silently keep their value.
  std::uint32_t emcy_cob_id_writable = 0xFFFF'FFFF;
  /// The CAN-ID in 1014h may change while EMCY is valid. If false: 0609 0030h.
  bool emcy_cob_id_writable_while_valid = false;
  /// 1015h accepts only multiples of this, in units of 100 us: 0609 0030h for others.
  std::uint16_t emcy_inhibit_time_step = 1;
  /// Only the last of the EMCYs that wait in Stopped is sent. If false, all of them are.
  bool emcy_stopped_keeps_last = false;
  /// Emergency error code of an EMCY that is sent before an NMT reset, with the manufacturer-specific bit of
  /// 1001h. 0: none.
  std::uint16_t reset_emergency = 0;
  /// 1003h also records the EMCYs that report the end of an error.
  bool error_history_keeps_resets = false;
  /// Abort code for a write of any value but 0 to 1003h:00.
  std::uint32_t error_history_abort_code = 0x0609'0030;
  /// An element of 1003h above the number of errors is 0. If false, 0800 0024h aborts its upload.
  bool error_history_empty_is_zero = false;
  /// The high half of an element of 1003h has the first two manufacturer-specific bytes of the EMCY. If false, it is 0.
  bool error_history_has_info = true;
  /// Expedited uploads indicate the number of valid bytes. If false, their command byte is 42h.
  bool sdo_upload_size_indicated = true;
  /// A value that is too long is rejected with 0607 0012h, one that is too short with 0607 0013h. If false, both with
  /// 0607 0010h.
  bool sdo_length_codes = true;
  /// The SDO server supports block transfer. If false, it aborts a block initiate with 0504 0001h.
  bool sdo_block_transfer = false;
  /// Milliseconds without a frame after which the SDO server aborts a segmented or block transfer: 0504 0000h.
  /// 0: never. Not set: see `sdo_timeout_of`.
  std::optional<std::uint16_t> sdo_timeout = std::nullopt;
  /// Abort code for a write of anything but "save" to 1010h or "load" to 1011h.
  std::uint32_t storage_signature_abort_code = 0x0800'0020;
  /// Bits of 6502h for modes that 6060h accepts in addition to those of 6502h in the EDS (CiA 402).
  std::uint32_t drive_additional_modes = 0;
  /// Number of the meaning of the stored values, which the application changes with the meaning: a value that was
  /// stored with another one is passed to its function `on_stored_value`.
  std::uint8_t storage_version = 0;
  /// Parameters are also loaded from images of the first format, which earlier versions of edsc wrote.
  bool storage_first_format = true;
  /// After "load" the values in use survive NMT resets: the default values take effect at the next power-on.
  bool restore_needs_power_cycle = false;
};

/// Returns the SDO timeout of a device in milliseconds; 0: none. During a block download a server interprets every
/// frame as a segment and could not be reached after its client had disappeared: a server with block transfer therefore
/// has a timeout by default.
[[nodiscard]] constexpr std::uint16_t sdo_timeout_of(const DeviceOptions& options) {
  constexpr std::uint16_t with_blocks = 1000;
  return options.sdo_timeout.value_or(options.sdo_block_transfer ? with_blocks : std::uint16_t{0});
}

}  // namespace canopen
