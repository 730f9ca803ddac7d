#include "conform/cases/restricted_can_ids.hpp"

#include <fmt/format.h>

#include <canopen/can/cob_id.hpp>
#include <canopen/can/cob_id_check.hpp>

#include "conform/cases/shared/entry_results.hpp"
#include "conform/cases/shared/entry_values.hpp"
#include "conform/cases/shared/setup.hpp"

namespace edsc::conform {
namespace {

using canopen::CobId;

/// The first and the last CAN-ID of each range of CiA 301, 7.3.5, table 41.
constexpr std::uint32_t restricted_ids[] = {0x000, 0x001, 0x07F, 0x101, 0x180, 0x581, 0x5FF, 0x601,
                                            0x67F, 0x6E0, 0x6FF, 0x701, 0x77F, 0x780, 0x7FF};

/// The flags that disable the COB-ID, so that its CAN-ID may change, and those that enable it.
struct Flags {
  std::uint32_t off_set = 0, off_cleared = 0, on_set = 0;
};

Flags switching_flags(std::uint16_t index) {
  constexpr std::uint32_t consumes_time = 0x8000'0000;
  switch (index) {
    case sync_cob_id: return {0, CobId::no_rtr_bit, 0};
    case 0x1012: return {0, consumes_time | CobId::no_rtr_bit, consumes_time};
    default: return {CobId::invalid_bit, 0, 0};
  }
}

std::uint32_t cob_id_in(const SdoOutcome& outcome) { return static_cast<std::uint32_t>(number_of(outcome.bytes)); }

/// Disables the COB-ID and tries to enable it with each restricted CAN-ID. A device that accepts one gets it disabled
/// again at once, because the CAN-ID may be in use.
void try_restricted(Dut& dut, EntryResults& results, const LiveEntry& entry, std::uint32_t present) {
  const Flags flags = switching_flags(entry.index);
  const std::uint32_t off = (present | flags.off_set) & ~flags.off_cleared;
  const auto download = [&](std::uint32_t cob_id) { return dut.download(entry.index, entry.sub_index, cob_id); };
  if (off != present) {
    const SdoOutcome disabled = download(off);
    if (!disabled.done()) return results.expect_done(entry, disabled);
  }
  const SdoOutcome before = dut.upload(entry.index, entry.sub_index);  // a device may keep some bits
  const std::uint32_t kept = present & CobId::no_rtr_bit & ~flags.off_cleared;
  for (const std::uint32_t can_id : restricted_ids) {
    const std::string accepted = fmt::format("the restricted CAN-ID {:03X}h is accepted", can_id);
    if (results.expect_abort(entry, download(kept | flags.on_set | can_id), abort_rule::value, accepted)) continue;
    (void)download(off);
    return;
  }
  const SdoOutcome after = dut.upload(entry.index, entry.sub_index);
  results.expect_done(entry, after);
  if (after.done() && after.bytes != before.bytes) {
    results.add_failure(entry,
                        fmt::format("{:08X}h after the refusals, {:08X}h before", cob_id_in(after), cob_id_in(before)));
  }
}

}  // namespace

void restricted_can_ids(Dut& dut) {
  if (dut.has(sync_cob_id)) stop_sync(dut);
  EntryResults results{dut};
  for (const LiveEntry& entry : dut.entries()) {
    if (results.lost()) break;
    const bool holds_cob_id = canopen::find_cob_id_entries(entry.index, entry.sub_index).has_value();
    if (!holds_cob_id || !is_writable(entry) || !is_readable(entry)) continue;
    const SdoOutcome read = dut.upload(entry.index, entry.sub_index);
    results.expect_done(entry, read);
    if (!read.done()) continue;
    const std::uint32_t present = cob_id_in(read);
    if (!canopen::is_legal({entry.index, entry.sub_index, present})) {
      dut.warn(fmt::format("{} is {:08X}h, which could not be restored; not tested",
                           label(entry.index, entry.sub_index), present));
      continue;
    }
    results.count();
    try_restricted(dut, results, entry, present);
  }
  results.finish("each COB-ID refuses the restricted CAN-IDs with " + abort_text(abort_rule::value.standard.front()),
                 "the EDS has no writable COB-ID that can be tested");
}

}  // namespace edsc::conform
