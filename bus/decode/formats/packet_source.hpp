/// Captures of tcpdump and Wireshark: pcap and pcapng with the link type CAN_SOCKETCAN.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "decode/formats/log_input.hpp"
#include "decode/formats/log_source.hpp"

namespace edsc {

[[nodiscard]] bool is_pcap(std::string_view beginning);
[[nodiscard]] bool is_pcapng(std::string_view beginning);

/// Both formats. The time is in seconds since 1970 with six decimals; there is no name of an interface. Returns null
/// and sets `problem` if the header is damaged or the link type is not CAN. `input` must outlive the source.
[[nodiscard]] std::unique_ptr<LogSource> open_packets(LogInput& input, std::string& problem);

}  // namespace edsc
