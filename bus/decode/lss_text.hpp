/// LSS messages as text (CiA 305).
#pragma once

#include <canopen/can/frame.hpp>
#include <string>

namespace edsc {

/// Appends the meaning of a frame on 7E5h (`from_master`) or 7E4h. Returns false for a command that is not in CiA 305.
bool append_lss_text(std::string& text, const canopen::Frame& frame, bool from_master);

}  // namespace edsc
