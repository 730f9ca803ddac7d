#include "online/sdo_access.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/nmt/error_control.hpp>
#include <cstring>
#include <iterator>

#include "device/device.hpp"
#include "values/append.hpp"

namespace edsc {
namespace {

using canopen::AbortCode;
using canopen::Duration;
using canopen::Frame;

/// Waiting time for remaining frames of a failed transfer.
constexpr Duration after_a_break = canopen::from_milliseconds(50);

/// Additional bytes accepted for a value that is longer than its type in the EDS.
constexpr std::size_t type_margin = 64;

canopen::SdoClientOptions options_of(const SdoSettings& settings, bool block) {
  canopen::SdoClientOptions options;
  options.timeout = Duration{settings.timeout_ms * 1000U};
  options.block_transfer = block;
  return options;
}

bool is_boot_up_of(const Frame& frame, canopen::NodeId node) {
  const auto message = canopen::error_control_message(frame);
  return message && message->node_id == node && !message->toggle && message->state == canopen::NmtState::initialisation;
}

/// An expedited response that does not state its size (CiA 301, 7.2.4.3.6).
bool is_upload_without_size(const Frame& frame) {
  using namespace canopen::sdo;
  constexpr std::uint8_t command = 0xE0, initiate_upload = 0x40;
  return frame.size == 8 && (frame.data[0] & (command | expedited | size_indicated)) == (initiate_upload | expedited);
}

/// A client, and how its transfer ended.
template <class Client>
struct Observed {
  Client& client;
  canopen::NodeId node;
  std::uint32_t entry;           ///< index and sub-index in the format of the frame
  bool heard = false;            ///< the device has answered
  bool ended_by_device = false;  ///< an abort of the device ended the transfer
  bool size_told = true;
  unsigned boot_ups = 0;
  std::optional<ForeignAbort> foreign_abort{};  ///< an abort that the client has ignored

  [[nodiscard]] bool busy() const { return client.busy(); }
  [[nodiscard]] std::optional<canopen::TimePoint> next_deadline() const { return client.next_deadline(); }
  void on_time(canopen::TimePoint now) { client.on_time(now); }
  void on_frame(const Frame& frame, canopen::TimePoint now) {
    const bool of_server = !frame.extended && frame.id == canopen::default_sdo(node).response.can_id();
    const bool was_busy = client.busy();
    client.on_frame(frame, now);
    if (is_boot_up_of(frame, node)) ++boot_ups;
    if (!of_server) return;
    heard = true;
    const bool ended = was_busy && !client.busy();
    if (ended && is_upload_without_size(frame)) size_told = false;
    if (frame.size != 8 || frame.remote || frame.data[0] != canopen::sdo::abort_command) return;
    if (ended) {
      ended_by_device = true;
    } else if (canopen::sdo::multiplexer_of(frame.data) != entry) {
      foreign_abort = ForeignAbort{canopen::sdo::index_of(frame.data), frame.data[3],
                                   canopen::abort_code_from(canopen::sdo::word_of(frame.data))};
    }
  }
};

/// Abort codes of the protocol itself: another kind of transfer may succeed.
constexpr AbortCode protocol_codes[] = {AbortCode::toggle_bit, AbortCode::timeout,         AbortCode::command_specifier,
                                        AbortCode::block_size, AbortCode::sequence_number, AbortCode::crc};

}  // namespace

std::string abort_text(AbortCode code) {
  std::string text;
  append_abort(text, canopen::code_in_frame(code), ", ");
  return text;
}

std::string failure_text(const SdoOutcome& outcome) {
  switch (outcome.end) {
    case SdoEnd::done: return "done";
    case SdoEnd::refused: return "refused by the device: " + abort_text(outcome.code);
    case SdoEnd::no_answer:
      if (!outcome.foreign_abort) return fmt::format("no answer within {} ms", outcome.waited_ms);
      return fmt::format("no answer within {} ms, but an abort of {}: {}", outcome.waited_ms,
                         entry_label(outcome.foreign_abort->index, outcome.foreign_abort->sub_index),
                         abort_text(outcome.foreign_abort->code));
    case SdoEnd::broken:
      if (outcome.max_bytes != 0) return fmt::format("the value is longer than {} bytes", outcome.max_bytes);
      return "the transfer failed: " + abort_text(outcome.code);
  }
  return {};
}

SdoAccess::SdoAccess(LiveBus& bus, canopen::NodeId node, SdoSettings settings)
    : bus_{bus}, node_{node}, settings_{settings}, client_{bus, node, options_of(settings, false)} {}

/// Passes received frames to the client, and those received within this time.
void SdoAccess::take_frames(Duration span) {
  constexpr unsigned at_most = 10'000;  // a bus may deliver frames endlessly
  const canopen::TimePoint end = bus_.now() + span;
  for (unsigned i = 0; i != at_most; ++i) {
    const canopen::TimePoint present = bus_.now();
    const auto frame = bus_.receive(present < end ? end - present : Duration{0});
    if (frame) client_.on_frame(*frame, bus_.now());
    if (frame && is_boot_up_of(*frame, node_)) ++boot_ups_;
    if (Interruption::noted()) throw Interrupted{};
    if (!frame && bus_.now() >= end) return;
  }
}

SdoOutcome SdoAccess::finish(std::uint32_t entry, bool block) {
  Observed<Client> observed{client_, node_, entry};
  bool interrupted = false;
  run(bus_, observed, [&] {
    interrupted = true;
    client_.cancel(AbortCode::general, bus_.now());
    return true;
  });
  boot_ups_ += observed.boot_ups;
  if (interrupted) throw Interrupted{};
  SdoOutcome outcome;
  outcome.code = client_.result();
  outcome.waited_ms = settings_.timeout_ms;
  outcome.size_told = observed.size_told;
  if (outcome.code == canopen::ok) return outcome;
  outcome.foreign_abort = observed.foreign_abort;
  if (observed.ended_by_device) {
    outcome.end = SdoEnd::refused;
  } else {
    outcome.end = outcome.code == AbortCode::timeout ? SdoEnd::no_answer : SdoEnd::broken;
  }
  if (outcome.end == SdoEnd::no_answer && !observed.heard && block) no_block_ = true;
  return outcome;
}

/// If a device does not answer a block transfer, or if the block transfer fails, retries with a segmented transfer,
/// after the remaining frames of the failed one.
template <class Begin>
SdoOutcome SdoAccess::transfer(SdoTransfer how, std::uint32_t entry, Begin begin) {
  std::string failure;
  take_frames(Duration{0});  // frames received before are not responses to the request
  if (how == SdoTransfer::block && !no_block_) {
    client_.set_options(options_of(settings_, true));
    begin();
    SdoOutcome outcome = finish(entry, true);
    const bool broke =
        outcome.end == SdoEnd::no_answer || std::ranges::find(protocol_codes, outcome.code) != std::end(protocol_codes);
    if (outcome.done() || (!no_block_ && !broke)) return outcome;
    if (!no_block_) {
      failure = failure_text(outcome);
      take_frames(after_a_break);
    }
  }
  client_.set_options(options_of(settings_, false));
  begin();
  SdoOutcome outcome = finish(entry, false);
  outcome.block_failure = std::move(failure);
  return outcome;
}

AbortCode UploadBuffer::append(std::span<const std::uint8_t> piece) {
  if (piece.size() > limit_ - bytes_.size()) return AbortCode::out_of_memory;
  bytes_.insert(bytes_.end(), piece.begin(), piece.end());
  return canopen::ok;
}

SdoOutcome SdoAccess::upload(std::uint16_t index, std::uint8_t sub_index, SdoTransfer how, const SdoProgress& progress,
                             std::optional<std::size_t> type_size) {
  UploadBuffer bytes{type_size ? *type_size + type_margin : settings_.max_bytes};
  bool too_long = false;
  auto take = [&](std::uint32_t /*offset*/, std::span<const std::uint8_t> piece, bool /*last*/) {
    const AbortCode result = bytes.append(piece);
    too_long = result != canopen::ok;
    if (too_long && type_size) return AbortCode::length_too_high;
    if (!too_long && progress) progress(bytes.size(), 0);
    return result;
  };
  SdoOutcome outcome = transfer(how, canopen::sdo::multiplexer(index, sub_index), [&] {
    bytes.clear();
    (void)client_.upload(index, sub_index, canopen::sink_of(take), bus_.now());
  });
  if (too_long) outcome.max_bytes = bytes.limit();
  if (outcome.done()) outcome.bytes = bytes.take();
  return outcome;
}

SdoOutcome SdoAccess::download(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value,
                               SdoTransfer how, const SdoProgress& progress) {
  const std::uint32_t entry = canopen::sdo::multiplexer(index, sub_index);
  if (!progress || value.size() <= 4) {
    return transfer(how, entry, [&] { (void)client_.download(index, sub_index, value, bus_.now()); });
  }
  auto give = [&](std::uint32_t offset, std::span<std::uint8_t> room) -> canopen::Result<std::uint32_t> {
    const auto size = std::min(room.size(), value.size() - offset);
    if (size != 0) std::memcpy(room.data(), &value[offset], size);
    progress(offset + size, value.size());
    return static_cast<std::uint32_t>(size);
  };
  return transfer(how, entry, [&] {
    (void)client_.download(index, sub_index, canopen::source_of(give, static_cast<std::uint32_t>(value.size())),
                           bus_.now());
  });
}

}  // namespace edsc
