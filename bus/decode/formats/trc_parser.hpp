/// Lines of a trace of PEAK PCAN-View, PCAN-Explorer or PCAN-Trace, by "PEAK CAN TRC File Format":
///
///   ;$FILEVERSION=1.1
///       1)      1059.9  Rx         0300  7  00 00 00 00 04 00 00
///       2)      1283.2  Rx     18EFC034  0  RTR
///   ;$FILEVERSION=2.1
///   ;$COLUMNS=N,O,T,B,I,d,R,L,D
///       1      1059.900 DT 1      0300 Rx -  7    00 00 00 00 04 00 00
///       2      1283.231 RR 1  18EFC034 Rx -  0
///       3      1298.945 ER 1         - Rx -  5    04 00 02 00 00
///
/// A time is in milliseconds. A trace without a version has version 1.0: message number, time, CAN-ID, length, data.
#pragma once

#include <string>
#include <string_view>

#include "decode/formats/log_source.hpp"

namespace edsc {

[[nodiscard]] bool is_trc(std::string_view beginning);

class TrcParser final : public LineParser {
 public:
  /// The time is in seconds since the start of the trace, with six decimals.
  [[nodiscard]] LogLine parse(std::string_view text) override;

 private:
  [[nodiscard]] LogLine parse_comment(std::string_view text);
  [[nodiscard]] LogLine parse_event(std::string_view rest);
  [[nodiscard]] std::string_view parse_column(char column, std::string_view word, LogLine& line);

  /// Letters of $COLUMNS: N message number, O time, T type, B bus, I CAN-ID, d direction or type of version 1, R
  /// reserved, l length, L length code; D, the data, is the last one.
  std::string columns_ = "NOIl";
  std::string time_;
};

}  // namespace edsc
