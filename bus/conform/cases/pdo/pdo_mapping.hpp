/// The mapping of a PDO: what it maps, what the EDS allows it to map, and the values of the mapped objects.
#pragma once

#include <canopen/nmt/nmt.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conform/case.hpp"
#include "conform/dut/dut.hpp"
#include "pdo/mapping.hpp"

namespace edsc::conform {

using canopen::NmtState;

/// Levels and permissions of the cases. Those that send SYNC need the permission for outputs, because devices apply
/// received data at a SYNC.
inline constexpr Level with_writes = Level::communication;
inline constexpr Permission no_permission = Permission::none, with_sync = Permission::outputs;

/// Sub-indices of 1400h and 1800h.
inline constexpr std::uint8_t cob_id_parameter = 1, type_parameter = 2, inhibit_parameter = 3, reserved_parameter = 4,
                              timer_parameter = 5, sync_start_parameter = 6;

/// Fails because of the value of an entry. If it is the default value of the EDS (0 without one), the failure names the
/// rule of `edsc check` that reports it.
[[noreturn]] void fail_value(Dut& dut, std::uint16_t index, std::uint8_t sub_index, std::uint64_t value, AnyRule rule,
                             const std::string& expected, const std::string& got);

/// Reads the present mapping; std::nullopt for an MPDO.
[[nodiscard]] std::optional<std::vector<MappingValue>> read_mapping(Dut& dut, std::uint16_t communication);
/// `2000h:00 and 2001h:00`
[[nodiscard]] std::string objects_text(const std::vector<MappingValue>& mapping);

/// Why the EDS does not allow an entry of a mapping.
struct MappingProblem {
  AnyRule rule;  ///< of `edsc check`
  std::string expected;
  std::string got;
};
[[nodiscard]] std::optional<MappingProblem> problem_of(const Dut& dut, PdoDirection direction,
                                                       const MappingValue& mapped);
/// Returns why a mapping is not valid: `TPDO 1 maps 6041h:00, ...`; std::nullopt if it is valid. An empty mapping is
/// valid.
[[nodiscard]] std::optional<std::string> reason_against(const Dut& dut, const Pdo& pdo,
                                                        const std::vector<MappingValue>& mapping);
/// Whether PDOMapping and AccessType of an entry allow a PDO of this direction to map it.
[[nodiscard]] bool may_carry(PdoDirection direction, const Entry& entry);

/// The data of a PDO as read from the mapped objects by SDO, and the mask of its known bits.
struct Image {
  std::uint64_t bits = 0;
  std::uint64_t known = 0;
};
[[nodiscard]] Image read_image(Dut& dut, const std::vector<MappingValue>& mapping);
/// Reads the mapped objects several times within 100 ms. Returns the mask of those that change by themselves.
[[nodiscard]] std::uint64_t live_bits(Dut& dut, const std::vector<MappingValue>& mapping);

/// Packs values into PDO data, the first object in the least significant bits (CiA 301, 7.5.2.36).
[[nodiscard]] std::uint64_t pack(const std::vector<MappingValue>& mapping, std::span<const std::uint64_t> values);

/// A value within the limits of an entry that differs from the present one; std::nullopt if none is known. Another
/// `salt` gives another value.
[[nodiscard]] std::optional<std::uint64_t> other_value(const Dut& dut, const MappingValue& mapped,
                                                       std::uint64_t present, std::uint64_t salt = 1);

/// Returns the value nearest to `value` within the limits of the EDS.
[[nodiscard]] std::uint64_t within_limits(const Dut& dut, std::uint16_t index, std::uint8_t sub_index,
                                          std::uint64_t value);

}  // namespace edsc::conform
