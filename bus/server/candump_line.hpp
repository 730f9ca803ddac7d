/// A frame as a line of `candump -L`.
#pragma once

#include <string>
#include <string_view>

#include "canopen/can/frame.hpp"
#include "server/socketcand_text.hpp"

namespace edsc {

/// "(1700000000.000000) vcan0 123#1122", without a line end; a remote frame is "123#R2".
[[nodiscard]] std::string candump_line(const canopen::Frame& frame, std::string_view bus, socketcand::TimeStamp time);

/// The interface name for each line, from the address of a bus: `can0`, `vcan0`, `ttyACM0`; `can0` if the address does
/// not contain a valid one.
[[nodiscard]] std::string interface_of(std::string_view bus);

/// Up to 15 characters without blanks, as on Linux.
[[nodiscard]] bool is_interface_name(std::string_view name);

}  // namespace edsc
