/// Messages as lines of text and of JSON.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "decode/log/log_line.hpp"
#include "decode/message.hpp"

namespace edsc {

/// The labels of nodes in lines of text: `node 5`, with the name if the DCF has one.
class NodeLabels {
 public:
  NodeLabels();
  void set_name(std::uint8_t node_id, std::string_view name);

  /// `node 5 axis1 `, padded with blanks to the width of the longest.
  [[nodiscard]] std::string_view padded(std::uint8_t node_id) const { return padded_[node_id & 0x7F]; }
  [[nodiscard]] std::string_view name(std::uint8_t node_id) const { return names_[node_id & 0x7F]; }

 private:
  void pad();

  std::array<std::string, 128> names_, padded_;
};

/// `part`, `finished`, `aborted`; empty for none.
[[nodiscard]] std::string_view step_name(TransferStep step);

/// `TPDO 2`, `SDO >`
[[nodiscard]] std::string service_label(const Message& message);

/// One line: time, interface, CAN-ID, data, service, node and meaning.
void append_text(std::string& out, const LogLine& line, const Message& message, const NodeLabels& labels, bool color);

/// One JSON object on a line, by docs/schema/message.schema.json.
void append_json(std::string& out, const LogLine& line, const Message& message, const NodeLabels& labels);

}  // namespace edsc
