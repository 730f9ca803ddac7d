/// The services whose frames have a meaning of their own: NMT, SYNC, TIME, EMCY.
#pragma once

#include <canopen/can/frame.hpp>
#include <cstdint>
#include <string_view>

#include "decode/message.hpp"
#include "device/device.hpp"

namespace edsc {

void decode_nmt(const canopen::Frame& frame, Message& message);
void decode_sync(const canopen::Frame& frame, Message& message);
void decode_time(const canopen::Frame& frame, Message& message);
/// `device`: null if the EDS of the node is not known.
void decode_emcy(const canopen::Frame& frame, const Device* device, Message& message);

/// The problem of a frame that does not have the length of its service, such as `the 2 of a command`.
void wrong_length(const canopen::Frame& frame, std::string_view right, Message& message);

}  // namespace edsc
