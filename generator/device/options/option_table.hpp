/// The table of options: what a device does that an EDS cannot express. docs/options.md and its schema are made from
/// it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

namespace edsc {

/// How an option is written in the options file. A row with a form other than `structured` sets the member of
/// canopen::DeviceOptions of the same name; a structured option has a reader of its own in structured_options.cpp.
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

struct OptionRow {
  std::string_view name;
  OptionForm form;
  std::string_view group;
  std::string_view meaning;
  std::string_view default_value{};  ///< as in the options file; empty: `default_text` describes it
  std::string_view default_text{};
  std::uint32_t min = 0;
  std::uint32_t max = 0;
};

namespace option_table {

using enum OptionForm;
inline constexpr std::string_view all_bits = "\"0xFFFFFFFF\"";

inline constexpr OptionRow rows[] = {
    {"names", structured, "C++",
     "C++ names by entry, instead of those derived from ParameterName: `{\"6040h:00\": \"controlword\"}`; for an element of an "
     "ARRAY, `{\"2000h:01\": \"p\"}` gives `gains_p`"},
    {"string_capacity", structured, "C++", "capacity in bytes of strings in RAM, by entry", "",
     "length of the default value, else 16"},
    {"settable", structured, "C++",
     "`const` or `ro` entries that the application sets at start-up; they are placed in RAM"},
    {"connected_modules", structured, "EDS",
     "modules connected to a modular device: numbers from [SupportedModules], by slot", "",
     "[ConnectedModules] of a DCF"},
    {"silence", structured, "check",
     "ids of rules whose warnings and notes are not reported; errors are silenced for `edsc check` only"},
    {"allow", structured, "check",
     "expected findings with a reason, for one object or entry or for the whole file; errors are allowed for `edsc check` only, "
     "[see below](#allowed-findings)"},
    {"static_mapping", structured, "PDO",
     "PDOs with a fixed mapping: `true` for all, or a list of mapping parameters: `[\"1600h\", \"1A00h\"]`, [see "
     "below](#static-and-dynamic-mapping)",
     "", "PDOs whose mapping is not writable in the EDS"},
    {"no_event", structured, "PDO",
     "objects or entries whose change does not trigger an event-driven TPDO: `[\"6401h\", \"6000h:02\"]`"},
    {"pdo_cob_id_writable", mask, "PDO",
     "writable bits of 1400h..15FFh:01 and 1800h..19FFh:01; the other bits keep their value", all_bits},
    {"pdo_reserved_can_ids", can_id_range, "PDO",
     "range of CAN-IDs, first and last, that PDOs must not use, in addition to those restricted by CiA 301: `[\"0x080\", "
     "\"0x100\"]`; 0609 0030h for them",
     "", "none"},
    {"pdo_extended_ids", flag, "PDO", "PDOs may use 29-bit CAN-IDs; if false, 0609 0030h", "true"},
    {"tpdo_remote_frames", flag, "PDO",
     "TPDOs answer remote frames; if false, bit 30 of their COB-ID must be 1, else 0609 0030h", "true"},
    {"tpdo_remote_frames_can_be_disabled", flag, "PDO", "bit 30 of a TPDO's COB-ID may be 1; if false, 0609 0030h",
     "true"},
    {"tpdo_remote_types", flag, "PDO", "TPDOs accept transmission types 252 and 253; if false, 0609 0030h", "true"},
    {"inhibit_time_unit", number, "PDO", "unit of the inhibit time 1800h..19FFh:03, in us", "100", "", 1,
     32767},  // less than half of the time after which canopen::TimePoint wraps
    {"inhibit_time_writable_while_valid", flag, "PDO",
     "1800h..19FFh:03 may be written while the PDO is valid; if false, 0800 0022h", "false"},
    {"event_driven_on_change", flag, "PDO",
     "TPDOs of transmission types 254 and 255 are sent when a mapped object changes and on entering Operational; if false, on "
     "the event timer only",
     "true"},
    {"tpdo_acyclic_on_change", flag, "PDO",
     "a TPDO of transmission type 0 is sent at the next SYNC after a mapped object has changed; if false, at every SYNC",
     "true"},
    {"pdo_mapping_writable_while_valid", flag, "PDO",
     "1600h..17FFh and 1A00h..1BFFh may be written while the PDO is valid if sub-index 0 is 0; if false, 0601 0000h",
     "false"},
    {"pdo_mapping_abort_code", abort_code, "PDO",
     "abort code for a number of mapped objects that does not give a valid mapping", "\"0x06040042\""},
    {"mpdo", flag, "PDO",
     "multiplex PDOs are supported: sub-index 0 of a mapping may be 254 or 255, [see below](#multiplex-pdos)", "false"},
    {"sync_cob_id_writable", mask, "SYNC and EMCY", "writable bits of 1005h; the other bits keep their value",
     all_bits},
    {"emcy_cob_id_writable", mask, "SYNC and EMCY", "writable bits of 1014h; the other bits keep their value",
     all_bits},
    {"emcy_cob_id_writable_while_valid", flag, "SYNC and EMCY",
     "the CAN-ID in 1014h may be changed while EMCY is valid; if false, 0609 0030h", "false"},
    {"emcy_inhibit_time_step", number, "SYNC and EMCY",
     "1015h accepts only multiples of this value, in units of 100 us; 0609 0030h for others", "1", "", 1, 65535},
    {"emcy_stopped_keeps_last", flag, "SYNC and EMCY",
     "after Stopped, only the last pending EMCY is sent; if false, all", "false"},
    {"emergency_info", structured, "SYNC and EMCY",
     "bytes 3 to 7 of EMCYs that the runtime sends on its own, by emergency error code: `{\"8210h\": \"0900000000\"}`",
     "", "zero"},
    {"reset_emergency", emergency_code, "SYNC and EMCY",
     "emergency error code of an EMCY sent before a reset by NMT command, with the manufacturer-specific bit of 1001h: "
     "`\"FF00h\"`",
     "", "none"},
    {"error_history_keeps_resets", flag, "SYNC and EMCY", "1003h also records EMCYs that report the end of an error",
     "false"},
    {"error_history_abort_code", abort_code, "SYNC and EMCY",
     "abort code for a write of a value other than 0 to 1003h:00", "\"0x06090030\""},
    {"storing", structured, "storage",
     "objects or entries that 1010h stores differently from what their access type implies: `{\"6010h:01\": \"never\"}`, [see "
     "below](#stored-parameters)"},
    {"storage_signature_abort_code", abort_code, "storage",
     "abort code for a write of a value other than \"save\" to 1010h or \"load\" to 1011h", "\"0x08000020\""},
    {"restore_needs_power_cycle", flag, "storage",
     "after \"load\", NMT resets keep the values in use; the defaults become active at the next power-on", "false"},
    {"sdo_upload_size_indicated", flag, "SDO",
     "expedited upload responses indicate the data size; if false, command byte 42h", "true"},
    {"sdo_length_codes", flag, "SDO",
     "abort code 0607 0012h for a value that is too long, 0607 0013h for one that is too short; if false, 0607 0010h for both",
     "true"},
    {"sdo_block_transfer", flag, "SDO", "SDO block transfer is supported; if false, 0504 0001h", "false"},
    {"sdo_timeout", number, "SDO",
     "ms without a frame from the client after which a segmented or block transfer is aborted with 0504 0000h; 0: never",
     "", "1000 with `sdo_block_transfer`, else 0", 0, 65535},
    {"zero_terminated_strings", structured, "SDO", "VISIBLE_STRINGs are transmitted with a terminating 00h", "false"},
    {"lss", structured, "LSS",
     "LSS configuration of the device; a device with this member supports LSS, [see below](#lss)", "",
     "from LSS_Supported and BaudRate_*"},
    {"stored_eds", structured, "EDS",
     "1021h holds the EDS: `true` as text, `\"compressed\"` as a gzip file, [see below](#the-eds-stored-in-the-device)",
     "false", "false: the DOMAIN that the application binds"},
};

}  // namespace option_table

inline constexpr const auto& options_table = option_table::rows;

/// Returns the row; null if there is none.
[[nodiscard]] constexpr const OptionRow* find_option(std::string_view name) {
  const auto* const found = std::ranges::find(options_table, name, &OptionRow::name);
  return found == std::end(options_table) ? nullptr : found;
}

}  // namespace edsc
