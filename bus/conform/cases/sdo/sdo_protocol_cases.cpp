/// SDO requests that do not fit the state of the server, and the form of its answers (CiA 301, 7.2.4.3).
#include <fmt/format.h>

#include <canopen/can/cob_id.hpp>

#include "conform/case.hpp"
#include "conform/cases/sdo/sdo_entries.hpp"
#include "conform/cases/sdo/sdo_frames.hpp"
#include "conform/cases/shared/entry_values.hpp"

namespace edsc::conform {
namespace {

constexpr Duration a_while = milliseconds{100};

Dut::Match is_response(const Dut& dut) { return Dut::with_id(canopen::default_sdo(dut.node()).response.can_id()); }

/// Sends an abort, also without a transfer.
void send_abort(Dut& dut, std::uint16_t index, std::uint8_t sub_index) {
  const auto code = static_cast<std::uint32_t>(canopen::AbortCode::general);
  dut.send(canopen::default_sdo(dut.node()).request.can_id(), sdo_frame(sdo::abort_command, index, sub_index, code));
  dut.pass_time(milliseconds{5});
}

/// Fails if the server sends anything within a while.
void expect_no_answer(Dut& dut, const std::string& to) {
  const std::vector<SeenFrame> seen = dut.collect(is_response(dut), a_while);
  if (!seen.empty()) dut.fail("no answer to " + to, hex_bytes(seen.front().frame.data));
}

/// A time of 1000h to 1FFFh that the case writes frame by frame.
struct TestedTime {
  std::uint16_t index = 0;
  std::uint64_t present = 0, other = 0;
};

TestedTime need_time(Dut& dut) {
  for (const std::uint16_t index : {producer_heartbeat, guard_time}) {
    if (!dut.is_writable(index) || !dut.is_readable(index)) continue;
    const std::uint64_t other = other_time(dut, index);
    const std::uint64_t present = dut.read_number(index);
    dut.remember(index, 0);
    return {index, present, other};
  }
  dut.not_applicable("the EDS has no writable 1017h:00 or 100Ch:00");
}

void expect_unchanged(Dut& dut, const TestedTime& time, const std::string& when) {
  dut.expect_equal(dut.read_number(time.index), time.present, label(time.index, 0) + " " + when);
}

/// A first segment, or the end of a block, without a transfer. The next request is served.
void without_transfer(Dut& dut, std::uint8_t command, const char* what) {
  send_abort(dut, 0, 0);
  dut.expect_abort(dut.exchange(sdo_frame(command)), abort_rule::command, std::string{what} + " without a transfer");
  expect_served(dut);
}

/// An abort of the client ends the transfer and is not answered.
void abort_of_client(Dut& dut) {
  send_abort(dut, device_type, 0);
  expect_no_answer(dut, "an abort without a transfer");
  expect_served(dut);
  const LiveEntry entry = need_long_entry(dut);
  (void)initiate_upload(dut, entry.index, entry.sub_index);
  const Dut::Mark since = dut.mark();
  send_abort(dut, entry.index, entry.sub_index);
  dut.pass_time(a_while);
  const auto seen = dut.received_since(since, is_response(dut));
  if (!seen.empty()) dut.fail("no answer to an abort of the client", hex_bytes(seen.front().frame.data));
  dut.expect_abort(dut.exchange(sdo_frame(0x60)), abort_rule::command, "a segment requested after the abort");
  expect_served(dut);
}

/// The message has eight bytes: what is missing must not be taken as a value.
void short_request(Dut& dut) {
  const TestedTime time = need_time(dut);
  const SdoFrame request = sdo_frame(0x2B, time.index, 0, static_cast<std::uint32_t>(time.other));
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{4}, std::size_t{5}}) {
    dut.send(canopen::default_sdo(dut.node()).request.can_id(), std::span{request}.first(size));
    dut.pass_time(milliseconds{20});
    expect_unchanged(dut, time, fmt::format("after a request to write it with {} of 8 bytes", size));
  }
}

/// A new initiate is served, at once or after the former transfer is aborted.
void expect_initiated(Dut& dut, const char* during) {
  const SdoFrame initiate = sdo_frame(0x40, device_type, 0);
  std::optional<SdoFrame> answer = dut.exchange(initiate);
  if (answer && (*answer)[0] == sdo::abort_command) {
    dut.expect_abort(answer, abort_rule::command, std::string{"initiate upload of 1000h:00 "} + during);
    answer = dut.exchange(initiate);
  }
  const SdoFrame served = expect_answer(dut, answer, std::string{"the value of 1000h:00 "} + during);
  dut.expect(sdo::multiplexer_of(served) == sdo::multiplexer(device_type, 0), "an answer for 1000h:00",
             hex_bytes(served));
}

void initiate_during_upload(Dut& dut) {
  dut.need(device_type);
  const LiveEntry entry = need_long_entry(dut);
  (void)initiate_upload(dut, entry.index, entry.sub_index);
  expect_initiated(dut, "during an upload");
  dut.end_transfer(device_type, 0);
  expect_served(dut);
}

void initiate_during_download(Dut& dut) {
  dut.need(device_type);
  const TestedTime time = need_time(dut);
  const SdoFrame request = sdo_frame(0x21, time.index, 0, 2);
  (void)expect_command(dut, dut.exchange(request), 0x60, 0xFF, "an answer to initiate download");
  expect_initiated(dut, "during a download");
  dut.end_transfer(device_type, 0);
  expect_unchanged(dut, time, "after a download that was not completed");
}

/// Initiates a segmented download with this size, 0: without a size, and sends one last segment with these bytes.
void write_segment(Dut& dut, const TestedTime& time, std::uint32_t indicated, std::uint8_t bytes,
                   const AbortRule& rule) {
  const std::string size = indicated == 0 ? "without a size" : fmt::format("with an indicated size of {}", indicated);
  const std::string what = fmt::format("{} bytes to {} {}", bytes, label(time.index, 0), size);
  auto answer = dut.exchange(sdo_frame(indicated == 0 ? 0x20 : 0x21, time.index, 0, indicated));
  const bool is_open = answer && (*answer)[0] != sdo::abort_command;
  if (answer && !is_open && indicated == 0) {
    return dut.warn("a download without an indicated size, which CiA 301 allows, is refused: " + hex_bytes(*answer));
  }
  if (is_open) {
    SdoFrame segment = sdo_frame(static_cast<std::uint8_t>((sdo::segment_bytes - bytes) << 1 | sdo::last_segment));
    segment[1] = static_cast<std::uint8_t>(time.other);
    segment[2] = static_cast<std::uint8_t>(time.other >> 8);
    answer = dut.exchange(segment);
  }
  dut.expect_abort(answer, rule, what);
  expect_unchanged(dut, time, "after " + what);
}

/// The number of bytes differs from the indicated size, or from the size of the data type.
void wrong_sizes(Dut& dut) {
  const TestedTime time = need_time(dut);
  write_segment(dut, time, 4, 4, abort_rule::too_long);
  write_segment(dut, time, 1, 1, abort_rule::too_short);
  write_segment(dut, time, 2, 3, abort_rule::too_long);
  write_segment(dut, time, 2, 1, abort_rule::too_short);
  write_segment(dut, time, 0, 3, abort_rule::too_long);
  write_segment(dut, time, 0, 1, abort_rule::too_short);
}

/// An abort has the index and sub-index of the request.
void multiplexer_of_aborts(Dut& dut) {
  std::uint16_t missing = 0x1004;
  while (dut.sheet().find(missing) != nullptr) ++missing;
  for (const std::uint8_t sub_index : {std::uint8_t{0}, std::uint8_t{7}}) {
    const auto answer = dut.exchange(sdo_frame(0x40, missing, sub_index));
    dut.expect_abort(answer, abort_rule::no_object, "read of " + label(missing, sub_index));
    dut.expect(sdo::multiplexer_of(*answer) == sdo::multiplexer(missing, sub_index),
               "an abort with the multiplexer of the request, " + label(missing, sub_index), hex_bytes(*answer));
  }
}

void expect_zeros(Dut& dut, const SdoFrame& answer, std::size_t first, const std::string& what) {
  const bool zeros = std::all_of(answer.begin() + static_cast<std::ptrdiff_t>(first), answer.end(),
                                 [](std::uint8_t byte) { return byte == 0; });
  dut.expect(zeros, fmt::format("{}: the reserved bytes {} to 7 are 0", what, first), hex_bytes(answer));
}

/// Reserved bytes of the answers to a download are 0.
void reserved_bytes(Dut& dut) {
  const TestedTime time = need_time(dut);
  const auto word = static_cast<std::uint32_t>(time.other);
  const std::string expected = "an answer to a download of " + label(time.index, 0);
  expect_zeros(dut, expect_command(dut, dut.exchange(sdo_frame(0x2B, time.index, 0, word)), 0x60, 0xFF, expected), 4,
               "an expedited download");
  expect_zeros(dut, expect_command(dut, dut.exchange(sdo_frame(0x21, time.index, 0, 2)), 0x60, 0xFF, expected), 4,
               "initiate download");
  SdoFrame segment = sdo_frame(static_cast<std::uint8_t>((sdo::segment_bytes - 2) << 1 | sdo::last_segment));
  segment[1] = static_cast<std::uint8_t>(time.other);
  segment[2] = static_cast<std::uint8_t>(time.other >> 8);
  expect_zeros(dut, expect_command(dut, dut.exchange(segment), 0x20, 0xFF, expected), 1, "a download segment");
}

constexpr CaseRow sdo_protocol_rows[] = {
    {"2.101", "A segment requested without an upload is refused", "CiA 301, 7.2.4.3.7", Level::read, none,
     [](Dut& dut) { without_transfer(dut, 0x60, "an upload segment requested"); }},
    {"2.102", "A segment sent without a download is refused", "CiA 301, 7.2.4.3.4", Level::read, none,
     [](Dut& dut) { without_transfer(dut, 0x01, "a download segment"); }, Condition::none, "2.101"},
    {"2.103", "The start, the confirmation and the end of a block without a transfer are refused", "CiA 301, 7.2.4.3.8",
     Level::read, none,
     [](Dut& dut) {
       without_transfer(dut, sdo::block_upload_start, "start of a block upload");
       without_transfer(dut, sdo::block_upload_confirm, "confirmation of a block");
       without_transfer(dut, sdo::block_download_end, "end of a block download");
     }},
    {"2.104", "An abort of the client ends the transfer and is not answered", "CiA 301, 7.2.4.3.17", Level::read, none,
     abort_of_client, Condition::none, "2.101"},
    {"2.105", "A request to write with less than eight bytes changes no value", "CiA 301, 7.2.4.3",
     Level::communication, none, short_request},
    {"2.106", "A request that initiates a transfer is served during an upload", "CiA 301, 7.2.4.2", Level::read, none,
     initiate_during_upload},
    {"2.107", "A request that initiates a transfer is served during a download, which then writes nothing",
     "CiA 301, 7.2.4.2", Level::communication, none, initiate_during_download},
    {"2.108", "A segmented download with a wrong number of bytes is refused and writes nothing", "CiA 301, 7.2.4.3.17",
     Level::communication, none, wrong_sizes},
    {"2.109", "An abort has the index and sub-index of the request", "CiA 301, 7.2.4.3.17", Level::read, none,
     multiplexer_of_aborts},
    {"2.110", "The reserved bytes in the answers to a download are 0", "CiA 301, 7.2.4.3.3 and 7.2.4.3.4",
     Level::communication, none, reserved_bytes},
};

}  // namespace

std::span<const CaseRow> sdo_protocol_cases() { return sdo_protocol_rows; }

}  // namespace edsc::conform
