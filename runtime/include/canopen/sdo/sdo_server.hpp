/// SDO server: requests, expedited and segmented transfers, and the timeout of the client (CiA 301, 7.2.4.3).
#pragma once

#include <cstdint>
#include <optional>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/od/device_options.hpp"
#include "canopen/od/sheet.hpp"
#include "canopen/sdo/sdo_protocol.hpp"
#include "canopen/sdo/sdo_server_blocks.hpp"
#include "canopen/sdo/sdo_server_hooks.hpp"
#include "canopen/sdo/sdo_server_transfer.hpp"

namespace canopen {

/// One SDO server of a node; it contains the whole state of a transfer. It accepts requests of eight bytes and holds at
/// most one response of eight bytes until it has been sent. During a block upload the next segment is ready as soon as
/// the one before has been sent: a node sends responses until none is left or its bus is full.
///
/// Numbers and strings are sampled at the start of the upload. DOMAINs are uploaded in place: changes by the
/// application during the transfer are sent. A download is written when it is complete; only a DOMAIN is filled as
/// bytes arrive, and is empty until its last byte has arrived.
///
/// Block transfer is compiled in with `Device::options.sdo_block_transfer`; otherwise its initiate is aborted with 0504
/// 0001h. A new initiate ends the previous transfer, except during the segments of a block download, from which it
/// cannot be distinguished.
template <class Device>
class SdoServer : private SdoServerTransfer<Device> {  // its bytes are first: they have small offsets
  using Transfer = SdoServerTransfer<Device>;

 public:
  /// Accepts a request. A response that has not been sent yet is replaced.
  void on_request(const sdo::Data& request, SdoServerHooks<Device> auto hooks, TimePoint now) {
    if constexpr (has_timeout) last_activity_ = now;
    if constexpr (has_sheet<Device>)
      timeout_.length = from_milliseconds(sdo_timeout_of(options_of<Device>(hooks.entries())));
    if (const AbortCode code = handle(request, hooks); code != ok) Transfer::abort(code, hooks);
  }

  /// Aborts a transfer whose client has not sent anything for too long (0504 0000h). A sub-block that stops for half of
  /// that time is confirmed as far as it has been received, so that the client repeats the rest.
  void on_time([[maybe_unused]] TimePoint now) {
    if constexpr (has_timeout) {
      if (Transfer::state() == State::idle || !timeout_.runs() || now < last_activity_ + current_timeout()) return;
      if constexpr (has_block) {
        if (Blocks::sub_block_begun(*this)) return Blocks::confirm_sub_block(*this);
      }
      Transfer::abort(AbortCode::timeout);
    }
  }

  /// Returns when the timeout of the client elapses.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    if constexpr (has_timeout) {
      if (Transfer::state() != State::idle && timeout_.runs()) return last_activity_ + current_timeout();
    }
    return std::nullopt;
  }

  using Transfer::has_reply, Transfer::reply;

  /// Reports that the response has been passed to the controller: the next segment of a block upload replaces it.
  void reply_sent(SdoServerHooks<Device> auto hooks, [[maybe_unused]] TimePoint now) {
    if constexpr (has_timeout) last_activity_ = now;
    Transfer::drop_reply();
    if constexpr (has_block) {
      if (!Blocks::has_segment(*this)) return;
      if (const AbortCode code = Blocks::next_segment(*this, hooks); code != ok) Transfer::abort(code, hooks);
    }
  }

  /// The request has started a command that takes longer: its response waits for `command_ended`.
  using Transfer::hold_reply;
  /// The client does not wait for the response any more.
  void discard_held_reply() {
    if (Transfer::holds_reply()) Transfer::drop_reply();
  }
  /// The command has ended: a response that is held is sent, as an abort if the code is not `ok`.
  void command_ended(AbortCode code) {
    if (!Transfer::holds_reply()) return;
    code == ok ? Transfer::release_reply() : Transfer::abort(code);
  }

  /// Whether segments of a block download are expected, whose first byte is not a command.
  [[nodiscard]] bool takes_segments() const { return has_block && Transfer::state() == State::block_downloading; }

  /// Discards the transfer and the response.
  void reset() {
    Transfer::enter(State::idle);
    Transfer::drop_reply();
  }

  /// Aborts a transfer of a DOMAIN that has been bound to other memory, or that another server writes now.
  void domain_rebound(std::uint16_t index, std::uint8_t sub_index) {
    if (Transfer::transfers(index, sub_index)) Transfer::abort(AbortCode::not_stored);
  }

 private:
  using State = typename Transfer::State;
  using Blocks = SdoServerBlocks<Device>;

  /// The timeout of the type, and of a device with a sheet.
  struct OfType {
    static constexpr Duration length = from_milliseconds(sdo_timeout_of(Device::options));
    [[nodiscard]] static constexpr bool runs() { return true; }
  };
  struct OfSheet {
    Duration length{};
    [[nodiscard]] bool runs() const { return length.count() != 0; }
  };
  static constexpr bool has_timeout = has_sheet<Device> || OfType::length.count() != 0;
  static constexpr bool has_block = Device::options.sdo_block_transfer;

  [[nodiscard]] AbortCode handle(const sdo::Data& request, auto hooks) {
    const bool blocks = has_block && options_of<Device>(hooks.entries()).sdo_block_transfer;
    if constexpr (has_block) {
      if (takes_segments() && request[0] != sdo::abort_command) return Blocks::take_segment(request, *this, hooks);
    }
    const sdo::ClientCommand command = sdo::client_command(request[0]);
    if (command == sdo::ClientCommand::upload_segment) return upload_segment(request[0], hooks);
    if (command == sdo::ClientCommand::download_segment) return download_segment(request, hooks);
    if (command == sdo::ClientCommand::abort) {
      Transfer::enter(State::idle);
      return ok;
    }
    if constexpr (has_block) {
      if (blocks && command == sdo::ClientCommand::block_upload &&
          static_cast<sdo::BlockUpload>(request[0] & 3) != sdo::BlockUpload::initiate)
        return Blocks::upload(request, *this, hooks);
      if (blocks && command == sdo::ClientCommand::block_download && (request[0] & 1) != 0)
        return Blocks::end_download(request, *this, hooks);
    }
    // An unknown command does not start a transfer: its abort contains the multiplexer of the transfer that it ends.
    if (command == sdo::ClientCommand::reserved && Transfer::state() != State::idle)
      return AbortCode::command_specifier;
    Transfer::begin(request);
    if (command == sdo::ClientCommand::initiate_upload) return initiate_upload(hooks);
    if (command == sdo::ClientCommand::initiate_download) return initiate_download(request, hooks);
    if constexpr (has_block) {
      if (blocks && command == sdo::ClientCommand::block_upload) return Blocks::initiate_upload(request, *this, hooks);
      if (blocks && command == sdo::ClientCommand::block_download)
        return Blocks::initiate_download(request, *this, hooks);
    }
    return AbortCode::command_specifier;
  }

  // Expedited and segmented upload

  [[nodiscard]] AbortCode initiate_upload(auto hooks) {
    if (const AbortCode code = Transfer::find_readable(hooks); code != ok) return code;
    if (Transfer::is_short_number()) {
      Transfer::answer_number(hooks);
      return ok;
    }
    if (const AbortCode code = Transfer::open_upload(hooks); code != ok) return code;
    Transfer::answer_upload(hooks);
    return ok;
  }

  [[nodiscard]] AbortCode upload_segment(std::uint8_t command, auto hooks) {
    if (Transfer::state() != State::uploading) return Transfer::reject_command();
    if ((command & sdo::toggle) != Transfer::toggle()) return AbortCode::toggle_bit;
    Transfer::clear_reply(Transfer::toggle());
    std::uint32_t size = 0;
    bool last = false;
    if (const AbortCode code = Transfer::fetch(hooks, size, last); code != ok) return code;
    std::uint8_t& answer = Transfer::reply()[0];
    answer = static_cast<std::uint8_t>(answer | ((sdo::segment_bytes - size) << 1));
    Transfer::alternate_toggle();
    if (last) {
      answer |= sdo::last_segment;
      Transfer::enter(State::idle);
    }
    return ok;
  }

  // Expedited and segmented download

  [[nodiscard]] AbortCode initiate_download(const sdo::Data& request, auto hooks) {
    if (const AbortCode code = Transfer::find(entry::writable, AbortCode::read_only, hooks); code != ok) return code;
    const bool indicated = (request[0] & sdo::size_indicated) != 0;
    if ((request[0] & sdo::expedited) != 0) {
      const std::uint32_t size = indicated ? 4u - ((request[0] >> 2) & 3u) : Transfer::size_without_indication();
      if (const AbortCode code = Transfer::take_expedited(&request[4], size, hooks); code != ok) return code;
    } else {
      const AbortCode code = Transfer::open_download(indicated, sdo::word_of(request), hooks);
      if (code != ok) return code;
      Transfer::enter(State::downloading);
    }
    Transfer::answer(0x60);
    return ok;
  }

  [[nodiscard]] AbortCode download_segment(const sdo::Data& request, auto hooks) {
    if (Transfer::state() != State::downloading) return Transfer::reject_command();
    if ((request[0] & sdo::toggle) != Transfer::toggle()) return AbortCode::toggle_bit;
    const bool last = (request[0] & sdo::last_segment) != 0;
    const std::uint32_t size = sdo::segment_bytes - ((request[0] >> 1) & 7u);
    if (const AbortCode code = Transfer::store(hooks, &request[1], size, last); code != ok) return code;
    if (last) {
      if (const AbortCode code = Transfer::finish(hooks); code != ok) return code;
    }
    Transfer::clear_reply(static_cast<std::uint8_t>(0x20 | Transfer::toggle()));
    Transfer::alternate_toggle();
    return ok;
  }

  [[nodiscard]] Duration current_timeout() const {
    if constexpr (has_block) {
      if (Blocks::sub_block_begun(*this)) return timeout_.length / 2;
    }
    return timeout_.length;
  }

  struct NoTime {};

  [[no_unique_address]] std::conditional_t<has_timeout, TimePoint, NoTime> last_activity_{};
  [[no_unique_address]] std::conditional_t<has_sheet<Device>, OfSheet, OfType> timeout_{};
};

}  // namespace canopen
