#include "conform/cases/sdo/sdo_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/base/abort_code.hpp>
#include <canopen/base/crc16.hpp>

namespace edsc::conform {
namespace {

namespace sdo = canopen::sdo;

constexpr std::uint8_t command_mask = 0xE0;
constexpr std::uint8_t size_mask = 0x0C;                 ///< expedited: n
constexpr std::size_t max_bytes = std::size_t{1} << 16;  ///< maximum for a value that is read frame by frame

canopen::AbortCode abort_code(const SdoFrame& frame) { return canopen::abort_code_from(sdo::word_of(frame)); }

bool is_abort(const SdoFrame& frame) { return frame[0] == sdo::abort_command; }

void expect_multiplexer(Dut& dut, const SdoFrame& answer, std::uint16_t index, std::uint8_t sub_index) {
  dut.expect(sdo::multiplexer_of(answer) == sdo::multiplexer(index, sub_index),
             "an answer for " + label(index, sub_index), hex_bytes(answer));
}

void append(Bytes& bytes, std::span<const std::uint8_t> piece) {
  bytes.insert(bytes.end(), piece.begin(), piece.end());
}

/// A segment with these bytes; all other bytes are 0.
SdoFrame segment_of(std::uint8_t command, std::span<const std::uint8_t> bytes) {
  SdoFrame frame = sdo_frame(command);
  std::ranges::copy(bytes, frame.begin() + 1);
  return frame;
}

/// The segment of a download that begins at byte `at` of the value.
SdoFrame download_segment(std::uint8_t toggle, std::span<const std::uint8_t> value, std::size_t at) {
  const auto piece = value.subspan(at, std::min<std::size_t>(sdo::segment_bytes, value.size() - at));
  const bool last = at + piece.size() == value.size();
  return segment_of(
      static_cast<std::uint8_t>(toggle | (sdo::segment_bytes - piece.size()) << 1 | (last ? sdo::last_segment : 0)),
      piece);
}

void initiate_download(Dut& dut, std::uint16_t index, std::uint8_t sub_index, std::size_t size) {
  dut.remember(index, sub_index);
  const SdoFrame request = sdo_frame(0x21, index, sub_index, static_cast<std::uint32_t>(size));
  const SdoFrame answer = expect_command(dut, dut.exchange(request), 0x60, 0xFF,
                                         "an answer to initiate download of " + label(index, sub_index));
  expect_multiplexer(dut, answer, index, sub_index);
}

/// Compares the size with the indicated one, if any.
void expect_size(Dut& dut, const SdoFrame& initiate, std::uint8_t indicated, std::size_t size, std::uint16_t index,
                 std::uint8_t sub_index) {
  if ((initiate[0] & indicated) == 0) return;
  dut.expect_equal(size, sdo::word_of(initiate), "the number of bytes that " + label(index, sub_index) + " indicates");
}

void no_block_transfer(Dut& dut) {
  dut.not_applicable("the device does not support SDO block transfer: " +
                     abort_text(canopen::AbortCode::command_specifier));
}

}  // namespace

SdoFrame sdo_frame(std::uint8_t command) { return {command}; }

SdoFrame sdo_frame(std::uint8_t command, std::uint16_t index, std::uint8_t sub_index, std::uint32_t word) {
  SdoFrame frame{command};
  sdo::put_multiplexer(frame, index, sub_index);
  sdo::put_word(frame, word);
  return frame;
}

SdoFrame expect_answer(Dut& dut, const std::optional<SdoFrame>& answer, const std::string& expected) {
  if (!answer) dut.fail(expected, "no answer");
  if (is_abort(*answer)) dut.fail(expected, "abort " + abort_text(abort_code(*answer)));
  return *answer;
}

SdoFrame expect_command(Dut& dut, const std::optional<SdoFrame>& answer, std::uint8_t command, std::uint8_t mask,
                        const std::string& expected) {
  const SdoFrame frame = expect_answer(dut, answer, expected);
  dut.expect((frame[0] & mask) == command, fmt::format("{}: byte 0 {:02X}h (bits {:02X}h)", expected, command, mask),
             hex_bytes(frame));
  return frame;
}

bool is_expedited(const SdoFrame& answer) { return (answer[0] & sdo::expedited) != 0; }

SdoFrame initiate_upload(Dut& dut, std::uint16_t index, std::uint8_t sub_index) {
  const std::string expected = "an answer to initiate upload of " + label(index, sub_index);
  const SdoFrame answer =
      expect_command(dut, dut.exchange(sdo_frame(0x40, index, sub_index)), 0x40, command_mask | sdo::toggle, expected);
  expect_multiplexer(dut, answer, index, sub_index);
  const bool tells_bytes = is_expedited(answer) && (answer[0] & sdo::size_indicated) != 0;
  dut.expect(tells_bytes || (answer[0] & size_mask) == 0, expected + ": n = 0 unless e and s are 1", hex_bytes(answer));
  return answer;
}

Bytes upload_by_segments(Dut& dut, std::uint16_t index, std::uint8_t sub_index) {
  const SdoFrame initiate = initiate_upload(dut, index, sub_index);
  if (is_expedited(initiate)) {
    const std::size_t unused = (initiate[0] & size_mask) >> 2;
    return {initiate.begin() + 4, initiate.end() - static_cast<std::ptrdiff_t>(unused)};
  }
  Bytes bytes;
  for (std::uint8_t toggle = 0;; toggle ^= sdo::toggle) {
    const std::string expected = fmt::format("a segment of {} after {} bytes", label(index, sub_index), bytes.size());
    const SdoFrame segment = expect_command(dut, dut.exchange(sdo_frame(static_cast<std::uint8_t>(0x60 | toggle))),
                                            toggle, command_mask | sdo::toggle, expected);
    append(bytes, std::span{segment}.subspan(1, sdo::segment_bytes - ((segment[0] >> 1) & 7U)));
    if ((segment[0] & sdo::last_segment) != 0) break;
    dut.expect(bytes.size() <= max_bytes, "a last segment", fmt::format("{} bytes without one", bytes.size()));
  }
  expect_size(dut, initiate, sdo::size_indicated, bytes.size(), index, sub_index);
  return bytes;
}

std::optional<SdoFrame> download_with_wrong_toggle(Dut& dut, std::uint16_t index, std::uint8_t sub_index,
                                                   std::span<const std::uint8_t> value) {
  initiate_download(dut, index, sub_index, value.size());
  return dut.exchange(download_segment(sdo::toggle, value, 0));
}

void download_by_segments(Dut& dut, std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value) {
  initiate_download(dut, index, sub_index, value.size());
  std::uint8_t toggle = 0;
  for (std::size_t at = 0; at < value.size(); at += sdo::segment_bytes, toggle ^= sdo::toggle) {
    expect_command(dut, dut.exchange(download_segment(toggle, value, at)), static_cast<std::uint8_t>(0x20 | toggle),
                   0xFF, fmt::format("an answer to the segment of {} after {} bytes", label(index, sub_index), at));
  }
}

SdoFrame initiate_block_upload(Dut& dut, std::uint16_t index, std::uint8_t sub_index, BlockTransfer how) {
  const auto command = static_cast<std::uint8_t>(sdo::block_upload_initiate | (how.crc ? sdo::crc_supported : 0));
  const auto answer = dut.exchange(sdo_frame(command, index, sub_index, how.block_size));
  if (answer && is_abort(*answer) && abort_code(*answer) == canopen::AbortCode::command_specifier)
    no_block_transfer(dut);
  constexpr std::uint8_t no_other_bits = 0xFF & ~(sdo::crc_supported | sdo::block_size_indicated);
  const SdoFrame initiate = expect_command(dut, answer, sdo::block_upload_answer, no_other_bits,
                                           "an answer to initiate block upload of " + label(index, sub_index));
  expect_multiplexer(dut, initiate, index, sub_index);
  return initiate;
}

void need_block_upload(Dut& dut) {
  dut.need(0x1000);
  (void)initiate_block_upload(dut, 0x1000, 0, {});
  dut.end_transfer(0x1000, 0);
}

BlockValue upload_by_blocks(Dut& dut, std::uint16_t index, std::uint8_t sub_index, BlockTransfer how) {
  const SdoFrame initiate = initiate_block_upload(dut, index, sub_index, how);
  BlockValue value;
  std::optional<SdoFrame> answer = dut.exchange(sdo_frame(sdo::block_upload_start));
  std::uint8_t sequence = 0;
  std::size_t confirmed = 0;  // bytes
  for (bool last = false; !last;) {
    const std::string expected = fmt::format("segment {} of a block of {}", ++sequence, label(index, sub_index));
    const SdoFrame segment = expect_command(dut, answer, sequence, sdo::sequence_mask, expected);
    append(value.bytes, std::span{segment}.subspan(1));
    last = (segment[0] & sdo::last_block_segment) != 0;
    dut.expect(value.bytes.size() <= max_bytes, "a last segment",
               fmt::format("{} bytes without one", value.bytes.size()));
    if (!last && sequence != how.block_size) {
      answer = dut.answer();
      continue;
    }
    SdoFrame confirm = sdo_frame(sdo::block_upload_confirm);
    confirm[1] = how.first_lost ? 0 : sequence;
    confirm[2] = how.block_size;
    answer = dut.exchange(confirm);
    sequence = 0;
    if (how.first_lost) {
      value.bytes.resize(confirmed);
      how.first_lost = last = false;
    }
    confirmed = value.bytes.size();
  }
  const SdoFrame end = expect_command(dut, answer, sdo::block_upload_end, sdo::block_end_mask,
                                      "the end of a block upload of " + label(index, sub_index));
  value.bytes.erase(value.bytes.end() - ((end[0] >> 2) & 7), value.bytes.end());
  expect_size(dut, initiate, sdo::block_size_indicated, value.bytes.size(), index, sub_index);
  if (how.crc && (initiate[0] & sdo::crc_supported) != 0) {
    const unsigned crc = canopen::crc16_ccitt(0, value.bytes);
    const unsigned sent = end[1] | static_cast<unsigned>(end[2]) << 8;
    dut.expect(sent == crc, fmt::format("CRC {:04X}h of the {} bytes", crc, value.bytes.size()),
               fmt::format("CRC {:04X}h", sent));
    value.crc_checked = true;
  }
  dut.request(sdo_frame(sdo::block_upload_end_answer));
  return value;
}

std::optional<SdoFrame> download_by_block(Dut& dut, std::uint16_t index, std::uint8_t sub_index,
                                          std::span<const std::uint8_t> value, SentCrc crc) {
  dut.remember(index, sub_index);
  const bool checked = crc != SentCrc::absent;
  const auto command = static_cast<std::uint8_t>(sdo::block_download_initiate | sdo::block_size_indicated |
                                                 (checked ? sdo::crc_supported : 0));
  const auto answer = dut.exchange(sdo_frame(command, index, sub_index, static_cast<std::uint32_t>(value.size())));
  if (answer && is_abort(*answer) && abort_code(*answer) == canopen::AbortCode::command_specifier)
    no_block_transfer(dut);
  constexpr std::uint8_t no_crc_bit = 0xFF & ~sdo::crc_supported;
  const SdoFrame initiate = expect_command(dut, answer, sdo::block_download_answer, no_crc_bit,
                                           "an answer to initiate block download of " + label(index, sub_index));
  expect_multiplexer(dut, initiate, index, sub_index);
  dut.expect(initiate[4] >= 1 && initiate[4] <= sdo::largest_block, "a block size of 1 to 127",
             fmt::format("block size {}", initiate[4]));
  if (checked && (initiate[0] & sdo::crc_supported) == 0) dut.not_applicable("the device does not generate a CRC");

  std::uint8_t sequence = 0;
  for (std::size_t at = 0; at < value.size(); at += sdo::segment_bytes) {
    const auto piece = value.subspan(at, std::min<std::size_t>(sdo::segment_bytes, value.size() - at));
    const bool last = at + piece.size() == value.size();
    const SdoFrame segment =
        segment_of(static_cast<std::uint8_t>(++sequence | (last ? sdo::last_block_segment : 0)), piece);
    if (!last) {
      dut.request(segment);
      continue;
    }
    const SdoFrame confirm =
        expect_command(dut, dut.exchange(segment), sdo::block_download_confirm, 0xFF, "the confirmation of the block");
    dut.expect_equal(confirm[1], sequence, "the confirmed sequence number");
  }
  const auto unused = static_cast<unsigned>(sequence * sdo::segment_bytes - value.size());
  SdoFrame end = sdo_frame(static_cast<std::uint8_t>(sdo::block_download_end | unused << 2));
  if (checked) {
    const unsigned sum = canopen::crc16_ccitt(0, value) ^ (crc == SentCrc::wrong ? 0x0001U : 0U);
    end[1] = static_cast<std::uint8_t>(sum);
    end[2] = static_cast<std::uint8_t>(sum >> 8);
  }
  return dut.exchange(end);
}

}  // namespace edsc::conform
