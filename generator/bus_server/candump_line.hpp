/// A frame as a line of `candump -L`.
#pragma once

#include <string>
#include <string_view>

#include "canopen/frame.hpp"
#include "canopen/port/socketcand_protocol.hpp"

namespace edsc {

/// "(1700000000.000000) vcan0 123#1122", without a line end; a remote frame is "123#R2".
[[nodiscard]] std::string candump_line(const canopen::Frame& frame, std::string_view bus,
                                       canopen::socketcand::TimeStamp time);

}  // namespace edsc
