/// Raw numbers of an entry as physical values with a unit, and back. Both are exact for integers.
#pragma once

#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/meaning/meaning.hpp"

namespace edsc {

/// The factor or offset of a unit as a number to calculate with.
[[nodiscard]] Rational rational(const canopen::Fraction& fraction);

/// raw * scale + offset. Nothing for a type that is not an integer, or if the result does not fit into 64 bits.
[[nodiscard]] std::optional<Rational> physical_value(const Quantity& quantity, const canopen::DataTypeRow& type,
                                                     std::uint64_t bits);

/// `21.5 °C`; for REAL, the product in double precision. The raw number alone if it has no physical value.
void append_physical(std::string& text, const Quantity& quantity, const canopen::DataTypeRow& type, std::uint64_t bits,
                     unsigned length);

/// A raw number of a physical text, or why there is none.
struct RawNumber {
  std::uint64_t bits = 0;
  std::string problem;  ///< empty on success

  [[nodiscard]] bool ok() const { return problem.empty(); }
};

/// The number and the unit of a text such as `1.5 kV`.
struct PhysicalText {
  std::string_view number, unit;
};

/// Splits a number from the unit after it; nothing if the text does not begin with a number or has no unit.
[[nodiscard]] std::optional<PhysicalText> split_physical(std::string_view text);

/// The raw number of a physical value, converted from another unit of the dimension if necessary. A value between two
/// raw numbers is rejected with both; a unit of another dimension too.
[[nodiscard]] RawNumber raw_number(const Quantity& quantity, const canopen::DataTypeRow& type,
                                   const PhysicalText& text);

}  // namespace edsc
