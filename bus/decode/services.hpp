/// The services whose frames have a meaning of their own: NMT, SYNC, TIME, EMCY.
#pragma once

#include <canopen/can/frame.hpp>
#include <cstdint>
#include <string_view>

#include "decode/message.hpp"

namespace edsc {

void decode_nmt(const canopen::Frame& frame, Message& message);
void decode_sync(const canopen::Frame& frame, Message& message);
void decode_time(const canopen::Frame& frame, Message& message);
/// `profile`: the low word of the device type, 0 if unknown.
void decode_emcy(const canopen::Frame& frame, std::uint16_t profile, Message& message);

/// The problem of a frame that does not have the length of its service, such as `the 2 of a command`.
void wrong_length(const canopen::Frame& frame, std::string_view right, Message& message);

}  // namespace edsc
