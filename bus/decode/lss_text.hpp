/// LSS messages in words (CiA 305).
#pragma once

#include <canopen/frame.hpp>
#include <string>

namespace edsc {

/// What a frame on 7E5h (`from_master`) or 7E4h says. False: the command is none of CiA 305.
bool append_lss_text(std::string& text, const canopen::Frame& frame, bool from_master);

}  // namespace edsc
