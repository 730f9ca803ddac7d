/// Segmented transfer (CiA 301, 7.2.4.3.4 to 7.2.4.3.7).
#include <canopen/od/access.hpp>

#include "conform/case.hpp"
#include "conform/cases/sdo/sdo_entries.hpp"
#include "conform/cases/sdo/sdo_frames.hpp"

namespace edsc::conform {
namespace {

/// The server may upload a value of four bytes expedited or in a segment.
void read_short_value_segmented(Dut& dut) {
  dut.need(device_type);
  const Bytes value = upload_by_segments(dut, device_type, 0);
  dut.expect(value == dut.read(device_type), "the same 4 bytes as before", hex_bytes(value));
}

void read_long_value(Dut& dut) {
  const LiveEntry entry = need_long_entry(dut);
  expect_length(dut, entry, upload_by_segments(dut, entry.index, entry.sub_index).size());
}

void wrong_toggle_bit(Dut& dut) {
  const LiveEntry entry = need_long_entry(dut);
  (void)initiate_upload(dut, entry.index, entry.sub_index);
  dut.expect_abort(dut.exchange(sdo_frame(0x60 | sdo::toggle)), abort_rule::toggle_bit,
                   "the first segment of " + title(entry) + " requested with toggle bit 1");
  expect_served(dut);
}

void read_segmented(Dut& dut) {
  const LiveEntry first = need_long_entry(dut);
  for (const LiveEntry& entry : draw(dut, long_entries(dut))) {
    if (is_segmented(dut, entry))
      expect_length(dut, entry, upload_by_segments(dut, entry.index, entry.sub_index).size());
  }
  const Bytes value = upload_by_segments(dut, first.index, first.sub_index);
  const bool constant = first.entry->access == canopen::Access::constant;
  dut.expect(!constant || value == dut.read(first.index, first.sub_index), "the same bytes of " + title(first),
             hex_bytes(value));
}

/// A wrong toggle bit is refused, and the value is not stored.
void write_segmented(Dut& dut, std::uint16_t index) {
  const std::uint64_t value = other_time(dut, index);
  const std::uint64_t before = dut.read_number(index);
  const Bytes bytes = dut.bytes_of(index, 0, value);
  dut.expect_abort(download_with_wrong_toggle(dut, index, 0, bytes), abort_rule::toggle_bit,
                   "a first segment with toggle bit 1");
  dut.expect_equal(dut.read_number(index), before, label(index, 0) + " after a wrong toggle bit");
  download_by_segments(dut, index, 0, bytes);
  dut.expect_equal(dut.read_number(index), value, label(index, 0));
}

/// A value that fills its last segment: neither segments nor blocks may end early or go on.
void read_whole_segments(Dut& dut) {
  constexpr std::string_view letters = "fourteen bytes";
  static_assert(letters.size() % sdo::segment_bytes == 0);
  const Bytes value(letters.begin(), letters.end());
  const Entries entries = entries_with(dut, [&dut](const LiveEntry& entry) {
    return is_application_parameter(dut.sheet(), entry) && is_writable(entry) && is_readable(entry) &&
           entry.type != nullptr && entry.type->kind == canopen::DataClass::string;
  });
  for (const LiveEntry& entry : entries) {
    if (!dut.download(entry.index, entry.sub_index, value).done()) continue;
    if (dut.read(entry.index, entry.sub_index) != value) continue;
    dut.expect(upload_by_segments(dut, entry.index, entry.sub_index) == value,
               "the 14 bytes written to " + title(entry) + ", in segments", "other bytes");
    for (const std::uint8_t segments : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{127}}) {
      const BlockValue read =
          upload_by_blocks(dut, entry.index, entry.sub_index, {.crc = false, .block_size = segments});
      dut.expect(read.bytes == value, "the 14 bytes written to " + title(entry) + ", in blocks", hex_bytes(read.bytes));
    }
    return;
  }
  dut.not_applicable("no writable string of 2000h and above accepts 14 bytes");
}

constexpr CaseRow sdo_segment_rows[] = {
    {"2.13", "1000h:00 is read by a client that accepts segments", "CiA 301, 7.2.4.3.5", Level::read, none,
     read_short_value_segmented},
    {"2.14", "100Ch:00 is written in a segment", "CiA 301, 7.2.4.3.4", Level::communication, none,
     with<write_segmented, guard_time>},
    {"2.15", "1017h:00 is written in a segment", "CiA 301, 7.2.4.3.4", Level::communication, none,
     with<write_segmented, producer_heartbeat>},
    {"2.16", "A value of more than four bytes is uploaded in segments", "CiA 301, 7.2.4.3.6", Level::read, none,
     read_long_value, Condition::usable_value},
    {"2.17", "A segment requested with the wrong toggle bit is refused", "CiA 301, 7.2.4.3.7", Level::read, none,
     wrong_toggle_bit, Condition::usable_value, "2.16"},
    {"2.18", "Randomly selected long values are completely uploaded in segments", "CiA 301, 7.2.4.3.7", Level::read,
     none, read_segmented, Condition::usable_value, "2.16"},
    {"2.111", "A value that fills its last segment is uploaded in segments and in blocks",
     "CiA 301, 7.2.4.3.7 and 7.2.4.3.14", Level::communication, Permission::application, read_whole_segments},
};

}  // namespace

std::span<const CaseRow> sdo_segment_cases() { return sdo_segment_rows; }

}  // namespace edsc::conform
