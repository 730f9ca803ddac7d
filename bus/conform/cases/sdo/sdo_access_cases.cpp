/// Expedited transfer (CiA 301, 7.2.4.3.3 to 7.2.4.3.6), and requests that the server must refuse (7.2.4.3.17).
#include <fmt/format.h>

#include <canopen/can/cob_id.hpp>
#include <canopen/od/access.hpp>

#include "conform/case.hpp"
#include "conform/cases/sdo/sdo_entries.hpp"
#include "conform/cases/sdo/sdo_frames.hpp"
#include "conform/cases/shared/entry_results.hpp"
#include "text/counted.hpp"

namespace edsc::conform {
namespace {

/// Parameters of 1000h to 1FFFh that a case may write at any time.
Entries plain_parameters(const Dut& dut) { return entries_with(dut, is_plain_parameter); }

/// Numbers with this property: parameters of 1000h to 1FFFh, else those at 2000h and above, which need the permission.
template <typename Condition>
Entries numbers_with(Dut& dut, Condition condition) {
  Entries found = entries_with(dut, [&](const LiveEntry& e) { return is_plain_parameter(e) && condition(e); });
  if (!found.empty()) return found;
  found = entries_with(dut, [&](const LiveEntry& e) {
    return is_application_parameter(dut.sheet(), e) && is_number(e) && condition(e);
  });
  if (!found.empty()) dut.need_permission(Permission::application);
  return found;
}

/// The value is refused, and the entry keeps its value. A mappable entry may change by itself and is not compared.
void expect_refused(Dut& dut, const LiveEntry& entry, const Bytes& value, const AbortRule& rule,
                    const std::string& what) {
  const Bytes before = dut.read(entry.index, entry.sub_index);
  dut.expect_abort(dut.download(entry.index, entry.sub_index, value), rule, what + " to " + title(entry));
  if (entry.entry->pdo_mapping) return;
  const Bytes after = dut.read(entry.index, entry.sub_index);
  dut.expect(after == before, title(entry) + " as before: " + hex_bytes(before), hex_bytes(after));
}

void expect_refused(Dut& dut, const LiveEntry& entry, std::uint64_t value, const AbortRule& rule,
                    const std::string& what) {
  expect_refused(dut, entry, dut.bytes_of(entry.index, entry.sub_index, value), rule, what);
}

/// Numbers whose bits satisfy the condition refuse their value with another number of bytes.
template <typename Condition>
void write_resized(Dut& dut, Condition has_bits, std::size_t size, const AbortRule& rule, const char* which) {
  const auto is_wanted = [&](const LiveEntry& entry) { return has_bits(entry.type->bits); };
  const Entries entries = draw(dut, numbers_with(dut, is_wanted));
  if (entries.empty()) dut.not_applicable(fmt::format("the EDS has no writable number of {} bytes", which));
  for (const LiveEntry& entry : entries) {
    Bytes value = dut.read(entry.index, entry.sub_index);
    value.resize(size);
    expect_refused(dut, entry, value, rule, counted(size, "byte"));
  }
}

void read_expedited(Dut& dut) {
  if (!dut.has(device_type)) {
    dut.fail_by_sheet("mandatory-object", "mandatory object 1000h in the EDS", "it does not exist in the EDS");
  }
  const SdoFrame answer = initiate_upload(dut, device_type, 0);
  dut.expect(is_expedited(answer), "an expedited upload of 4 bytes", hex_bytes(answer));
  const bool tells_size = (answer[0] & sdo::size_indicated) != 0;
  dut.expect(!tells_size || (answer[0] & 0x0C) == 0, "n = 0 (4 bytes)", hex_bytes(answer));
  constexpr Duration a_while = milliseconds{50};
  const auto more = dut.collect(Dut::with_id(canopen::default_sdo(dut.node()).response.can_id()), a_while);
  dut.expect(more.empty(), "one answer", fmt::format("{} more", more.size()));
}

/// Writes the value that was read: other values may not be valid on this device.
void read_and_write(Dut& dut) {
  EntryResults results{dut};
  for (const LiveEntry& entry : draw(dut, plain_parameters(dut))) {
    if (results.lost()) break;
    results.count();
    const SdoOutcome before = dut.upload(entry.index, entry.sub_index);
    results.expect_done(entry, before);
    if (!before.done() || !is_within_limits(dut, *entry.entry, before.bytes)) continue;
    const SdoOutcome written = dut.download(entry.index, entry.sub_index, before.bytes);
    results.expect_done(entry, written);
    if (!written.done()) continue;
    const SdoOutcome after = dut.upload(entry.index, entry.sub_index);
    if (!after.done() || after.bytes != before.bytes) {
      results.add_failure(entry, fmt::format("{} written, then {}", hex_bytes(before.bytes),
                                             after.done() ? hex_bytes(after.bytes) : failure_text(after)));
    }
  }
  results.finish("each value can be read, written and read back",
                 "no entry of 1000h to 1FFFh can be written without an effect on other entries");
}

/// Writes the present value, so that a device that accepts it changes nothing.
void write_read_only(Dut& dut) {
  const Entry& entry = dut.need(device_type);
  if (canopen::writable(entry.access)) {
    dut.fail_by_sheet("standard-access", "1000h:00 that is ro or const in the EDS",
                      fmt::format("it is {}", canopen::row_of(entry.access).name));
  }
  dut.expect_abort(dut.download(device_type, 0, dut.read(device_type)), abort_rule::read_only, "write of 1000h:00");
}

void read_write_only(Dut& dut) {
  const Entries entries = draw(dut, entries_with(dut, [&](const LiveEntry& e) {
                                 const bool flagged = (flags_of(dut.sheet(), e) & refuse_read_flag) != 0;
                                 return is_writable(e) && !is_readable(e) && !flagged;
                               }));
  if (entries.empty()) dut.not_applicable("the EDS has no write-only entry");
  const LiveEntry& entry = entries.front();
  dut.expect_abort(dut.upload(entry.index, entry.sub_index), abort_rule::write_only, "read of " + title(entry));
}

void read_missing_sub_index(Dut& dut) {
  dut.need(device_type);
  if (dut.has(device_type, 1)) {
    dut.fail_by_sheet("standard-sub-index", "1000h without sub-index 1 in the EDS", "it has one");
  }
  dut.expect_abort(dut.upload(device_type, 1), abort_rule::no_sub_index, "read of 1000h:01");
}

void read_missing_object(Dut& dut) {
  std::uint16_t index = 0x1004;
  while (dut.sheet().find(index) != nullptr) ++index;
  dut.expect_abort(dut.upload(index, 0), abort_rule::no_object, "read of " + label(index, 0));
}

/// Sends the unused command specifier 7. The server must answer the next request.
void unknown_command(Dut& dut) {
  dut.expect_abort(dut.exchange(sdo_frame(0xE0, device_type, 0)), abort_rule::command, "a request with byte 0 E0h");
  expect_served(dut);
}

// Lengths and limits

void write_too_long(Dut& dut) {
  write_resized(
      dut, [](unsigned bits) { return bits <= 16; }, 4, abort_rule::too_long, "one or two");
}

void write_too_short(Dut& dut) {
  write_resized(
      dut, [](unsigned bits) { return bits == 16 || bits == 32; }, 1, abort_rule::too_short, "two or four");
}

/// Limits of the EDS, else those of CiA 301: 1003h:00 accepts only 0, and transmission type 241 is reserved.
void write_too_high(Dut& dut) {
  const Entries limited = numbers_with(dut, [&](const LiveEntry& e) {
    const bool allowed = is_communication(e) || dut.allowed(Permission::application);
    return allowed && value_above_limit(dut, *e.entry).has_value();
  });
  for (const LiveEntry& entry : draw(dut, limited)) {
    const std::uint64_t value = *value_above_limit(dut, *entry.entry);
    expect_refused(dut, entry, value, abort_rule::too_high, "a value above the HighLimit");
  }
  if (!limited.empty()) return;
  if (dut.is_writable(error_history)) {
    // Not recorded: writing the number of errors back would clear the history.
    return dut.expect_abort(dut.command(error_history, 0, Bytes{1}), abort_rule::too_high, "1 to 1003h:00");
  }
  const Entries types = entries_with(dut, [](const LiveEntry& e) {
    return is_plain_parameter(e) && e.index >= 0x1800 && e.index <= 0x19FF && e.sub_index == 2;
  });
  if (types.empty()) dut.not_applicable("the EDS has no writable entry with a HighLimit, 1003h:00 or 1800h:02");
  constexpr std::uint64_t reserved_type = 241;
  expect_refused(dut, types.front(), reserved_type, abort_rule::too_high, "transmission type 241");
}

void write_too_low(Dut& dut) {
  const Entries limited =
      numbers_with(dut, [&](const LiveEntry& e) { return value_below_limit(dut, *e.entry).has_value(); });
  if (limited.empty())
    dut.not_applicable("the EDS has no writable entry with a LowLimit above the minimum of its data type");
  for (const LiveEntry& entry : draw(dut, limited)) {
    const std::uint64_t value = *value_below_limit(dut, *entry.entry);
    expect_refused(dut, entry, value, abort_rule::too_low, "a value below the LowLimit");
  }
}

void default_cob_ids(Dut& dut) {
  dut.need(default_sdo_server, 1);
  dut.need(default_sdo_server, 2);
  const unsigned node = dut.node().value();
  dut.expect_equal(dut.read_number(default_sdo_server, 1), canopen::function_code::sdo_request + node, "1200h:01");
  dut.expect_equal(dut.read_number(default_sdo_server, 2), canopen::function_code::sdo_response + node, "1200h:02");
}

constexpr CaseRow sdo_access_rows[] = {
    {"2.1", "1000h:00 is read in one frame", "CiA 301, 7.2.4.3.6", Level::read, none, read_expedited},
    {"2.2", "Randomly selected communication parameters are read, written and read back", "CiA 301, 7.2.4.2",
     Level::communication, none, read_and_write},
    {"2.3", "A write of the read-only 1000h:00 is refused", "CiA 301, 7.2.4.3.17", Level::communication, none,
     write_read_only},
    {"2.4", "A read of a write-only entry is refused", "CiA 301, 7.2.4.3.17", Level::read, none, read_write_only},
    {"2.5", "A read of the missing sub-index 1000h:01 is refused", "CiA 301, 7.2.4.3.17", Level::read, none,
     read_missing_sub_index},
    {"2.6", "A read of an object that does not exist is refused", "CiA 301, 7.2.4.3.17", Level::read, none,
     read_missing_object},
    {"2.7", "A request with an unknown command specifier is refused", "CiA 301, 7.2.4.3.17", Level::read, none,
     unknown_command},
    {"2.8", "Four bytes for a number of one or two are refused", "CiA 301, 7.2.4.3.17", Level::communication, none,
     write_too_long},
    {"2.9", "One byte for a number of two or four is refused", "CiA 301, 7.2.4.3.17", Level::communication, none,
     write_too_short},
    {"2.10", "A value that is too high is refused", "CiA 301, 7.2.4.3.17", Level::communication, none, write_too_high},
    {"2.11", "A value that is too low is refused", "CiA 301, 7.2.4.3.17", Level::communication, none, write_too_low},
    {"2.12", "1200h has the COB-IDs of the default SDO", "CiA 301, 7.5.2.33", Level::read, none, default_cob_ids},
};

}  // namespace

std::span<const CaseRow> sdo_access_cases() { return sdo_access_rows; }

}  // namespace edsc::conform
