/// The modes of operation of a drive (CiA 402-2): the values that 6060h accepts, from the supported drive modes 6502h.
#pragma once

#include <cstdint>
#include <vector>

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// Consecutive values of 6060h.
struct ModeRange {
  std::int8_t low, high;
  friend bool operator==(const ModeRange&, const ModeRange&) = default;
};

/// Returns the values that an entry accepts, ascending: 0, the modes of 6502h, and those of the option
/// drive.additional_modes. Negative values are manufacturer-specific: accepted from a LowLimit below 0 on, all of them
/// if bits 16 to 31 of 6502h are not 0. Empty: the entry is not a mode of operation (6060h, or that of another axis),
/// or the EDS does not list the modes of its axis.
[[nodiscard]] std::vector<ModeRange> accepted_modes(const Device& device, const Options& options, const Entry& entry);

/// Whether the entry accepts a value. An entry without accepted modes accepts all.
[[nodiscard]] bool accepts_mode(const Device& device, const Options& options, const Entry& entry, std::uint64_t bits);

}  // namespace edsc
