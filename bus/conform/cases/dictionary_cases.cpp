/// Area 4: the object dictionary and its EDS (CiA 301, 7.4). Cases 4.1 and 4.2 are about 1000h to 1FFFh, 4.7 to 4.9
/// about 2000h and above, where ObjFlags restrict the access of tools; the others are about all entries.
#include <fmt/format.h>

#include <algorithm>
#include <canopen/base/abort_code.hpp>
#include <canopen/od/access.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "conform/case.hpp"
#include "conform/cases/sdo/sdo_frames.hpp"
#include "conform/cases/shared/entry_results.hpp"
#include "conform/cases/shared/entry_values.hpp"
#include "conform/cases/shared/product_values.hpp"
#include "conform/dut/dut.hpp"
#include "device/entry_text.hpp"
#include "device/objects/object_structure.hpp"

namespace edsc::conform {
namespace {

using canopen::AbortCode;
using canopen::Access;

bool lacks_flag(const Dut& dut, const LiveEntry& entry, std::uint32_t flag) {
  return (flags_of(dut.sheet(), entry) & flag) == 0;
}

std::size_t type_bytes(const LiveEntry& entry) { return bytes_for(entry.type->bits); }

// Reading

/// Reads only the first answer of the entry and aborts the transfer: a DOMAIN may be long.
SdoOutcome begin_upload(Dut& dut, const LiveEntry& entry) {
  const auto answer = dut.exchange(sdo_frame(0x40, entry.index, entry.sub_index));
  SdoOutcome outcome;
  if (answer && (*answer)[0] == canopen::sdo::abort_command) {
    outcome.end = SdoEnd::refused;
    outcome.code = canopen::abort_code_from(canopen::sdo::word_of(*answer));
    return outcome;
  }
  if (!answer) outcome.end = SdoEnd::no_answer;
  dut.end_transfer(entry.index, entry.sub_index);
  return outcome;
}

SdoOutcome read_entry(Dut& dut, const LiveEntry& entry) {
  return is_domain(entry) ? begin_upload(dut, entry) : dut.upload(entry.index, entry.sub_index);
}

void expect_readable(EntryResults& results, const LiveEntry& entry, const SdoOutcome& outcome) {
  const bool refused = outcome.end == SdoEnd::refused;
  if (refused && may_have_no_value(entry) && outcome.code == AbortCode::no_data) return;
  if (refused && depends_on_state(outcome.code)) return results.add_warning(entry, failure_text(outcome));
  results.expect_done(entry, outcome);
  if (outcome.done() && entry.type->bits != 0 && outcome.bytes.size() != type_bytes(entry)) {
    results.add_failure(
        entry, fmt::format("{} bytes, but {} has {}", outcome.bytes.size(), entry.type->name, type_bytes(entry)));
  }
}

/// Reads each entry that is readable in the EDS and compares the number of bytes with its data type.
void read_entries(Dut& dut, EntryFilter in_area, const std::string& none) {
  EntryResults results{dut};
  for (const LiveEntry& entry : dut.entries()) {
    if (results.lost()) break;
    if (!in_area(entry) || !is_readable(entry) || !lacks_flag(dut, entry, refuse_read_flag)) continue;
    results.count();
    expect_readable(results, entry, read_entry(dut, entry));
  }
  results.finish("each readable entry is read, with the size of its data type", none);
}

constexpr const char* no_application_entries = "the EDS has no such entry at 2000h or above";

void read_communication_entries(Dut& dut) { read_entries(dut, is_communication, "the EDS has no readable entry"); }
void read_application_entries(Dut& dut) { read_entries(dut, is_application, no_application_entries); }

// Defaults

void compare_defaults(Dut& dut, EntryFilter in_area, const std::string& none) {
  EntryResults results{dut};
  for (const LiveEntry& entry : dut.entries()) {
    if (results.lost()) break;
    if (!in_area(entry) || !is_product_value(dut.sheet(), entry)) continue;
    const std::optional<Bytes> expected = default_bytes(dut, *entry.entry);
    if (!expected || !lacks_flag(dut, entry, refuse_read_flag)) continue;
    results.count();
    const SdoOutcome outcome = dut.upload(entry.index, entry.sub_index);
    results.expect_done(entry, outcome);
    if (outcome.done() && trimmed(entry, outcome.bytes) != trimmed(entry, *expected)) {
      results.add_failure(entry,
                          fmt::format("{} instead of {}", value_of(entry, outcome.bytes), value_of(entry, *expected)));
    }
  }
  results.finish("each constant has the DefaultValue of the EDS", none);
}

void compare_communication_defaults(Dut& dut) {
  compare_defaults(dut, is_communication, "the EDS has no constant with a DefaultValue");
}
void compare_application_defaults(Dut& dut) { compare_defaults(dut, is_application, no_application_entries); }

// Access that the entry does not allow

/// The present value of the entry, so that a device that accepts it changes nothing; zeros if it cannot be read.
Bytes fitting_value(Dut& dut, const LiveEntry& entry) {
  SdoOutcome present = dut.upload(entry.index, entry.sub_index);
  if (present.done() && !present.bytes.empty()) return std::move(present.bytes);
  return Bytes(entry.type->bits == 0 ? 1 : type_bytes(entry));
}

/// Entries at 2000h and above only with the permission to write them.
void write_read_only_entries(Dut& dut) {
  EntryResults results{dut};
  for (const LiveEntry& entry : dut.entries()) {
    if (results.lost()) break;
    const bool allowed = is_communication(entry) || dut.allowed(Permission::application);
    const bool flagged = (flags_of(dut.sheet(), entry) & (refuse_write_flag | refuse_read_flag)) != 0;
    if (!allowed || flagged || is_writable(entry) || !is_readable(entry) || is_domain(entry)) continue;
    results.count();
    const Bytes value = fitting_value(dut, entry);
    results.expect_abort(entry, dut.command(entry.index, entry.sub_index, value), abort_rule::read_only, "written");
  }
  results.finish("each write of a read-only entry is refused with 0601 0002h", "the EDS has no read-only entry");
}

void read_write_only_entries(Dut& dut) {
  EntryResults results{dut};
  for (const LiveEntry& entry : dut.entries()) {
    if (results.lost()) break;
    if (is_readable(entry) || !is_writable(entry) || !lacks_flag(dut, entry, refuse_read_flag)) continue;
    results.count();
    results.expect_abort(entry, begin_upload(dut, entry), abort_rule::write_only, "read");
  }
  results.finish("each read of a write-only entry is refused with 0601 0001h", "the EDS has no write-only entry");
}

// Sub-index FFh

/// Fails because of the EDS if its sub-index FFh does not match the object.
void expect_described(Dut& dut, const Object& object) {
  const Entry* entry = object.find(structure_sub_index);
  if (entry == nullptr) return;
  const ObjectStructure structure = structure_of(object);
  const std::uint64_t value = entry->default_value ? entry->default_value->bits : 0;
  if (entry->type->type == canopen::DataType::unsigned32 && structure.matches(value)) return;
  dut.fail_by_sheet(
      "sub-index-255",
      fmt::format("{} of the EDS: UNSIGNED32 with {}", label(object.index, structure_sub_index), structure.text()),
      fmt::format("{} with {:X}h", entry->type->name, value));
}

void check_structures(Dut& dut) {
  EntryResults results{dut};
  for (const Object& object : dut.sheet().objects) {
    if (results.lost()) break;
    if (!object.has_sub_indices()) continue;
    const LiveEntry entry{object.index, structure_sub_index, object.find(structure_sub_index), nullptr, object.name};
    const SdoOutcome outcome = dut.upload(object.index, structure_sub_index);
    const bool missing = outcome.end == SdoEnd::refused && entry.entry == nullptr;
    if (missing) {
      results.expect_abort(entry, outcome, abort_rule::no_sub_index, "read");
      continue;
    }
    results.count();
    results.expect_done(entry, outcome);
    const ObjectStructure expected = structure_of(object);
    if (outcome.done() && (outcome.bytes.size() != 4 || !expected.matches(number_of(outcome.bytes)))) {
      expect_described(dut, object);
      results.add_failure(entry, fmt::format("{}, but the object has {}", hex_bytes(outcome.bytes), expected.text()));
    }
  }
  results.finish("each sub-index FFh has the object code and the data type of its object",
                 "no object has a sub-index FFh");
}

// Limits and writes of the present value

/// A refusal that depends on other values does not fail the case.
void expect_written(EntryResults& results, const LiveEntry& entry, const SdoOutcome& outcome, std::string_view what) {
  if (outcome.end == SdoEnd::refused && depends_on_state(outcome.code))
    return results.add_warning(entry, fmt::format("{}: {}", what, failure_text(outcome)));
  if (outcome.end != SdoEnd::refused) return results.expect_done(entry, outcome);
  results.add_failure(entry, fmt::format("{}: {}", what, failure_text(outcome)));
}

/// A value beyond a limit is refused and not stored.
void try_beyond(Dut& dut, EntryResults& results, const LiveEntry& entry, std::uint64_t beyond, const AbortRule& rule,
                std::string_view name) {
  const Bytes value = dut.bytes_of(entry.index, entry.sub_index, beyond);
  const SdoOutcome before = dut.upload(entry.index, entry.sub_index);
  results.expect_abort(entry, dut.download(entry.index, entry.sub_index, value), rule,
                       fmt::format("{} written, which is beyond the {}", value_of(entry, value), name));
  const SdoOutcome after = dut.upload(entry.index, entry.sub_index);
  if (!entry.entry->pdo_mapping && before.done() && after.done() && after.bytes != before.bytes) {
    results.add_failure(entry,
                        fmt::format("{} refused, but {} stored", value_of(entry, value), value_of(entry, after.bytes)));
  }
}

/// The limit itself is accepted and read back.
void try_limit(Dut& dut, EntryResults& results, const LiveEntry& entry, const Value& limit, std::string_view name) {
  const Bytes value = dut.bytes_of(entry.index, entry.sub_index, bits_of(dut, limit));
  const SdoOutcome outcome = dut.download(entry.index, entry.sub_index, value);
  expect_written(results, entry, outcome, name);
  if (!outcome.done() || entry.entry->pdo_mapping) return;
  const SdoOutcome after = dut.upload(entry.index, entry.sub_index);
  if (after.done() && after.bytes != value) {
    results.add_failure(entry,
                        fmt::format("{} written, then {}", value_of(entry, value), value_of(entry, after.bytes)));
  }
}

/// A value outside the limits could not be written back, so the case does not change it.
std::string outside_limits(const LiveEntry& entry, const Bytes& bytes) {
  return fmt::format("{} is outside the limits {} of the EDS and is not written back", value_of(entry, bytes),
                     limits_text(*entry.entry));
}

/// 6060h of each axis (CiA 402-2): the values between its limits are those of 6502h.
bool is_mode_of_operation(const LiveEntry& entry) {
  constexpr std::uint16_t first = 0x6060, axis = 0x800, end = 0xA000;
  return entry.index >= first && entry.index < end && (entry.index - first) % axis == 0;
}

void try_limits(Dut& dut) {
  EntryResults results{dut};
  for (const LiveEntry& entry : dut.entries()) {
    if (results.lost()) break;
    const Entry& row = *entry.entry;
    const bool may_be_written = is_plain_parameter(entry) || is_application_parameter(dut.sheet(), entry);
    if (!may_be_written || !is_number(entry) || (!row.low_limit && !row.high_limit)) continue;
    const SdoOutcome before = dut.upload(entry.index, entry.sub_index);
    if (!before.done()) continue;  // cases 4.1 and 4.7
    results.count();
    const auto above = value_above_limit(dut, row), below = value_below_limit(dut, row);
    if (above) try_beyond(dut, results, entry, *above, abort_rule::too_high, "HighLimit");
    if (below) try_beyond(dut, results, entry, *below, abort_rule::too_low, "LowLimit");
    if (!is_within_limits(dut, row, before.bytes)) {
      results.add_warning(entry, outside_limits(entry, before.bytes));
      continue;
    }
    if (is_mode_of_operation(entry)) continue;
    if (row.high_limit) try_limit(dut, results, entry, *row.high_limit, "HighLimit");
    if (row.low_limit) try_limit(dut, results, entry, *row.low_limit, "LowLimit");
    // Written back at once, so that an output does not keep its limit during the other entries.
    (void)dut.command(entry.index, entry.sub_index, before.bytes);
  }
  results.finish("values beyond the limits of the EDS are refused, and the limits are accepted",
                 "the EDS has no writable entry with limits");
}

/// Writes the value that was read. A mappable value may change in between and is not compared.
void write_back_values(Dut& dut) {
  EntryResults results{dut};
  for (const LiveEntry& entry : dut.entries()) {
    if (results.lost()) break;
    if (!is_application_parameter(dut.sheet(), entry)) continue;
    const SdoOutcome before = dut.upload(entry.index, entry.sub_index);
    if (!before.done()) continue;  // case 4.7
    results.count();
    if (!is_within_limits(dut, *entry.entry, before.bytes)) {
      results.add_warning(entry, outside_limits(entry, before.bytes));
      continue;
    }
    const SdoOutcome written = dut.command(entry.index, entry.sub_index, before.bytes);
    expect_written(results, entry, written, "the value read before");
    if (!written.done() || entry.entry->pdo_mapping) continue;
    const SdoOutcome after = dut.upload(entry.index, entry.sub_index);
    if (after.done() && after.bytes != before.bytes) {
      results.add_failure(
          entry, fmt::format("{} written, then {}", value_of(entry, before.bytes), value_of(entry, after.bytes)));
    }
  }
  results.finish("each writable entry accepts the value that was read", no_application_entries);
}

constexpr CaseRow dictionary_rows[] = {
    {"4.1", "Each readable entry of 1000h to 1FFFh is read", "CiA 301, 7.4.5", Level::read, Permission::none,
     read_communication_entries},
    {"4.2", "Constants of 1000h to 1FFFh have the values of the EDS", "CiA 306-1, 4.6.2", Level::read, Permission::none,
     compare_communication_defaults},
    {"4.3", "Each write of a read-only entry is refused", "CiA 301, 7.4.5", Level::communication, Permission::none,
     write_read_only_entries, Condition::none, "2.3"},
    {"4.4", "Each read of a write-only entry is refused", "CiA 301, 7.4.5", Level::read, Permission::none,
     read_write_only_entries, Condition::none, "2.4"},
    {"4.5", "Sub-index FFh describes its object", "CiA 301, 7.4.4", Level::read, Permission::none, check_structures},
    {"4.6", "The device enforces the limits of the EDS", "CiA 306-1, 4.6.2", Level::communication,
     Permission::application, try_limits},
    {"4.7", "Each readable entry of 2000h and above is read", "CiA 301, 7.4.5", Level::read, Permission::none,
     read_application_entries},
    {"4.8", "Constants of 2000h and above have the values of the EDS", "CiA 306-1, 4.6.2", Level::read,
     Permission::none, compare_application_defaults},
    {"4.9", "Each writable entry of 2000h and above accepts its present value", "CiA 301, 7.4.5", Level::communication,
     Permission::application, write_back_values},
};

}  // namespace

std::span<const CaseRow> dictionary_cases() { return dictionary_rows; }

}  // namespace edsc::conform
