/// Entries and values that several areas of cases need.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "conform/dut/dut.hpp"

namespace edsc::conform {

/// ObjFlags of an entry or of its object (CiA 306-1, 4.6.2).
inline constexpr std::uint32_t refuse_write_flag = 1;
inline constexpr std::uint32_t refuse_read_flag = 2;
[[nodiscard]] std::uint32_t flags_of(const Device& sheet, const LiveEntry& entry);

/// Selects the entries that a case tests.
using EntryFilter = bool (*)(const LiveEntry&);

[[nodiscard]] bool is_communication(const LiveEntry& entry);  ///< 1000h to 1FFFh
[[nodiscard]] bool is_application(const LiveEntry& entry);    ///< 2000h and above
[[nodiscard]] bool is_domain(const LiveEntry& entry);
/// An integer or a REAL of the EDS.
[[nodiscard]] bool is_number(const LiveEntry& entry);
[[nodiscard]] bool is_readable(const LiveEntry& entry);
[[nodiscard]] bool is_writable(const LiveEntry& entry);

/// Whether the entry is a parameter of 1000h to 1FFFh that accepts any valid value in Pre-operational: times and
/// transmission types. COB-IDs, mappings, inhibit times and SYNC parameters depend on other parameters.
[[nodiscard]] bool is_plain_parameter(const LiveEntry& entry);
/// Whether a run with the permission may write the entry of 2000h or above: not if its ObjFlags forbid it, and not the
/// node-ID or the bit rate of the device.
[[nodiscard]] bool is_application_parameter(const Device& sheet, const LiveEntry& entry);

/// The bits of a value, with the node-ID added if the EDS says so.
[[nodiscard]] std::uint64_t bits_of(canopen::NodeId node, const Value& value);
[[nodiscard]] inline std::uint64_t bits_of(const Dut& dut, const Value& value) { return bits_of(dut.node(), value); }
/// The bytes of the default value as an SDO transfers them; std::nullopt without one, and for a DOMAIN.
[[nodiscard]] std::optional<Bytes> default_bytes(canopen::NodeId node, const Entry& entry);
[[nodiscard]] inline std::optional<Bytes> default_bytes(const Dut& dut, const Entry& entry) {
  return default_bytes(dut.node(), entry);
}

/// The next value above the HighLimit or below the LowLimit; std::nullopt without the limit, and if it is the limit of
/// the data type.
[[nodiscard]] std::optional<std::uint64_t> value_above_limit(const Dut& dut, const Entry& entry);
[[nodiscard]] std::optional<std::uint64_t> value_below_limit(const Dut& dut, const Entry& entry);

/// Whether a value is below the LowLimit or above the HighLimit.
struct LimitCheck {
  bool too_low = false, too_high = false;
};
[[nodiscard]] LimitCheck check_limits(canopen::NodeId node, const Entry& entry, std::span<const std::uint8_t> bytes);

/// Whether a value is within the limits of the EDS. A value outside cannot be written back.
[[nodiscard]] bool is_within_limits(const Dut& dut, const Entry& entry, std::span<const std::uint8_t> bytes);

/// Whether an abort code depends on the state of the device or on other values, while the request is correct.
[[nodiscard]] bool depends_on_state(canopen::AbortCode code);

}  // namespace edsc::conform
