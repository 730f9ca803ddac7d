/// The frames of a case, decoded as `edsc decode` does.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "conform/verdict.hpp"
#include "decode/message.hpp"
#include "device/device.hpp"

namespace edsc::conform {

/// Calls `use` with each frame of the case, in the order of the bus. The message is valid until `use` returns. PDOs are
/// decoded with the mapping of the EDS and the changes that the case itself has written.
void decode_frames(const CaseResult& result, std::uint8_t node, const Device& sheet,
                   const std::function<void(const SeenFrame&, const Message&)>& use);

/// The last frames of a case, one per line, without line end: `12.003481 TX 705 05    HEART    node 5  operational`. If
/// earlier frames are left out, the first line has their number.
[[nodiscard]] std::vector<std::string> frame_lines(const CaseResult& result, std::uint8_t node, const Device& sheet,
                                                   std::size_t max_frames);

/// TX: sent by the test; RX: received.
[[nodiscard]] constexpr std::string_view direction_text(const SeenFrame& seen) { return seen.sent ? "TX" : "RX"; }

}  // namespace edsc::conform
