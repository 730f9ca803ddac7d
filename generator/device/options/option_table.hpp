/// The table of options: what a device does that an EDS cannot express. docs/options.md and its schema are made from
/// it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>

namespace edsc {

/// How an option is written in the options file.
enum class OptionForm : std::uint8_t {
  flag,            ///< true or false
  number,          ///< min to max
  mask,            ///< 32 bits: "0x80000780"
  abort_code,      ///< of CiA 301: "0x06040041"
  emergency_code,  ///< "FF00h"
  can_id_range,    ///< ["0x080", "0x100"]
  structured,
};

[[nodiscard]] constexpr std::string_view to_string(OptionForm form) {
  constexpr std::string_view names[] = {"flag",           "number",       "mask",      "abort_code",
                                        "emergency_code", "can_id_range", "structured"};
  return names[static_cast<std::size_t>(form)];
}

/// Options of one service, in the options file the members of one object: `{"sdo": {"timeout": 500}}`.
struct OptionGroup {
  std::string_view name;  ///< empty: the options are members of the file itself
  std::string_view title;
  std::string_view meaning{};
};

/// A row with a form other than `structured` sets the member `member_of(row)` of canopen::DeviceOptions, in the group
/// `lss` the member `name` of canopen::LssOptions. A structured option has a reader of its own in
/// structured_options.cpp.
struct OptionRow {
  OptionGroup group;
  std::string_view name;       ///< in its group
  std::string_view flat_name;  ///< deprecated name outside the group; empty: none, as for each new option
  OptionForm form;
  std::string_view meaning;
  std::string_view default_value{};  ///< as in the options file; empty: `default_text` describes it
  std::string_view default_text{};
  std::uint32_t min = 0;
  std::uint32_t max = 0;
};

namespace option_table {

using enum OptionForm;
inline constexpr std::string_view all_bits = "\"0xFFFFFFFF\"";

inline constexpr OptionGroup cpp{"", "C++"};
inline constexpr OptionGroup eds{"", "EDS"};
inline constexpr OptionGroup meaning{"", "Values"};
inline constexpr OptionGroup check{"", "check"};
inline constexpr OptionGroup pdo{"pdo", "PDO"};
inline constexpr OptionGroup sync{"sync", "SYNC"};
inline constexpr OptionGroup emcy{"emcy", "EMCY"};
inline constexpr OptionGroup storage{"storage", "storage"};
inline constexpr OptionGroup sdo{"sdo", "SDO"};
inline constexpr OptionGroup drive{"drive", "drive"};
inline constexpr OptionGroup lss{"lss", "LSS", "a device with this group, even if it is empty, supports LSS"};

inline constexpr OptionRow rows[] = {
    {cpp, "names", "", structured,
     "names by entry, instead of those derived from ParameterName: `{\"6040h:00\": \"controlword\"}`; for an element of an "
     "ARRAY, `{\"2000h:01\": \"p\"}` gives `gains_p`. They are used in C++, DBC files, networks, documents and messages"},
    {cpp, "string_capacity", "", structured, "capacity in bytes of strings in RAM, by entry", "",
     "length of the default value, else 16"},
    {cpp, "settable", "", structured,
     "`const` or `ro` entries that the application sets at start-up; they are placed in RAM"},
    {eds, "encoding", "", structured,
     "encoding of the EDS: a name such as `\"Shift-JIS\"`, `\"GB18030\"`, `\"CP1252\"`, [see below](#reading-choices)",
     "", "detected"},
    {eds, "sub_indices", "", structured,
     "`\"decimal\"`: sub-indices in section names are decimal, `[2022sub10]` is 2022h:0A, [see below](#reading-choices)",
     "\"hexadecimal\""},
    {eds, "access_types", "", structured,
     "`\"swapped\"`: the EDS uses `rwr` for `rww` and `rww` for `rwr`, [see below](#reading-choices)", "\"cia306\""},
    {eds, "connected_modules", "", structured,
     "modules connected to a modular device: numbers from [SupportedModules], by slot", "",
     "[ConnectedModules] of a DCF"},
    {eds, "stored_eds", "", structured,
     "1021h holds the EDS: `true` as text, `\"compressed\"` as a gzip file, [see below](#the-eds-stored-in-the-device)",
     "false", "false: the DOMAIN that the application binds"},
    {meaning, "meaning", "", structured,
     "units, scales, names of values and bits, by object or entry, and names of error codes, [see below](#meaning-of-values)"},
    {meaning, "typed_values", "", structured,
     "values with a meaning have a type of their own in C++, [see node.md](node.md#typed-values); `false`: they are numbers. "
     "`false` will be removed in the next version",
     "true"},
    {check, "silence", "", structured,
     "ids of rules whose warnings and notes are not reported; errors are silenced for `edsc check` only"},
    {check, "allow", "", structured,
     "expected findings with a reason, for one object or entry or for the whole file; errors are allowed for `edsc check` only, "
     "[see below](#allowed-findings)"},
    {pdo, "static_mapping", "static_mapping", structured,
     "PDOs with a fixed mapping: `true` for all, or a list of mapping parameters: `[\"1600h\", \"1A00h\"]`, [see "
     "below](#static-and-dynamic-mapping)",
     "", "PDOs whose mapping is not writable in the EDS"},
    {pdo, "no_event", "no_event", structured,
     "objects or entries whose change does not trigger an event-driven TPDO: `[\"6401h\", \"6000h:02\"]`"},
    {pdo, "cob_id_writable", "pdo_cob_id_writable", mask,
     "writable bits of 1400h..15FFh:01 and 1800h..19FFh:01; the other bits keep their value", all_bits},
    {pdo, "reserved_can_ids", "pdo_reserved_can_ids", can_id_range,
     "range of CAN-IDs, first and last, that PDOs must not use, in addition to those restricted by CiA 301: `[\"0x080\", "
     "\"0x100\"]`; 0609 0030h for them",
     "", "none"},
    {pdo, "allowed_can_ids", "pdo_allowed_can_ids", can_id_range,
     "range of CAN-IDs, first and last, that PDOs may use although CiA 301, 7.3.5 restricts it, as an application profile "
     "defines: `[\"0x180\", \"0x180\"]` for RPDO 261 of CiA 417",
     "", "none"},
    {pdo, "extended_ids", "pdo_extended_ids", flag, "PDOs may use 29-bit CAN-IDs; if false, 0609 0030h", "true"},
    {pdo, "remote_frames", "tpdo_remote_frames", flag,
     "TPDOs answer remote frames; if false, bit 30 of their COB-ID must be 1, else 0609 0030h", "true"},
    {pdo, "remote_frames_can_be_disabled", "tpdo_remote_frames_can_be_disabled", flag,
     "bit 30 of a TPDO's COB-ID may be 1; if false, 0609 0030h", "true"},
    {pdo, "remote_types", "tpdo_remote_types", flag,
     "TPDOs accept transmission types 252 and 253; if false, 0609 0030h", "true"},
    {pdo, "inhibit_time_unit", "inhibit_time_unit", number, "unit of the inhibit time 1800h..19FFh:03, in us", "100",
     "", 1, 32767},  // less than half of the time after which canopen::TimePoint wraps
    {pdo, "inhibit_time_writable_while_valid", "inhibit_time_writable_while_valid", flag,
     "1800h..19FFh:03 may be written while the PDO is valid; if false, 0800 0022h. Implied if no TPDO can be disabled",
     "false"},
    {pdo, "sync_start_writable_while_valid", "sync_start_writable_while_valid", flag,
     "1800h..19FFh:06 may be written while the PDO is valid; if false, 0800 0022h. Implied if no TPDO can be disabled",
     "false"},
    {pdo, "event_driven_on_change", "event_driven_on_change", flag,
     "TPDOs of transmission types 254 and 255 are sent when a mapped object changes and on entering Operational; if false, on "
     "the event timer only",
     "true"},
    {pdo, "acyclic_on_change", "tpdo_acyclic_on_change", flag,
     "a TPDO of transmission type 0 is sent at the next SYNC after a mapped object has changed; if false, at every SYNC",
     "true"},
    {pdo, "mapping_writable_while_valid", "pdo_mapping_writable_while_valid", flag,
     "1600h..17FFh and 1A00h..1BFFh may be written while the PDO is valid if sub-index 0 is 0; if false, 0601 0000h. Implied "
     "if no PDO with a writable mapping can be disabled",
     "false"},
    {pdo, "mapping_abort_code", "pdo_mapping_abort_code", abort_code,
     "abort code for a number of mapped objects that does not give a valid mapping", "\"0x06040042\""},
    {pdo, "mpdo", "mpdo", flag,
     "multiplex PDOs are supported: sub-index 0 of a mapping may be 254 or 255, [see below](#multiplex-pdos)", "false"},
    {sync, "cob_id_writable", "sync_cob_id_writable", mask, "writable bits of 1005h; the other bits keep their value",
     all_bits},
    {emcy, "cob_id_writable", "emcy_cob_id_writable", mask, "writable bits of 1014h; the other bits keep their value",
     all_bits},
    {emcy, "cob_id_writable_while_valid", "emcy_cob_id_writable_while_valid", flag,
     "the CAN-ID in 1014h may be changed while EMCY is valid; if false, 0609 0030h", "false"},
    {emcy, "inhibit_time_step", "emcy_inhibit_time_step", number,
     "1015h accepts only multiples of this value, in units of 100 us; 0609 0030h for others", "1", "", 1, 65535},
    {emcy, "stopped_keeps_last", "emcy_stopped_keeps_last", flag,
     "after Stopped, only the last pending EMCY is sent; if false, all", "false"},
    {emcy, "info", "emergency_info", structured,
     "bytes 3 to 7 of EMCYs that the runtime sends on its own, by emergency error code: `{\"8210h\": \"0900000000\"}`",
     "", "zero"},
    {emcy, "reset_code", "reset_emergency", emergency_code,
     "emergency error code of an EMCY sent before a reset by NMT command, with the manufacturer-specific bit of 1001h: "
     "`\"FF00h\"`; the errors in 1003h remain after the reset",
     "", "none"},
    {emcy, "history_keeps_resets", "error_history_keeps_resets", flag,
     "1003h also records EMCYs that report the end of an error", "false"},
    {emcy, "history_abort_code", "error_history_abort_code", abort_code,
     "abort code for a write of a value other than 0 to 1003h:00", "\"0x06090030\""},
    {emcy, "history_empty_is_zero", "error_history_empty_is_zero", flag,
     "an element of 1003h above the number of errors is 0; if false, its upload is aborted with 0800 0024h", "false"},
    {emcy, "history_has_info", "error_history_has_info", flag,
     "the high half of an element of 1003h has the first two manufacturer-specific bytes of the EMCY; if false, it is 0",
     "true"},
    {storage, "entries", "storing", structured,
     "objects or entries that 1010h stores differently from what their access type implies: `{\"6010h:01\": \"never\"}`, [see "
     "below](#stored-parameters)"},
    {storage, "sub_indices", "", structured,
     "entries that a sub-index of 1010h and 1011h from 05h to 0Eh stores and restores, as 01h does: `{\"05h\": [\"2111h\"]}`, "
     "[see below](#stored-parameters)"},
    {storage, "autonomous", "", structured,
     "sub-indices of 1010h whose parameters the application stores by itself, so that their bit 1 is 1: `[\"06h\"]`",
     "", "none: bit 1 is 0"},
    {storage, "signature_abort_code", "storage_signature_abort_code", abort_code,
     "abort code for a write of a value other than \"save\" to 1010h or \"load\" to 1011h", "\"0x08000020\""},
    {storage, "version", "storage_version", number,
     "number of the meaning of the stored values: a value that was stored with another one is passed to the application's "
     "`on_stored_value`",
     "0", "", 0, 255},
    {storage, "first_format", "storage_first_format", flag,
     "images of stored parameters that edsc wrote before format 2 are loaded too", "true"},
    {storage, "restore_needs_power_cycle", "restore_needs_power_cycle", flag,
     "after \"load\", NMT resets keep the values in use; the defaults become active at the next power-on", "false"},
    {sdo, "upload_size_indicated", "sdo_upload_size_indicated", flag,
     "expedited upload responses indicate the data size; if false, command byte 42h", "true"},
    {sdo, "length_codes", "sdo_length_codes", flag,
     "abort code 0607 0012h for a value that is too long, 0607 0013h for one that is too short; if false, 0607 0010h for both",
     "true"},
    {sdo, "block_transfer", "sdo_block_transfer", flag, "SDO block transfer is supported; if false, 0504 0001h",
     "false"},
    {sdo, "timeout", "sdo_timeout", number,
     "ms without a frame from the client after which a segmented or block transfer is aborted with 0504 0000h; 0: never",
     "", "1000 with `sdo.block_transfer`, else 0", 0, 65535},
    {sdo, "zero_terminated_strings", "zero_terminated_strings", structured,
     "VISIBLE_STRINGs are transmitted with a terminating 00h", "false"},
    {drive, "additional_modes", "drive_additional_modes", mask,
     "modes of CiA 402 that 6060h accepts in addition to the supported drive modes of 6502h, as bits of 6502h; bits 16 to 31 "
     "stand for all negative values; other modes are rejected with 0609 0030h",
     "\"0x00000000\""},
    {lss, "bit_rates", "", structured,
     "bit rates in kbit/s that configure bit timing accepts, `\"auto\"` for automatic detection: `[125, 500, \"auto\"]`; "
     "`\"fixed\"`: none",
     "", "BaudRate_* of the EDS"},
    {lss, "manufacturer_bit_timing", "", flag,
     "manufacturer-specific bit timing tables 128 to 255 are passed to the port", "false"},
    {lss, "unconfigurable", "", flag, "configure node-ID accepts 255, which removes the node-ID", "true"},
    {lss, "fastscan", "", flag, "Fastscan is supported", "true"},
    {lss, "served_in_stopped", "", flag, "LSS is active in Stopped", "true"},
    {lss, "served_in_operational", "", flag, "LSS is active in Operational", "false"},
};

}  // namespace option_table

inline constexpr const auto& options_table = option_table::rows;

/// Returns the row; null if there is none. `group` is empty for a member of the file itself.
[[nodiscard]] constexpr const OptionRow* find_option(std::string_view group, std::string_view name) {
  const auto* const found = std::ranges::find_if(
      options_table, [&](const OptionRow& row) { return row.group.name == group && row.name == name; });
  return found == std::end(options_table) ? nullptr : found;
}

/// Returns the row of a deprecated name; null if there is none.
[[nodiscard]] constexpr const OptionRow* find_flat_option(std::string_view flat_name) {
  const auto* const found = std::ranges::find(options_table, flat_name, &OptionRow::flat_name);
  return flat_name.empty() || found == std::end(options_table) ? nullptr : found;
}

/// The member of canopen::DeviceOptions that the row sets: `sdo_timeout`.
[[nodiscard]] inline std::string member_of(const OptionRow& row) {
  if (!row.flat_name.empty()) return std::string{row.flat_name};
  return std::string{row.group.name}.append(1, '_').append(row.name);
}

/// Returns the group; null if there is none.
[[nodiscard]] constexpr const OptionGroup* find_option_group(std::string_view name) {
  const auto* const found =
      std::ranges::find_if(options_table, [&](const OptionRow& row) { return row.group.name == name; });
  return name.empty() || found == std::end(options_table) ? nullptr : &found->group;
}

/// Returns `sdo.timeout`, or the name alone of an option without a group.
[[nodiscard]] inline std::string path_of(const OptionRow& row) {
  return row.group.name.empty() ? std::string{row.name} : std::string{row.group.name}.append(1, '.').append(row.name);
}

}  // namespace edsc
