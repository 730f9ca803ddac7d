/// Shared by the cases of the SDO area: the entries that a case tests.
#pragma once

#include <canopen/sdo/sdo_protocol.hpp>
#include <cstdint>
#include <utility>
#include <vector>

#include "conform/cases/shared/entry_values.hpp"
#include "conform/dut/dut.hpp"

namespace edsc::conform {

namespace sdo = canopen::sdo;

inline constexpr Permission none = Permission::none;

using Entries = std::vector<LiveEntry>;

template <typename Condition>
[[nodiscard]] Entries entries_with(const Dut& dut, Condition condition) {
  Entries found;
  for (LiveEntry& entry : dut.entries()) {
    if (condition(entry)) found.push_back(std::move(entry));
  }
  return found;
}

/// A random selection.
[[nodiscard]] Entries draw(Dut& dut, Entries entries);

/// Expects an answer to the next request.
void expect_served(Dut& dut);

/// Readable entries whose values may have more than four bytes.
[[nodiscard]] Entries long_entries(const Dut& dut);
/// Whether the device uploads the entry in segments: its present value has more than four bytes.
[[nodiscard]] bool is_segmented(Dut& dut, const LiveEntry& entry);
/// Returns an entry whose present value has more than four bytes; constants first, because two reads must be equal.
[[nodiscard]] LiveEntry need_long_entry(Dut& dut);
/// Expects the number of bytes of the data type, unless its length is variable.
void expect_length(Dut& dut, const LiveEntry& entry, std::size_t size);

/// A time that differs from the present one. Disables the other of guarding and heartbeat, which exclude each other.
[[nodiscard]] std::uint64_t other_time(Dut& dut, std::uint16_t index);

}  // namespace edsc::conform
