#include "conform/cases/sdo/sdo_entries.hpp"

#include <algorithm>

#include "conform/cases/sdo/sdo_frames.hpp"

namespace edsc::conform {

Entries draw(Dut& dut, Entries entries) {
  std::ranges::shuffle(entries, dut.random());
  constexpr std::size_t drawn_entries = 8;
  if (entries.size() > drawn_entries) entries.resize(drawn_entries);
  return entries;
}

void expect_served(Dut& dut) {
  if (dut.has(device_type)) return (void)dut.read(device_type);
  const SdoOutcome outcome = dut.upload(device_type);
  dut.expect(outcome.done() || outcome.end == SdoEnd::refused, "an answer to the next request", outcome_text(outcome));
}

void expect_length(Dut& dut, const LiveEntry& entry, std::size_t size) {
  if (entry.type->bits != 0) dut.expect_equal(size, bytes_for(entry.type->bits), "the bytes of " + title(entry));
}

Entries long_entries(const Dut& dut) {
  return entries_with(dut, [&](const LiveEntry& entry) {
    if (!is_readable(entry) || entry.type == nullptr || is_domain(entry)) return false;
    return (entry.type->bits == 0 || entry.type->bits > 32) && (flags_of(dut.sheet(), entry) & refuse_read_flag) == 0;
  });
}

bool is_segmented(Dut& dut, const LiveEntry& entry) {
  const auto answer = dut.exchange(sdo_frame(0x40, entry.index, entry.sub_index));
  if (!answer || (*answer)[0] == sdo::abort_command) return false;
  dut.end_transfer(entry.index, entry.sub_index);
  return !is_expedited(*answer);
}

LiveEntry need_long_entry(Dut& dut) {
  Entries entries = long_entries(dut);
  const auto is_constant = [](const LiveEntry& e) { return e.entry->access == canopen::Access::constant; };
  std::stable_partition(entries.begin(), entries.end(), is_constant);
  const LiveEntry* short_entry = nullptr;
  constexpr std::size_t max_expedited = 4;
  for (const LiveEntry& entry : entries) {
    if (!is_segmented(dut, entry)) continue;
    const SdoOutcome present = dut.upload(entry.index, entry.sub_index);
    if (!present.done() || present.bytes.size() > max_expedited) return entry;
    short_entry = &entry;
  }
  if (short_entry != nullptr) {
    dut.inconclusive(Condition::usable_value, title(*short_entry) + " has a value of at most 4 bytes");
  }
  dut.not_applicable("no readable entry of the EDS has a value of more than 4 bytes");
}

std::uint64_t other_time(Dut& dut, std::uint16_t index) {
  const Entry& entry = dut.need_writable(index);
  const std::uint16_t other = index == guard_time ? producer_heartbeat : guard_time;
  if (dut.is_writable(other) && dut.read_number(other) != 0) dut.write(other, 0, 0);
  const std::uint64_t present = dut.read_number(index);
  for (const std::uint64_t value : {1000U, 500U, 250U, 100U, 0U}) {
    if (value != present && is_within_limits(dut, entry, dut.bytes_of(index, 0, value))) return value;
  }
  dut.inconclusive("the limits of " + label(index, 0) + " exclude 0, 100, 250, 500 and 1000 ms");
}

}  // namespace edsc::conform
