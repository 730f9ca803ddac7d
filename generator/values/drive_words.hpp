/// Controlword and statusword of a drive as text (CiA 402-2, clause 8.4).
#pragma once

#include <cstdint>
#include <string>

namespace edsc {

enum class DriveWord : std::uint8_t { none, controlword, statusword };

/// Whether an object is one of the two, for any of the eight axes of a device (800h apart).
[[nodiscard]] DriveWord drive_word_at(std::uint16_t index, std::uint8_t sub_index);

/// `0237h operation enabled`, `000Fh enable operation`, with the other bits that are the same in all modes.
void append_drive_word(std::string& text, DriveWord word, std::uint16_t value);

}  // namespace edsc
