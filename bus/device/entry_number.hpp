/// Values of integers, REALs and BOOLEANs as numbers to calculate with.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "device/device.hpp"

namespace edsc {

/// Whether an entry has a number: an integer, a REAL or a BOOLEAN.
[[nodiscard]] bool has_number(const Entry& entry);

/// Returns the raw number of a value; integers above 2^53 are rounded. Nothing for entries without a number.
[[nodiscard]] std::optional<double> entry_number(const Entry& entry, std::span<const std::uint8_t> bytes);

/// A number outside the range of an integer: the nearest one in the range, or the number modulo the size of the range.
enum class OutOfRange : std::uint8_t { nearest, wraps };

/// Returns the value with this raw number, rounded for an integer; empty for entries without a number.
[[nodiscard]] std::vector<std::uint8_t> entry_bytes(const Entry& entry, double number,
                                                    OutOfRange out_of_range = OutOfRange::nearest);

/// The bits of an integer; those of a negative one are its two's complement. Numbers that 64 bits do not have: 0.
[[nodiscard]] std::uint64_t bits_of_integer(double number);

}  // namespace edsc
