/// Area 2: SDO (CiA 301, 7.2.4).
#include <fmt/format.h>

#include <algorithm>
#include <canopen/base/abort_code.hpp>
#include <canopen/can/cob_id.hpp>
#include <canopen/od/access.hpp>
#include <canopen/sdo/sdo_client.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "conform/case.hpp"
#include "conform/cases/entry_results.hpp"
#include "conform/cases/entry_values.hpp"
#include "conform/cases/sdo_frames.hpp"
#include "conform/dut.hpp"

namespace edsc::conform {
namespace sdo_area {
namespace {

namespace sdo = canopen::sdo;
using canopen::CobId;

constexpr std::uint16_t device_type = 0x1000;
constexpr std::uint16_t error_history = 0x1003;
constexpr std::uint16_t guard_time = 0x100C;
constexpr std::uint16_t store_parameters = 0x1010;
constexpr std::uint16_t heartbeat_time = 0x1017;
constexpr std::uint16_t default_server = 0x1200;
constexpr std::uint16_t first_server = 0x1201, last_server = 0x127F;
constexpr std::uint16_t first_client = 0x1280, last_client = 0x12FF;

constexpr std::size_t drawn_entries = 8;  ///< in a case that tests a random selection

using Entries = std::vector<LiveEntry>;

template <typename Condition>
Entries entries_with(const Dut& dut, Condition condition) {
  Entries found;
  for (LiveEntry& entry : dut.entries()) {
    if (condition(entry)) found.push_back(std::move(entry));
  }
  return found;
}

/// A random selection.
Entries draw(Dut& dut, Entries entries) {
  std::ranges::shuffle(entries, dut.random());
  if (entries.size() > drawn_entries) entries.resize(drawn_entries);
  return entries;
}

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

/// Expects an answer to the next request.
void expect_served(Dut& dut) {
  if (dut.has(device_type)) return (void)dut.read(device_type);
  const SdoOutcome outcome = dut.upload(device_type);
  dut.expect(outcome.done() || outcome.end == SdoEnd::refused, "an answer to the next request", outcome_text(outcome));
}

// Expedited transfer

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

void write_too_long(Dut& dut) {
  const Entries entries = draw(dut, numbers_with(dut, [](const LiveEntry& e) { return e.type->bits <= 16; }));
  if (entries.empty()) dut.not_applicable("the EDS has no writable number of one or two bytes");
  for (const LiveEntry& entry : entries) {
    Bytes value = dut.read(entry.index, entry.sub_index);
    value.resize(4);
    expect_refused(dut, entry, value, abort_rule::too_long, "4 bytes");
  }
}

void write_too_short(Dut& dut) {
  const auto has_more = [](const LiveEntry& e) { return e.type->bits == 16 || e.type->bits == 32; };
  const Entries entries = draw(dut, numbers_with(dut, has_more));
  if (entries.empty()) dut.not_applicable("the EDS has no writable number of two or four bytes");
  for (const LiveEntry& entry : entries) {
    Bytes value = dut.read(entry.index, entry.sub_index);
    value.resize(1);
    expect_refused(dut, entry, value, abort_rule::too_short, "1 byte");
  }
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
  const Entry* history = dut.entry(error_history);
  if (history != nullptr && canopen::writable(history->access)) {
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
  dut.need(default_server, 1);
  dut.need(default_server, 2);
  const unsigned node = dut.node().value();
  dut.expect_equal(dut.read_number(default_server, 1), canopen::function_code::sdo_request + node, "1200h:01");
  dut.expect_equal(dut.read_number(default_server, 2), canopen::function_code::sdo_response + node, "1200h:02");
}

// Segmented transfer

/// Expects the number of bytes of the data type, unless its length is variable.
void expect_length(Dut& dut, const LiveEntry& entry, std::size_t size) {
  if (entry.type->bits != 0) dut.expect_equal(size, (entry.type->bits + 7U) / 8U, "the bytes of " + title(entry));
}

/// Readable entries whose values may have more than four bytes.
Entries long_entries(const Dut& dut) {
  return entries_with(dut, [&](const LiveEntry& entry) {
    if (!is_readable(entry) || entry.type == nullptr || is_domain(entry)) return false;
    return (entry.type->bits == 0 || entry.type->bits > 32) && (flags_of(dut.sheet(), entry) & refuse_read_flag) == 0;
  });
}

/// Whether the device uploads the entry in segments: its present value has more than four bytes.
bool is_segmented(Dut& dut, const LiveEntry& entry) {
  const auto answer = dut.exchange(sdo_frame(0x40, entry.index, entry.sub_index));
  if (!answer || (*answer)[0] == sdo::abort_command) return false;
  dut.end_transfer(entry.index, entry.sub_index);
  return !is_expedited(*answer);
}

/// Returns an entry whose present value has more than four bytes; constants first, because two reads must be equal.
LiveEntry need_long_entry(Dut& dut) {
  Entries entries = long_entries(dut);
  const auto is_constant = [](const LiveEntry& e) { return e.entry->access == canopen::Access::constant; };
  std::stable_partition(entries.begin(), entries.end(), is_constant);
  for (const LiveEntry& entry : entries) {
    if (is_segmented(dut, entry)) return entry;
  }
  dut.not_applicable("no readable entry of the EDS has a value of more than 4 bytes");
}

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

/// A time that differs from the present one. Disables the other of guarding and heartbeat, which exclude each other.
std::uint64_t other_time(Dut& dut, std::uint16_t index) {
  const Entry& entry = dut.need_writable(index);
  const std::uint16_t other = index == guard_time ? heartbeat_time : guard_time;
  const Entry* other_entry = dut.entry(other);
  if (other_entry != nullptr && canopen::writable(other_entry->access) && dut.read_number(other) != 0)
    dut.write(other, 0, 0);
  const std::uint64_t present = dut.read_number(index);
  for (const std::uint64_t value : {1000U, 500U, 250U, 100U, 0U}) {
    if (value != present && is_within_limits(dut, entry, dut.bytes_of(index, 0, value))) return value;
  }
  dut.inconclusive("the limits of " + label(index, 0) + " exclude 0, 100, 250, 500 and 1000 ms");
}

/// A wrong toggle bit is refused, and the value is not stored.
template <std::uint16_t Index>
void write_segmented(Dut& dut) {
  const std::uint64_t value = other_time(dut, Index);
  const std::uint64_t before = dut.read_number(Index);
  const Bytes bytes = dut.bytes_of(Index, 0, value);
  dut.expect_abort(download_with_wrong_toggle(dut, Index, 0, bytes), abort_rule::toggle_bit,
                   "a first segment with toggle bit 1");
  dut.expect_equal(dut.read_number(Index), before, label(Index, 0) + " after a wrong toggle bit");
  download_by_segments(dut, Index, 0, bytes);
  dut.expect_equal(dut.read_number(Index), value, label(Index, 0));
}

// Block transfer: a device that does not support it refuses to initiate it with 0504 0001h.

void read_short_value_in_block(Dut& dut) {
  dut.need(device_type);
  const BlockValue value = upload_by_blocks(dut, device_type, 0, {});
  dut.expect(value.bytes == dut.read(device_type), "the 4 bytes of 1000h:00", hex_bytes(value.bytes));
}

/// In one block, in blocks of one segment, and with a repeated block.
void read_long_value_in_blocks(Dut& dut, bool crc) {
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

void read_in_blocks(Dut& dut) { read_long_value_in_blocks(dut, false); }
void read_in_blocks_with_crc(Dut& dut) { read_long_value_in_blocks(dut, true); }

void expect_block_written(Dut& dut, std::uint16_t index, std::uint64_t value, SentCrc crc) {
  const auto answer = download_by_block(dut, index, 0, dut.bytes_of(index, 0, value), crc);
  (void)expect_command(dut, answer, sdo::block_download_end_answer, 0xFF, "the end of the block download");
  dut.expect_equal(dut.read_number(index), value, label(index, 0));
}

template <std::uint16_t Index>
void write_in_block(Dut& dut) {
  expect_block_written(dut, Index, other_time(dut, Index), SentCrc::none);
}

/// A wrong CRC is refused, and the value is not stored.
template <std::uint16_t Index>
void write_in_block_with_crc(Dut& dut) {
  const std::uint64_t value = other_time(dut, Index);
  const std::uint64_t before = dut.read_number(Index);
  constexpr AbortRule wrong_crc{{canopen::AbortCode::crc}, {canopen::AbortCode::general}};
  dut.expect_abort(download_by_block(dut, Index, 0, dut.bytes_of(Index, 0, value), SentCrc::wrong), wrong_crc,
                   "a block with a wrong CRC");
  dut.expect_equal(dut.read_number(Index), before, label(Index, 0) + " after a wrong CRC");
  expect_block_written(dut, Index, value, SentCrc::right);
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

// SDO parameters

using ParameterValues = std::map<std::pair<std::uint16_t, std::uint8_t>, Bytes>;

/// A valid SDO server must not have a restricted CAN-ID.
void expect_usable(Dut& dut, const Entry& entry, std::uint64_t value) {
  constexpr std::uint32_t dynamic_bit = 0x4000'0000;
  if (entry.sub_index != 1 && entry.sub_index != 2) return;
  const CobId cob_id{static_cast<std::uint32_t>(value) & ~dynamic_bit};
  dut.expect(!cob_id.valid() || canopen::is_usable(cob_id.value()),
             "no restricted CAN-ID in " + label(entry.index, entry.sub_index), fmt::format("{:08X}h", value));
}

void read_sdo_parameter(Dut& dut, const Object& object, ParameterValues& values) {
  for (const Entry& entry : object.entries) {
    if (!canopen::readable(entry.access)) continue;
    const Bytes& value = values[{entry.index, entry.sub_index}] = dut.read(entry.index, entry.sub_index);
    if (object.index <= last_server) expect_usable(dut, entry, number_of(value));
  }
  if (!object.has_sub_indices()) return;
  if (const Entry* count = object.find(0); count != nullptr && count->type->type != canopen::DataType::unsigned8) {
    dut.fail_by_sheet("sub-index-0-type", label(object.index, 0) + " as UNSIGNED8 in the EDS",
                      std::string{count->type->name});
  }
  const std::uint64_t highest = dut.default_of(object.index, 0).value_or(object.highest_sub_index());
  dut.expect_equal(dut.read_number(object.index), highest, label(object.index, 0));
}

/// Reads all objects of the range: those of the EDS can be read, and the others do not exist.
ParameterValues read_sdo_parameters(Dut& dut, std::uint16_t first, std::uint16_t last) {
  ParameterValues values;
  for (std::uint16_t index = first; index <= last; ++index) {
    const Object* object = dut.sheet().find(index);
    if (object != nullptr) {
      read_sdo_parameter(dut, *object, values);
    } else {
      dut.expect_abort(dut.upload(index, 0), abort_rule::no_object, "read of " + label(index, 0));
    }
  }
  return values;
}

void read_servers(Dut& dut) { (void)read_sdo_parameters(dut, first_server, last_server); }

/// An SDO parameter of the range whose SDO is not valid, so that its values may change without an effect on the bus.
const Object* unused_parameter(Dut& dut, std::uint16_t first, std::uint16_t last, std::uint8_t sub_index) {
  for (const Object& object : dut.sheet().objects) {
    if (object.index < first || object.index > last || object.find(1) == nullptr) continue;
    const Entry* entry = object.find(sub_index);
    if (entry == nullptr || !canopen::writable(entry->access) || !canopen::readable(entry->access)) continue;
    if ((dut.read_number(object.index, 1) & CobId::invalid_bit) != 0) return &object;
  }
  return nullptr;
}

/// Reset communication restores the power-on values of the parameters.
void read_servers_after_reset(Dut& dut) {
  if (dut.sheet().find(first_server) == nullptr) dut.not_applicable("1201h does not exist in the EDS");
  dut.reset(canopen::NmtCommand::reset_communication);
  const auto before = read_sdo_parameters(dut, first_server, last_server);
  if (const Object* server = unused_parameter(dut, first_server, last_server, 1)) {
    constexpr std::uint32_t unused = CobId::invalid_bit | 0x6A0, other = CobId::invalid_bit | 0x6A1;
    // A device may refuse the CAN-ID and keep its value, which the reset then must not change.
    const std::uint64_t value = dut.read_number(server->index, 1) == unused ? other : unused;
    (void)dut.download(server->index, 1, value);
  }
  dut.reset(canopen::NmtCommand::reset_communication);
  for (const auto& [key, bytes] : read_sdo_parameters(dut, first_server, last_server)) {
    const std::string entry = label(key.first, key.second) + " ";
    const Bytes& wanted = before.at(key);
    dut.expect(bytes == wanted, entry + hex_bytes(wanted) + ", as after the last reset", entry + hex_bytes(bytes));
  }
}

SdoOutcome save(Dut& dut) { return dut.command(store_parameters, 1, Bytes{'s', 'a', 'v', 'e'}); }

/// A stored client parameter remains after reset communication. Objects that the EDS does not have do not exist.
void save_clients(Dut& dut) {
  (void)read_sdo_parameters(dut, first_client, last_client);
  constexpr std::uint8_t server_node = 3;
  const Object* client = unused_parameter(dut, first_client, last_client, server_node);
  if (client == nullptr) return;
  dut.need_writable(store_parameters, 1);
  constexpr std::uint64_t on_command = 1;
  if ((dut.read_number(store_parameters, 1) & on_command) == 0)
    dut.not_applicable("1010h:01 says that the device does not save on command");
  const std::uint64_t before = dut.read_number(client->index, server_node);
  const std::uint64_t changed = before == 1 ? 2 : 1;
  dut.write(client->index, server_node, changed);
  dut.expect_done(save(dut), "save to 1010h:01");
  dut.reset(canopen::NmtCommand::reset_communication);
  const std::uint64_t after = dut.read_number(client->index, server_node);
  dut.write(client->index, server_node, before);
  dut.expect_done(save(dut), "save with the former value to 1010h:01");
  dut.expect_equal(after, changed, label(client->index, server_node) + " after save and reset communication");
}

constexpr Permission none = Permission::none;

constexpr CaseRow rows[] = {
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
    {"2.13", "1000h:00 is read by a client that accepts segments", "CiA 301, 7.2.4.3.5", Level::read, none,
     read_short_value_segmented},
    {"2.14", "100Ch:00 is written in a segment", "CiA 301, 7.2.4.3.4", Level::communication, none,
     write_segmented<guard_time>},
    {"2.15", "1017h:00 is written in a segment", "CiA 301, 7.2.4.3.4", Level::communication, none,
     write_segmented<heartbeat_time>},
    {"2.16", "A value of more than four bytes is uploaded in segments", "CiA 301, 7.2.4.3.6", Level::read, none,
     read_long_value},
    {"2.17", "A segment requested with the wrong toggle bit is refused", "CiA 301, 7.2.4.3.7", Level::read, none,
     wrong_toggle_bit},
    {"2.18", "Randomly selected long values are completely uploaded in segments", "CiA 301, 7.2.4.3.7", Level::read,
     none, read_segmented},
    {"2.19", "1000h:00 is read in a block without CRC", "CiA 301, 7.2.4.3.12", Level::read, none,
     read_short_value_in_block},
    {"2.20", "100Ch:00 is written in a block without CRC", "CiA 301, 7.2.4.3.8", Level::communication, none,
     write_in_block<guard_time>},
    {"2.21", "1017h:00 is written in a block without CRC", "CiA 301, 7.2.4.3.8", Level::communication, none,
     write_in_block<heartbeat_time>},
    {"2.22", "A long value is read in blocks without CRC", "CiA 301, 7.2.4.3.14", Level::read, none, read_in_blocks},
    {"2.23", "A long value is read in blocks with CRC", "CiA 301, 7.2.4.3.16", Level::read, none,
     read_in_blocks_with_crc},
    {"2.24", "100Ch:00 is written in a block with CRC", "CiA 301, 7.2.4.3.11", Level::communication, none,
     write_in_block_with_crc<guard_time>},
    {"2.25", "1017h:00 is written in a block with CRC", "CiA 301, 7.2.4.3.11", Level::communication, none,
     write_in_block_with_crc<heartbeat_time>},
    {"2.26", "A block upload with 128 segments in a block is refused", "CiA 301, 7.2.4.3.13", Level::read, none,
     wrong_block_size},
    {"2.27", "A block upload whose segment 128 is confirmed is refused", "CiA 301, 7.2.4.3.14", Level::read, none,
     wrong_sequence_number},
    {"2.28", "The objects 1201h to 127Fh are those of the EDS", "CiA 301, 7.5.2.33", Level::read, none, read_servers},
    {"2.29", "Reset communication restores the values of 1201h to 127Fh", "CiA 301, 7.5.2.33", Level::communication,
     none, read_servers_after_reset},
    {"2.30", "Reset communication keeps stored values of 1280h to 12FFh", "CiA 301, 7.5.2.34", Level::communication,
     Permission::store, save_clients},
};

}  // namespace
}  // namespace sdo_area

std::span<const CaseRow> sdo_cases() { return sdo_area::rows; }

}  // namespace edsc::conform
