/// Error frames of SocketCAN as text: reports of the controller, not frames of the bus (linux/can/error.h).
#pragma once

#include <canopen/can/frame.hpp>
#include <string>

namespace edsc {

/// `frame.id` holds the error classes.
void append_error_frame_text(std::string& text, const canopen::Frame& frame);

}  // namespace edsc
