/// SDO transfers frame by frame (CiA 301, 7.2.4.3), with a check of each answer against the protocol.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "conform/dut/dut.hpp"

namespace edsc::conform {

using SdoFrame = canopen::sdo::Data;

/// A frame with the multiplexer of an entry, and bytes 4 to 7 as a number.
[[nodiscard]] SdoFrame sdo_frame(std::uint8_t command, std::uint16_t index, std::uint8_t sub_index,
                                 std::uint32_t word = 0);
/// A frame without a multiplexer: a segment, the end of a block.
[[nodiscard]] SdoFrame sdo_frame(std::uint8_t command);

/// Returns the answer to a request. The case fails without an answer and for an abort.
SdoFrame expect_answer(Dut& dut, const std::optional<SdoFrame>& answer, const std::string& expected);
/// The same, and the bits of byte 0 in the mask must match `command`.
SdoFrame expect_command(Dut& dut, const std::optional<SdoFrame>& answer, std::uint8_t command, std::uint8_t mask,
                        const std::string& expected);

/// Initiates an upload and checks the answer: expedited or segmented, with the multiplexer of the entry.
SdoFrame initiate_upload(Dut& dut, std::uint16_t index, std::uint8_t sub_index);
[[nodiscard]] bool is_expedited(const SdoFrame& answer);

/// Uploads expedited or in segments, as the device chooses. Toggle bits, sizes and the last segment must be correct.
Bytes upload_by_segments(Dut& dut, std::uint16_t index, std::uint8_t sub_index);
/// Sends the first segment of a download with toggle bit 1 and returns the answer.
std::optional<SdoFrame> download_with_wrong_toggle(Dut& dut, std::uint16_t index, std::uint8_t sub_index,
                                                   std::span<const std::uint8_t> value);
/// Downloads in segments, even a value that fits into one frame. The former value is restored when the case ends.
void download_by_segments(Dut& dut, std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value);

struct BlockTransfer {
  bool crc = false;
  std::uint8_t block_size = canopen::sdo::largest_block;  ///< segments of a sub-block
  bool first_lost = false;  ///< confirms the first sub-block with 0, so that the device repeats it
};

/// Initiates a block upload. The case is not applicable if the device refuses it with 0504 0001h.
SdoFrame initiate_block_upload(Dut& dut, std::uint16_t index, std::uint8_t sub_index, BlockTransfer how);
/// The case is not applicable if the device does not support block upload.
void need_block_upload(Dut& dut);

struct BlockValue {
  Bytes bytes;
  bool crc_checked = false;  ///< the device has sent the CRC of the bytes
};
BlockValue upload_by_blocks(Dut& dut, std::uint16_t index, std::uint8_t sub_index, BlockTransfer how);

enum class SentCrc : std::uint8_t { absent, right, wrong };
/// Downloads in one block of at most 127 segments and returns the answer to its end. The former value is restored when
/// the case ends.
std::optional<SdoFrame> download_by_block(Dut& dut, std::uint16_t index, std::uint8_t sub_index,
                                          std::span<const std::uint8_t> value, SentCrc crc);

}  // namespace edsc::conform
