/// The frames of a case, decoded as `edsc decode` does.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "conform/verdict.hpp"
#include "decode/message.hpp"
#include "device/device.hpp"

namespace edsc::conform {

/// Calls `use` with each frame, in the order of the bus. The message is valid until `use` returns. PDOs are
/// decoded with the mapping of the EDS and the changes that these frames have written.
void decode_frames(std::span<const SeenFrame> frames, std::uint8_t node, const Device& sheet,
                   const std::function<void(const SeenFrame&, const Message&)>& use);

/// Positions of the frames that a report shows, ascending: those that the failed check names and the frames around
/// them; without such frames the last ones.
[[nodiscard]] std::vector<std::size_t> shown_frames(std::size_t count, std::span<const std::size_t> named,
                                                    std::size_t max_frames);

/// Frames, one per line, without line end: `12.003481 TX 705 05    HEART    node 5  operational`. A line between them
/// has the number of frames that are not shown. If frames are named, their lines begin with `> `, others with blanks.
[[nodiscard]] std::vector<std::string> frame_lines(std::span<const SeenFrame> frames, std::uint8_t node,
                                                   const Device& sheet, std::size_t max_frames,
                                                   std::span<const std::size_t> named = {});

/// TX: sent by the test; RX: received.
[[nodiscard]] constexpr std::string_view direction_text(const SeenFrame& seen) { return seen.sent ? "TX" : "RX"; }

}  // namespace edsc::conform
