/// Messages as lines of text and of JSON.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "decode/log_line.hpp"
#include "decode/message.hpp"

namespace edsc {

/// What stands before `node 5` in each line of text: names of nodes where their DCFs have some.
class NodeLabels {
 public:
  NodeLabels();
  void set_name(std::uint8_t node_id, std::string_view name);

  /// `node 5 axis1 `, filled with blanks to the width of the longest.
  [[nodiscard]] std::string_view padded(std::uint8_t node_id) const { return padded_[node_id & 0x7F]; }
  [[nodiscard]] std::string_view name(std::uint8_t node_id) const { return names_[node_id & 0x7F]; }

 private:
  void pad();

  std::array<std::string, 128> names_, padded_;
};

/// `TPDO 2`, `SDO >`
[[nodiscard]] std::string service_label(const Message& message);

/// One line: time, interface, CAN-ID, data, service, node, and what it says.
void append_text(std::string& out, const LogLine& line, const Message& message, const NodeLabels& labels, bool color);

/// One object on a line, as docs/schema/message.schema.json says. `line_number` counts from 1.
void append_json(std::string& out, const LogLine& line, std::size_t line_number, const Message& message,
                 const NodeLabels& labels);

/// A JSON string with its quotation marks; what is no UTF-8 becomes U+FFFD.
void append_json_string(std::string& out, std::string_view text);

}  // namespace edsc
