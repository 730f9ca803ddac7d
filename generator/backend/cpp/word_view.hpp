/// A word of fields as C++.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "device/device.hpp"

namespace edsc {

/// A number as a literal of an integer type.
[[nodiscard]] std::string integer_literal(std::int64_t value, bool is_signed);

/// The unsigned or signed C++ type for a number of bits.
[[nodiscard]] std::string integer_type(unsigned bits, bool is_signed);

/// `canopen::Quantity<std::int16_t, canopen::unit::degree_celsius, std::ratio<1, 10>>`. The unit is known.
[[nodiscard]] std::string quantity_type(std::string_view number, const Quantity& quantity);

/// The enumerators of an enumeration, without those that do not fit into its type: name, value, comment.
[[nodiscard]] nlohmann::ordered_json enumerator_rows(const Enumeration& values, unsigned bits, bool is_signed);

/// `; 4.3.2, table 12`: text and place behind a name in a comment.
[[nodiscard]] std::string comment_of(const MeaningText& meaning);

/// The name of the fields of a case, or `case_5` with the first value of the other object for which they are.
[[nodiscard]] std::string name_of_case(const FieldCase& one);

/// The struct for the fields of an entry.
[[nodiscard]] nlohmann::ordered_json word_view(const Entry& entry, const std::string& identifier);

/// The enumeration of an entry: number, values. It does not have a name yet.
[[nodiscard]] nlohmann::ordered_json enumeration_view(const Entry& entry);

/// Adds rows with the names of the values of a type: of the enumeration, or of those in the word.
void add_names_of_values(nlohmann::ordered_json& rows, const std::string& identifier,
                         const nlohmann::ordered_json& enumeration, const nlohmann::ordered_json& word);

}  // namespace edsc
