/// SDO transfers frame by frame (CiA 301, 7.2.4.3): each bit of an answer is compared with the protocol.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "conform/dut.hpp"

namespace edsc::conform {

using SdoFrame = canopen::sdo::Data;

/// A frame that names an entry, and bytes 4 to 7 as a number.
[[nodiscard]] SdoFrame sdo_frame(std::uint8_t command, std::uint16_t index, std::uint8_t sub_index,
                                 std::uint32_t word = 0);
/// A frame that names no entry: a segment, the end of a block.
[[nodiscard]] SdoFrame sdo_frame(std::uint8_t command);

/// The answer to a request; the case fails without one, and for an abort.
SdoFrame expect_answer(Dut& dut, const std::optional<SdoFrame>& answer, const std::string& expected);
/// The same for an answer whose bits of byte 0 that are in the mask are these.
SdoFrame expect_command(Dut& dut, const std::optional<SdoFrame>& answer, std::uint8_t command, std::uint8_t mask,
                        const std::string& expected);

/// The answer to an initiate upload, which names the entry: expedited, or with the size of the segments.
SdoFrame initiate_upload(Dut& dut, std::uint16_t index, std::uint8_t sub_index);
[[nodiscard]] bool is_expedited(const SdoFrame& answer);

/// Uploads expedited or in segments, as the device chooses: toggle bits, sizes and the last segment must be right.
Bytes upload_by_segments(Dut& dut, std::uint16_t index, std::uint8_t sub_index);
/// The answer to a segment whose toggle bit is 1 though it is the first of a download.
std::optional<SdoFrame> download_with_wrong_toggle(Dut& dut, std::uint16_t index, std::uint8_t sub_index,
                                                   std::span<const std::uint8_t> value);
/// Downloads in segments, also what fits into one frame. The value is put back when the case is over.
void download_by_segments(Dut& dut, std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value);

struct BlockTransfer {
  bool crc = false;
  std::uint8_t block_size = canopen::sdo::largest_block;  ///< segments of a sub-block
  bool first_lost = false;  ///< the first sub-block is confirmed with 0, so that the device sends it again
};

/// Initiates a block upload. The case is not applicable where the device refuses it with 0504 0001h.
SdoFrame initiate_block_upload(Dut& dut, std::uint16_t index, std::uint8_t sub_index, BlockTransfer how);
/// The case is not applicable where the device does not support block transfer.
void need_block_upload(Dut& dut);

struct BlockValue {
  Bytes bytes;
  bool crc_checked = false;  ///< the device has sent the CRC of the bytes
};
BlockValue upload_by_blocks(Dut& dut, std::uint16_t index, std::uint8_t sub_index, BlockTransfer how);

enum class SentCrc : std::uint8_t { none, right, wrong };
/// Downloads in one block of at most 127 segments. The answer to its end; the value is put back when the case is over.
std::optional<SdoFrame> download_by_block(Dut& dut, std::uint16_t index, std::uint8_t sub_index,
                                          std::span<const std::uint8_t> value, SentCrc crc);

}  // namespace edsc::conform
