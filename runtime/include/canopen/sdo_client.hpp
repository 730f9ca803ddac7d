/// SDO client: expedited and segmented upload and download (CiA 301, 7.2.4.3), one transfer at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>

#include "canopen/abort_code.hpp"
#include "canopen/cob_id.hpp"
#include "canopen/frame.hpp"
#include "canopen/handlers.hpp"
#include "canopen/node_id.hpp"
#include "canopen/object.hpp"
#include "canopen/sdo_protocol.hpp"
#include "canopen/time.hpp"

namespace canopen {

/// Reads and writes the dictionary of one remote node through its default SDO server. Begin a transfer, hand in frames
/// and time until it is no longer `busy()`, then look at `result()` and, after an upload, at `data()`.
///
/// An upload fills, and a download reads, memory of the caller's that must stay until the transfer is over.
template <Bus B>
class SdoClient {
 public:
  /// A server that is silent for `timeout` ends the transfer with 0504 0000h, which the server is told.
  constexpr SdoClient(B& can_bus, NodeId server, Duration timeout)
      : bus_{can_bus}, timeout_{timeout}, server_{server} {}

  /// Begins to read an entry into `memory`. 0504 0005h: the value is longer than that. False while busy.
  bool upload(std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> memory, TimePoint now) {
    if (busy()) return false;
    memory_ = memory;
    begin(index, sub_index, State::initiating_upload);
    request(0x40, now);
    sdo::put_multiplexer(request_, index, sub_index);
    (void)flush();
    return true;
  }

  /// Begins to write an entry. False while busy.
  bool download(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> bytes, TimePoint now) {
    if (busy()) return false;
    bytes_ = bytes;
    begin(index, sub_index, State::initiating_download);
    const auto size = static_cast<std::uint32_t>(bytes.size());
    if (size >= 1 && size <= 4) {
      request(static_cast<std::uint8_t>(0x23 | ((4 - size) << 2)), now);
      std::memcpy(&request_[4], bytes.data(), size);
      position_ = size;
    } else {
      request(0x21, now);
      sdo::put_word(request_, size);
    }
    sdo::put_multiplexer(request_, index, sub_index);
    (void)flush();
    return true;
  }

  /// Begins to read an object of a generated dictionary; `value()` gives it. Strings and DOMAINs need `upload`.
  template <DictionaryObject O>
  requires(O::bits > 0) bool read(TimePoint now) { return upload(O::index, O::sub_index, number_, now); }

  /// The value that `read<O>` brought; the abort code of the transfer, or 0607 0010h when its length is another one.
  template <DictionaryObject O>
  requires(O::bits > 0) [[nodiscard]] std::optional<typename O::type> value() {
    if (busy() || result_ != ok) return std::nullopt;
    if (position_ < (O::bits + 7u) / 8u) {
      result_ = AbortCode::length_mismatch;
      return std::nullopt;
    }
    return handler_detail::value_from<O>(std::span{number_}.first(position_));
  }

  /// Begins to write an object of a generated dictionary.
  template <DictionaryObject O>
  requires(O::bits > 0) bool write(const typename O::type& value, TimePoint now) {
    const std::uint64_t raw = pdo_detail::to_bits(value);
    std::memcpy(number_.data(), &raw, sizeof raw);
    return download(O::index, O::sub_index, std::span{number_}.first((O::bits + 7u) / 8u), now);
  }

  /// Takes an answer of the server; other frames are ignored.
  void on_frame(const Frame& frame, TimePoint now) {
    if (!busy() || frame.remote || frame.size != 8) return;
    if (cob_id_of(frame) != function_code::sdo_response + std::uint32_t{server_.value()}) return;
    handle(frame.data, now);
    (void)flush();
  }

  /// Sends what found no room, and ends a transfer whose server is silent.
  void on_time(TimePoint now) {
    (void)flush();
    if (busy() && now >= deadline_) {
      abort(AbortCode::timeout);
      (void)flush();
    }
  }

  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    return busy() ? std::optional{deadline_} : std::nullopt;
  }

  /// Whether a transfer runs.
  [[nodiscard]] bool busy() const { return state_ != State::idle; }

  /// How the last transfer ended: `ok`, or the abort code of either side.
  [[nodiscard]] AbortCode result() const { return result_; }

  /// What an upload that ended well has brought.
  [[nodiscard]] std::span<const std::uint8_t> data() const { return memory_.first(position_); }

 private:
  enum class State : std::uint8_t { idle, initiating_upload, uploading, initiating_download, downloading };

  void begin(std::uint16_t index, std::uint8_t sub_index, State state) {
    index_ = index;
    sub_index_ = sub_index;
    state_ = state;
    position_ = 0;
    announced_.reset();
    toggle_ = 0;
    result_ = ok;
  }

  void handle(const sdo::Data& answer, TimePoint now) {
    const sdo::ServerCommand command = sdo::server_command(answer[0]);
    if (command == sdo::ServerCommand::abort) {
      if (names_entry(answer)) finish(static_cast<AbortCode>(sdo::word_of(answer)));
      return;
    }
    switch (state_) {
      case State::initiating_upload:
        if (command != sdo::ServerCommand::initiate_upload) return abort(AbortCode::command_specifier);
        if (names_entry(answer)) upload_initiated(answer, now);
        return;
      case State::uploading:
        if (command != sdo::ServerCommand::upload_segment) return abort(AbortCode::command_specifier);
        return segment_uploaded(answer, now);
      case State::initiating_download:
        if (command != sdo::ServerCommand::initiate_download) return abort(AbortCode::command_specifier);
        if (!names_entry(answer)) return;
        if (position_ == bytes_.size() && position_ != 0) return finish(ok);
        state_ = State::downloading;
        return send_segment(now);
      case State::downloading:
        if (command != sdo::ServerCommand::download_segment) return abort(AbortCode::command_specifier);
        if ((answer[0] & sdo::toggle) != toggle_) return abort(AbortCode::toggle_bit);
        if (last_sent_) return finish(ok);
        toggle_ ^= sdo::toggle;
        return send_segment(now);
      case State::idle: return;
    }
  }

  [[nodiscard]] bool names_entry(const sdo::Data& answer) const {
    return sdo::index_of(answer) == index_ && answer[3] == sub_index_;
  }

  void upload_initiated(const sdo::Data& answer, TimePoint now) {
    const bool size_indicated = (answer[0] & sdo::size_indicated) != 0;
    if ((answer[0] & sdo::expedited) != 0) {
      std::uint32_t size = size_indicated ? 4u - ((answer[0] >> 2) & 3u) : 4u;
      if (!size_indicated) size = std::min<std::uint32_t>(size, static_cast<std::uint32_t>(memory_.size()));
      if (take(&answer[4], size)) finish(ok);
      return;
    }
    if (size_indicated) {
      announced_ = sdo::word_of(answer);
      if (*announced_ > memory_.size()) return abort(AbortCode::out_of_memory);
    }
    state_ = State::uploading;
    request(0x60, now);
  }

  void segment_uploaded(const sdo::Data& answer, TimePoint now) {
    if ((answer[0] & sdo::toggle) != toggle_) return abort(AbortCode::toggle_bit);
    if (!take(&answer[1], sdo::segment_bytes - ((answer[0] >> 1) & 7u))) return;
    if ((answer[0] & sdo::last_segment) != 0) {
      if (announced_ && *announced_ != position_) return abort(AbortCode::length_mismatch);
      return finish(ok);
    }
    toggle_ ^= sdo::toggle;
    request(static_cast<std::uint8_t>(0x60 | toggle_), now);
  }

  [[nodiscard]] bool take(const std::uint8_t* from, std::uint32_t size) {
    if (size > memory_.size() - position_) {
      abort(AbortCode::out_of_memory);
      return false;
    }
    if (size != 0) std::memcpy(&memory_[position_], from, size);
    position_ += size;
    return true;
  }

  void send_segment(TimePoint now) {
    const auto size = static_cast<std::uint32_t>(std::min<std::size_t>(bytes_.size() - position_, sdo::segment_bytes));
    last_sent_ = position_ + size == bytes_.size();
    request(static_cast<std::uint8_t>(toggle_ | ((sdo::segment_bytes - size) << 1) | (last_sent_ ? 1 : 0)), now);
    if (size != 0) std::memcpy(&request_[1], &bytes_[position_], size);
    position_ += size;
  }

  void abort(AbortCode code) {
    finish(code);
    request_ = {};
    request_[0] = sdo::abort_command;
    sdo::put_multiplexer(request_, index_, sub_index_);
    sdo::put_word(request_, static_cast<std::uint32_t>(code));
    has_request_ = true;
  }

  void finish(AbortCode code) {
    result_ = code;
    state_ = State::idle;
  }

  void request(std::uint8_t command, TimePoint now) {
    request_ = {};
    request_[0] = command;
    has_request_ = true;
    deadline_ = now + timeout_;
  }

  bool flush() {
    if (!has_request_) return true;
    Frame frame{};
    frame.id = function_code::sdo_request + std::uint32_t{server_.value()};
    frame.size = 8;
    frame.data = request_;
    has_request_ = !bus_.send(frame);
    return !has_request_;
  }

  B& bus_;
  Duration timeout_;
  std::span<std::uint8_t> memory_{};       ///< upload: where to
  std::span<const std::uint8_t> bytes_{};  ///< download: where from
  alignas(8) std::array<std::uint8_t, 8> number_{};
  sdo::Data request_{};
  std::optional<std::uint32_t> announced_{};
  std::uint32_t position_ = 0;
  TimePoint deadline_{};
  AbortCode result_ = ok;
  std::uint16_t index_ = 0;
  std::uint8_t sub_index_ = 0;
  NodeId server_;
  State state_ = State::idle;
  std::uint8_t toggle_ = 0;
  bool last_sent_ = false;
  bool has_request_ = false;
};

}  // namespace canopen
