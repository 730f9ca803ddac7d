/// SDO client: transfers through one channel, with the time limits of their responses (CiA 301, 7.2.4.3).
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/typed_value.hpp"
#include "canopen/od/value_bits.hpp"
#include "canopen/od/value_for.hpp"
#include "canopen/sdo/sdo_client_transfer.hpp"
#include "canopen/sdo/sdo_client_value.hpp"
#include "canopen/sdo/sdo_late_response.hpp"
#include "canopen/sdo/sdo_protocol.hpp"
#include "canopen/sdo/sdo_transfer.hpp"

namespace canopen {

/// Reads and writes the object dictionary of one remote node through one of its SDO servers. Start a transfer, pass in
/// frames and time until the client is no longer `busy()`, then check `result()` and, after an upload, `data()`.
///
/// An upload fills, and a download reads, memory of the caller that must exist until the transfer has ended. An upload
/// ends with 0607 0012h if the server sends more bytes than it has announced, and with 0607 0013h at a segment without
/// bytes that is not the last one. If the server does not announce a size, the memory or the sink limits it.
///
/// An SDO has one client: two of them would receive each other's responses. Use one client per node and keep it,
/// because it knows which responses may still arrive. SDO does not number its transfers; only the index and sub-index
/// of initiate responses and aborts (the multiplexer) identify the request. Responses for another entry are ignored, as
/// are segments before the client's own transfer has started. After a transfer that ended without its response, by a
/// timeout or `cancel`:
///   - another entry is requested at once: responses of one server arrive in the order of the requests;
///   - the same entry is requested after the late response has arrived, or after another timeout;
///   - after the segments of a block upload, which may have any content, nothing is requested for another timeout.
template <Bus BusType>
class SdoClient {
 public:
  constexpr SdoClient(BusType& can_bus, SdoChannel channel, SdoClientOptions options = {})
      : bus_{can_bus}, channel_{channel}, transfer_{options} {}
  constexpr SdoClient(BusType& can_bus, NodeId server, SdoClientOptions options = {})
      : SdoClient{can_bus, default_sdo(server), options} {}
  constexpr SdoClient(BusType& can_bus, NodeId server, Duration timeout)
      : SdoClient{can_bus, server, SdoClientOptions{.timeout = timeout}} {}

  /// Starts to read an entry into `memory`. 0504 0005h: the value is longer than that. Returns false while busy.
  bool upload(std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> memory, TimePoint now) {
    if (!prepare(now)) return false;
    transfer_.upload(index, sub_index, memory);
    release();
    return true;
  }

  /// Starts to read an entry piece by piece. Returns false while busy.
  bool upload(std::uint16_t index, std::uint8_t sub_index, SdoSink sink, TimePoint now) {
    if (!prepare(now)) return false;
    transfer_.upload(index, sub_index, sink);
    release();
    return true;
  }

  /// Starts to write an entry. Returns false while busy.
  bool download(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> bytes, TimePoint now) {
    if (!prepare(now)) return false;
    transfer_.download(index, sub_index, bytes);
    release();
    return true;
  }

  /// Starts to write an entry piece by piece. Returns false while busy.
  bool download(std::uint16_t index, std::uint8_t sub_index, SdoSource source, TimePoint now) {
    if (!prepare(now)) return false;
    transfer_.download(index, sub_index, source);
    release();
    return true;
  }

  /// Starts to read an object of a generated dictionary; `value()` returns it. Strings and DOMAINs need `upload`.
  template <DictionaryObject Object>
  requires(Object::bits > 0) bool read(TimePoint now) { return upload(Object::index, Object::sub_index, number_, now); }

  /// Returns the value that `read<Object>` has read; empty if the transfer has failed or, with `result()` 0607 0010h,
  /// if its length is wrong.
  template <DictionaryObject Object>
  requires(Object::bits > 0) [[nodiscard]] std::optional<typename Object::type> value() {
    if (busy() || result() != ok) return std::nullopt;
    constexpr std::uint32_t size = (Object::bits + 7u) / 8u;
    const SdoClientValue& read = transfer_.value();
    if (read.position() != size && (read.size_known() || read.position() < size)) {
      transfer_.finish(AbortCode::length_mismatch);
      return std::nullopt;
    }
    return value_detail::value_from<Object>(std::span{number_}.first(size));
  }

  /// Starts to write an object of a generated dictionary.
  template <DictionaryObject Object>
  requires(Object::bits > 0 && !Meaningful<typename Object::type>) bool write(const typename Object::type& value,
                                                                              TimePoint now) {
    if (busy()) return false;
    const std::uint64_t raw = value_detail::to_bits(value);
    std::memcpy(number_.data(), &raw, sizeof raw);
    return download(Object::index, Object::sub_index, std::span{number_}.first((Object::bits + 7u) / 8u), now);
  }
  /// The same with a meaning: a value, a constant with a unit, or a raw number.
  template <NumberObject Object>
  requires Meaningful<typename Object::type>
  bool write(std::type_identity_t<ValueOf<Object>> value, TimePoint now) {
    return write<NumbersOf<Object>>(to_raw(value.value()), now);
  }

  /// Ends the transfer with an abort code, which is sent to the server unless the first request has not been sent yet.
  void cancel(AbortCode code, TimePoint now) {
    now_ = now;
    if (!transfer_.idle()) give_up(code);
    flush();
  }

  /// Reports that the boot-up message of the server has arrived. Ends the transfer with 0800 0022h. Responses to
  /// requests from before the reset do not arrive after the boot-up message, so the same entry can be requested
  /// again at once.
  void server_reset(TimePoint now) {
    cancel(AbortCode::device_state, now);
    late_.server_reset();
  }

  /// Sets the options of the next transfers; not while busy.
  void set_options(const SdoClientOptions& options) { transfer_.set_options(options); }

  /// Accepts a response of the server; other frames are ignored.
  void on_frame(const Frame& frame, TimePoint now) {
    now_ = now;
    if (frame.remote || frame.size != 8) return;
    if (frame.extended != channel_.response.extended() || frame.id != channel_.response.can_id()) return;
    const bool waits = held();
    const bool late = late_.take(frame.data, transfer_.entry(), transfer_.is_initiating());
    if (waits) {
      if (!held()) release();
    } else if (!late && !transfer_.idle()) {
      if (transfer_.on_response(frame.data)) wait_for_response();
      flush();
    }
  }

  /// Sends what could not be sent yet, and ends a transfer whose server does not respond; an abort that cannot be sent
  /// within the timeout is dropped. Call it at `next_deadline()`, and when the bus has room again.
  void on_time(TimePoint now) {
    now_ = now;
    const bool waits = held();
    if (waits || transfer_.idle()) late_.expire(now, timeout());
    if (waits && !held()) return release();
    flush();
    if (held() || now < deadline_) return;
    if (transfer_.idle()) return transfer_.drop_request();  // an abort that could not be sent within the timeout
    if (transfer_.sub_block_begun()) {
      transfer_.confirm_sub_block();
      wait_for_response();
    } else {
      give_up(AbortCode::timeout);
    }
    flush();
  }

  /// Returns when `on_time` is next due; while a frame waits for room on the bus, the time of the last call.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    if (held()) return late_.end();
    if (transfer_.has_request()) return now_;
    return transfer_.idle() ? std::nullopt : std::optional{deadline_};
  }

  /// Whether a transfer is running, or its abort waits for room on the bus.
  [[nodiscard]] bool busy() const { return !transfer_.idle() || transfer_.has_request(); }

  /// Whether the client is not busy and no response of an earlier transfer is expected: another client may use the SDO.
  [[nodiscard]] bool settled(TimePoint now) const {
    return !busy() && (!late_.expected() || !late_.due(now, timeout()));
  }

  /// Returns when the late response of an earlier transfer counts as lost.
  [[nodiscard]] std::optional<TimePoint> settled_at() const {
    return late_.expected() ? std::optional{late_.end()} : std::nullopt;
  }

  /// Returns how the last transfer ended: `ok`, or the abort code of either side.
  [[nodiscard]] AbortCode result() const { return transfer_.result(); }

  /// Whether the server has indicated the size of the value that it has sent; an expedited response need not do so.
  [[nodiscard]] bool size_known() const { return transfer_.value().size_known(); }

  /// Returns the bytes that a successful upload has read into memory; empty after a download.
  [[nodiscard]] std::span<const std::uint8_t> data() const { return transfer_.value().uploaded(); }

 private:
  [[nodiscard]] Duration timeout() const { return transfer_.options().timeout; }

  /// Prepares for a new transfer; false: one is running.
  [[nodiscard]] bool prepare(TimePoint now) {
    if (busy()) return false;
    now_ = now;
    late_.expire(now, timeout());
    return true;
  }

  /// Whether the first request waits because a late response could be mistaken for its response.
  [[nodiscard]] bool held() const {
    return transfer_.has_request() && transfer_.is_initiating() && late_.blocks(transfer_.entry());
  }

  /// Sends the first request, unless it has to wait.
  void release() {
    wait_for_response();
    flush();
  }

  void wait_for_response() { deadline_ = now_ + timeout(); }

  /// Ends a transfer whose last request has no response. If the server does not know of it, nothing is sent.
  void give_up(AbortCode code) {
    if (transfer_.is_initiating() && transfer_.has_request()) return transfer_.finish(code);
    if (transfer_.is_initiating()) {
      late_.expect_initiate(transfer_.entry());
    } else if (transfer_.receives_segments()) {
      late_.expect_segments();
    } else {
      late_.expect_abort(transfer_.entry());
    }
    late_.set_end(now_ + timeout());
    transfer_.abort(code);
    wait_for_response();
  }

  /// Sends the pending request, and during a block download as many segments as the bus has room for.
  void flush() {
    while (transfer_.has_request() && !held()) {
      Frame frame{};
      frame.id = channel_.request.can_id();
      frame.extended = channel_.request.extended();
      frame.size = 8;
      frame.data = transfer_.request();
      if (!bus_.send(frame)) return;
      transfer_.request_sent();
      wait_for_response();
    }
  }

  BusType& bus_;
  SdoChannel channel_;
  SdoClientTransfer transfer_;
  SdoLateResponse late_{};
  TimePoint now_{};
  TimePoint deadline_{};
  alignas(8) std::array<std::uint8_t, 8> number_{};
};

}  // namespace canopen
