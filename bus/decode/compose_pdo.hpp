/// The frame of a PDO from values that a user gives: the reverse of `append_pdo`.
#pragma once

#include <canopen/can/frame.hpp>
#include <cstdint>
#include <span>
#include <string>

#include "decode/node_model.hpp"

namespace edsc {

/// A value for a mapped object, as text for `parse_value_text`.
struct PdoValue {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::string text;
};

/// The frame, or an error message.
struct ComposedPdo {
  canopen::Frame frame;
  std::string problem;  ///< empty on success

  [[nodiscard]] bool ok() const { return problem.empty(); }
};

/// Each mapped object needs exactly one value, within the limits of its entry; dummies are 0. The PDO must be valid and
/// not be a multiplex PDO.
[[nodiscard]] ComposedPdo compose_pdo(const PdoLayout& pdo, std::span<const PdoValue> values);

}  // namespace edsc
