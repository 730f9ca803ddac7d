/// Selects frames: `node=5,service=sdo`.
#pragma once

#include <bitset>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "decode/log/log_line.hpp"
#include "decode/log/print_message.hpp"
#include "decode/message.hpp"

namespace edsc {

/// Only the given keys are checked; if a key is given more than once, one of its values must match.
class MessageFilter {
 public:
  /// Adds comma-separated conditions: `node=5` or the name of a node, `service=sdo` (`pdo` for both directions),
  /// `id=185h`, `problem=yes`. Returns an error message, or nothing.
  [[nodiscard]] std::string add(std::string_view text, const NodeLabels& labels);

  [[nodiscard]] bool passes(const LogLine& line, const Message& message) const;

 private:
  [[nodiscard]] std::string add_condition(std::string_view key, std::string_view value, const NodeLabels& labels);
  [[nodiscard]] std::string add_node(std::string_view value, const NodeLabels& labels);

  std::bitset<128> nodes_;
  std::bitset<service_count> services_;
  std::vector<std::uint32_t> can_ids_;
  bool problems_only_ = false;
};

}  // namespace edsc
