/// Block transfer (CiA 301, 7.2.4.3.8 to 7.2.4.3.16). A device that does not support it refuses to initiate it with
/// 0504 0001h.
#include <fmt/format.h>

#include <canopen/od/access.hpp>

#include "conform/case.hpp"
#include "conform/cases/sdo/sdo_entries.hpp"
#include "conform/cases/sdo/sdo_frames.hpp"

namespace edsc::conform {
namespace {

void expect_block_written(Dut& dut, std::uint16_t index, std::uint64_t value, SentCrc crc) {
  const auto answer = download_by_block(dut, index, 0, dut.bytes_of(index, 0, value), crc);
  (void)expect_command(dut, answer, sdo::block_download_end_answer, 0xFF, "the end of the block download");
  dut.expect_equal(dut.read_number(index), value, label(index, 0));
}

void read_short_value_in_block(Dut& dut) {
  dut.need(device_type);
  const BlockValue value = upload_by_blocks(dut, device_type, 0, {});
  dut.expect(value.bytes == dut.read(device_type), "the 4 bytes of 1000h:00", hex_bytes(value.bytes));
}

/// In one block, in blocks of one segment, and with a repeated block.
void read_in_blocks(Dut& dut, bool crc) {
  const LiveEntry entry = need_long_entry(dut);
  const BlockTransfer transfers[] = {
      {crc, sdo::largest_block, false}, {crc, 1, false}, {crc, sdo::largest_block, true}};
  for (const BlockTransfer& transfer : transfers) {
    const BlockValue value = upload_by_blocks(dut, entry.index, entry.sub_index, transfer);
    if (crc && !value.crc_checked) dut.not_applicable("the device does not generate a CRC");
    expect_length(dut, entry, value.bytes.size());
    const bool constant = entry.entry->access == canopen::Access::constant;
    dut.expect(!constant || value.bytes == dut.read(entry.index, entry.sub_index), "the bytes of " + title(entry),
               hex_bytes(value.bytes));
  }
}

void write_in_block(Dut& dut, std::uint16_t index) {
  expect_block_written(dut, index, other_time(dut, index), SentCrc::absent);
}

/// A wrong CRC is refused, and the value is not stored.
void write_in_block_with_crc(Dut& dut, std::uint16_t index) {
  const std::uint64_t value = other_time(dut, index);
  const std::uint64_t before = dut.read_number(index);
  constexpr AbortRule wrong_crc{{canopen::AbortCode::crc}, {canopen::AbortCode::general}};
  dut.expect_abort(download_by_block(dut, index, 0, dut.bytes_of(index, 0, value), SentCrc::wrong), wrong_crc,
                   "a block with a wrong CRC");
  dut.expect_equal(dut.read_number(index), before, label(index, 0) + " after a wrong CRC");
  expect_block_written(dut, index, value, SentCrc::right);
}

/// A sub-block has 1 to 127 segments.
void wrong_block_size(Dut& dut) {
  need_block_upload(dut);
  for (const std::uint8_t size : {std::uint8_t{128}, std::uint8_t{0}}) {
    dut.expect_abort(dut.exchange(sdo_frame(sdo::block_upload_initiate, device_type, 0, size)), abort_rule::block_size,
                     fmt::format("initiate block upload with blocks of {} segments", size));
  }
  (void)dut.read(device_type);
}

void wrong_sequence_number(Dut& dut) {
  dut.need(device_type);
  (void)initiate_block_upload(dut, device_type, 0, {});
  (void)expect_command(dut, dut.exchange(sdo_frame(sdo::block_upload_start)), 0x81, 0xFF, "the last segment, number 1");
  SdoFrame confirm = sdo_frame(sdo::block_upload_confirm);
  confirm[1] = 128;
  confirm[2] = sdo::largest_block;
  dut.expect_abort(dut.exchange(confirm), abort_rule::sequence_number, "segment 128 confirmed");
  (void)dut.read(device_type);
}

constexpr CaseRow sdo_block_rows[] = {
    {"2.19", "1000h:00 is read in a block without CRC", "CiA 301, 7.2.4.3.12", Level::read, none,
     read_short_value_in_block},
    {"2.20", "100Ch:00 is written in a block without CRC", "CiA 301, 7.2.4.3.8", Level::communication, none,
     with<write_in_block, guard_time>},
    {"2.21", "1017h:00 is written in a block without CRC", "CiA 301, 7.2.4.3.8", Level::communication, none,
     with<write_in_block, producer_heartbeat>},
    {"2.22", "A long value is read in blocks without CRC", "CiA 301, 7.2.4.3.14", Level::read, none,
     with<read_in_blocks, false>, Condition::usable_value},
    {"2.23", "A long value is read in blocks with CRC", "CiA 301, 7.2.4.3.16", Level::read, none,
     with<read_in_blocks, true>, Condition::usable_value, "2.22"},
    {"2.24", "100Ch:00 is written in a block with CRC", "CiA 301, 7.2.4.3.11", Level::communication, none,
     with<write_in_block_with_crc, guard_time>, Condition::none, "2.20"},
    {"2.25", "1017h:00 is written in a block with CRC", "CiA 301, 7.2.4.3.11", Level::communication, none,
     with<write_in_block_with_crc, producer_heartbeat>, Condition::none, "2.21"},
    {"2.26", "A block upload with 128 segments in a block is refused", "CiA 301, 7.2.4.3.13", Level::read, none,
     wrong_block_size},
    {"2.27", "A block upload whose segment 128 is confirmed is refused", "CiA 301, 7.2.4.3.14", Level::read, none,
     wrong_sequence_number},
};

}  // namespace

std::span<const CaseRow> sdo_block_cases() { return sdo_block_rows; }

}  // namespace edsc::conform
