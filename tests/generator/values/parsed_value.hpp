/// One value of an EDS, and what is reported about it.
#pragma once

#include "values/read_value.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "support/device_from_text.hpp"

namespace edsc {

/// One value that parse_value reads.
struct Parsed {
  Parsed(canopen::DataType data_type, std::string text, std::optional<std::uint8_t> node_id = std::nullopt)
      : source("value.eds", "[2000]\nDefaultValue=" + text + "\n"),
        field{source.line(2).substr(std::string_view{"DefaultValue="}.size()), {&source, 2, 14}, true},
        value(parse_value(field, *canopen::find_data_type(static_cast<std::uint32_t>(data_type)), node_id,
                          diagnostics)) {}

  [[nodiscard]] std::optional<std::uint64_t> bits() const { return value ? std::optional{value->bits} : std::nullopt; }
  [[nodiscard]] std::optional<std::int64_t> number() const {
    return value ? std::optional{static_cast<std::int64_t>(value->bits)} : std::nullopt;
  }

  SourceFile source;
  Diagnostics diagnostics;
  Field field;
  std::optional<Value> value;
};

using Findings = std::vector<Finding>;
inline const Findings none;

inline Findings error_of(const char* rule) { return {error_at(2, 14, rule)}; }
inline Findings warning_of(const char* rule) { return {warning_at(2, 14, rule)}; }

}  // namespace edsc
