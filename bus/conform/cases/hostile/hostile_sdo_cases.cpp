/// Area 12, continued: SDO transfers that are broken off, late, out of order or repeated.
#include <fmt/format.h>

#include <canopen/can/cob_id.hpp>

#include "conform/case.hpp"
#include "conform/cases/hostile/unharmed.hpp"
#include "conform/cases/sdo/sdo_entries.hpp"
#include "conform/cases/sdo/sdo_frames.hpp"

namespace edsc::conform {
namespace {

using canopen::NmtState;

constexpr auto pre_operational_state = NmtState::pre_operational;

/// Ends the transfer with an abort, or leaves it open.
enum class Ending : std::uint8_t { abort, none };
constexpr Ending endings[] = {Ending::abort, Ending::none};

void end(Dut& dut, Ending ending) {
  if (ending == Ending::abort) dut.end_transfer();
}

/// The device returns 1000h:00: at once, or at the second request if the first one ends a transfer that was left open.
void expect_answer_to_next(Dut& dut, Ending ending, const std::string& when) {
  if (ending == Ending::none) {
    const auto first = dut.exchange(sdo_frame(0x40, device_type, 0));
    dut.expect(first.has_value(), "an answer to the next request " + when, "none");
  }
  const SdoOutcome outcome = dut.upload(device_type);
  dut.expect(outcome.done() || outcome.end == SdoEnd::refused, "an answer to the next request " + when,
             outcome_text(outcome));
}

/// A time of 1000h to 1FFFh that the case begins to write.
std::uint16_t need_writable_time(Dut& dut) {
  for (const std::uint16_t index : {guard_time, producer_heartbeat}) {
    if (!dut.is_writable(index) || !dut.is_readable(index)) continue;
    dut.remember(index, 0);
    return index;
  }
  dut.not_applicable("the EDS has no writable 1017h:00 or 100Ch:00");
}

// ---- the timeout of the server ----

/// The time after which the device aborts an upload whose client is silent; std::nullopt if it waits longer than this.
std::optional<Duration> timeout_of(Dut& dut, const LiveEntry& entry) {
  constexpr Duration longest = milliseconds{3000};
  (void)initiate_upload(dut, entry.index, entry.sub_index);
  const std::uint64_t began = dut.now();
  const auto is_abort = [&](const canopen::Frame& frame) {
    return Dut::with_id(canopen::default_sdo(dut.node()).response.can_id())(frame) &&
           frame.data[0] == sdo::abort_command;
  };
  const auto seen = dut.wait_for(is_abort, longest);
  dut.end_transfer(entry.index, entry.sub_index);
  if (!seen) return std::nullopt;
  return Duration{static_cast<std::uint32_t>(seen->at - began)};
}

/// Requests a segment shortly before and after the timeout: the segment, or an abort.
void late_segments(Dut& dut) {
  need_no_other_node(dut);
  const LiveEntry entry = need_long_entry(dut);
  const std::optional<Duration> timeout = timeout_of(dut, entry);
  const std::uint64_t limit = timeout ? timeout->count() : milliseconds{3000}.count();
  constexpr std::int32_t offsets_us[] = {-5000, -1000, -300, -100, 0, 100, 1000, 5000};
  expect_unharmed(dut, pre_operational_state, "segments requested at the timeout of the server", [&] {
    for (const std::int32_t offset : offsets_us) {
      (void)initiate_upload(dut, entry.index, entry.sub_index);
      dut.pass_time(Duration{static_cast<std::uint32_t>(static_cast<std::int64_t>(limit) + offset)});
      (void)dut.exchange(sdo_frame(0x60));
      dut.end_transfer(entry.index, entry.sub_index);
      dut.pass_time(milliseconds{20});  // the abort of the timeout, and an answer to the segment that came after it
      expect_answer_to_next(dut, Ending::none, "after a late segment");
    }
  });
}

// ---- many requests, and requests in the middle of a transfer ----

void request_burst(Dut& dut) {
  need_no_other_node(dut);
  constexpr unsigned requests = 64;
  expect_unharmed(dut, pre_operational_state, "64 SDO requests one after the other", [&] {
    const Dut::Mark since = dut.mark();
    for (unsigned i = 0; i < requests; ++i) dut.request(sdo_frame(0x40, device_type, 0));
    dut.pass_time(milliseconds{200});
    const auto seen = dut.received_since(since, Dut::with_id(canopen::default_sdo(dut.node()).response.can_id()));
    dut.expect(!seen.empty() && seen.size() <= requests, "1 to 64 answers", std::to_string(seen.size()));
    expect_answer_to_next(dut, Ending::abort, "after 64 requests");
  });
}

void multiplexers_in_transfer(Dut& dut) {
  need_no_other_node(dut);
  const LiveEntry entry = need_long_entry(dut);
  struct Multiplexer {
    std::uint16_t index;
    std::uint8_t sub_index;
  };
  constexpr Multiplexer invalid[] = {{0, 0}, {0, 255}, {0xFFFF, 0}, {0xFFFF, 255}, {device_type, 255}, {0x0FFF, 1}};
  constexpr std::uint8_t commands[] = {0x40, 0x21, 0xA0, 0xC2};
  expect_unharmed(dut, pre_operational_state, "invalid multiplexers during an upload", [&] {
    for (const Multiplexer& wrong : invalid) {
      for (const std::uint8_t command : commands) {
        (void)initiate_upload(dut, entry.index, entry.sub_index);
        (void)dut.exchange(sdo_frame(command, wrong.index, wrong.sub_index, 4));
        (void)dut.exchange(sdo_frame(0x60));
        dut.end_transfer(wrong.index, wrong.sub_index);
      }
      expect_answer_to_next(dut, Ending::abort, "after an invalid multiplexer");
    }
  });
}

// ---- transfers that are broken off at each frame ----

/// Begins an upload and ends it after `frames` requests.
void break_off_upload(Dut& dut, const LiveEntry& entry, unsigned frames) {
  (void)initiate_upload(dut, entry.index, entry.sub_index);
  std::uint8_t toggle = 0;
  for (unsigned i = 1; i < frames; ++i, toggle ^= sdo::toggle) {
    const auto segment = dut.exchange(sdo_frame(static_cast<std::uint8_t>(0x60 | toggle)));
    if (!segment || ((*segment)[0] & sdo::last_segment) != 0) return;
  }
}

void broken_uploads(Dut& dut) {
  need_no_other_node(dut);
  const LiveEntry entry = need_long_entry(dut);
  constexpr unsigned max_frames = 6;
  expect_unharmed(dut, pre_operational_state, "uploads that are broken off", [&] {
    for (const Ending ending : endings) {
      for (unsigned frames = 1; frames <= max_frames; ++frames) {
        break_off_upload(dut, entry, frames);
        end(dut, ending);
        expect_answer_to_next(dut, ending, fmt::format("after an upload of {} frames", frames));
      }
    }
  });
}

/// Downloads one byte of two without the last segment, or only initiates the download. Nothing is written.
void broken_downloads(Dut& dut) {
  need_no_other_node(dut);
  const std::uint16_t index = need_writable_time(dut);
  expect_unharmed(dut, pre_operational_state, "downloads that are broken off", [&] {
    for (const Ending ending : endings) {
      for (const bool with_segment : {false, true}) {
        (void)dut.exchange(sdo_frame(0x21, index, 0, 2));
        if (with_segment) {
          SdoFrame segment = sdo_frame(static_cast<std::uint8_t>((sdo::segment_bytes - 1) << 1));
          segment[1] = 0x39;
          (void)dut.exchange(segment);
        }
        end(dut, ending);
        expect_answer_to_next(dut, ending, "after a download that was not completed");
      }
    }
  });
}

/// Breaks a block upload off after its initiate, its first segments, a wrong confirmation and before its end.
void broken_block_uploads(Dut& dut) {
  need_no_other_node(dut);
  need_block_upload(dut);
  const LiveEntry entry = need_long_entry(dut);
  constexpr std::uint8_t one_segment = 1;
  expect_unharmed(dut, pre_operational_state, "block uploads that are broken off", [&] {
    for (const Ending ending : endings) {
      for (unsigned frames = 1; frames <= 4; ++frames) {
        (void)dut.exchange(sdo_frame(sdo::block_upload_initiate, entry.index, entry.sub_index, one_segment));
        if (frames >= 2) (void)dut.exchange(sdo_frame(sdo::block_upload_start));
        SdoFrame confirm = sdo_frame(sdo::block_upload_confirm);
        confirm[1] = frames == 3 ? 0 : 1;
        confirm[2] = one_segment;
        if (frames >= 3) (void)dut.exchange(confirm);
        end(dut, ending);
        expect_answer_to_next(dut, ending, fmt::format("after a block upload of {} requests", frames));
      }
    }
  });
}

/// During the segments of a block download only an abort ends the transfer. The sequence numbers do not begin with 1,
/// so that the device waits for the segments before.
void broken_block_downloads(Dut& dut) {
  need_no_other_node(dut);
  const std::uint16_t index = need_writable_time(dut);
  constexpr std::uint8_t initiate = sdo::block_download_initiate | sdo::block_size_indicated;
  expect_unharmed(dut, pre_operational_state, "block downloads that are broken off", [&] {
    for (unsigned frames = 1; frames <= 4; ++frames) {
      const auto answer = dut.exchange(sdo_frame(initiate, index, 0, 2));
      if (answer && (*answer)[0] == sdo::abort_command) return;  // no block transfer
      SdoFrame segment = sdo_frame(static_cast<std::uint8_t>(frames == 4 ? 0x82 : 0x02));
      segment[1] = 0x39;
      if (frames >= 2) dut.request(segment);
      if (frames == 3) dut.request(sdo_frame(0x05));
      dut.pass_time(milliseconds{20});
      dut.end_transfer(index, 0);
      expect_answer_to_next(dut, Ending::abort, fmt::format("after a block download of {} requests", frames));
    }
  });
}

/// Toggle bits and commands by chance, on an upload and on a download that is never completed.
void wrong_order(Dut& dut) {
  need_no_other_node(dut);
  const LiveEntry entry = need_long_entry(dut);
  const std::uint16_t index = need_writable_time(dut);
  constexpr std::uint8_t commands[] = {0x60, 0x70, 0x00, 0x10, 0x0C, 0xA1, 0xA2, 0xA3, 0xE0};
  constexpr unsigned rounds = 40;
  expect_unharmed(dut, pre_operational_state, "SDO requests in a wrong order", [&] {
    for (unsigned round = 0; round < rounds; ++round) {
      const bool uploads = round % 2 == 0;
      (void)dut.exchange(uploads ? sdo_frame(0x40, entry.index, entry.sub_index) : sdo_frame(0x21, index, 0, 2));
      for (unsigned i = 0; i < 3; ++i) dut.request(sdo_frame(commands[dut.random()() % std::size(commands)]));
      dut.pass_time(milliseconds{5});
      dut.end_transfer();
      expect_answer_to_next(dut, Ending::abort, "after requests in a wrong order");
    }
  });
}

constexpr CaseRow hostile_sdo_rows[] = {
    {"12.101", "Segments that are requested at the timeout of the server are served or refused", "CiA 301, 7.2.4.3.17",
     Level::hostile, none, late_segments, on_own_bus},
    {"12.102", "64 SDO requests one after the other do not block the server", "CiA 301, 7.2.4.1", Level::hostile, none,
     request_burst, on_own_bus},
    {"12.103", "Invalid multiplexers during an upload have no effect", "CiA 301, 7.2.4.3.17", Level::hostile, none,
     multiplexers_in_transfer, on_own_bus},
    {"12.104", "Uploads can be broken off at each frame", "CiA 301, 7.2.4.3.17", Level::hostile, none, broken_uploads,
     on_own_bus},
    {"12.105", "Downloads can be broken off at each frame and then write nothing", "CiA 301, 7.2.4.3.17",
     Level::hostile, none, broken_downloads, on_own_bus},
    {"12.106", "Block uploads can be broken off at each frame", "CiA 301, 7.2.4.3.17", Level::hostile, none,
     broken_block_uploads, on_own_bus},
    {"12.107", "Block downloads can be broken off at each frame and then write nothing", "CiA 301, 7.2.4.3.17",
     Level::hostile, none, broken_block_downloads, on_own_bus},
    {"12.108", "SDO requests in a wrong order have no effect", "CiA 301, 7.2.4.3.17", Level::hostile, none, wrong_order,
     on_own_bus},
};

}  // namespace

std::span<const CaseRow> hostile_sdo_cases() { return hostile_sdo_rows; }

}  // namespace edsc::conform
