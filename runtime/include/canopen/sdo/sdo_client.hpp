/// SDO client: expedited, segmented and block upload and download (CiA 301, 7.2.4.3), one transfer at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/base/crc16.hpp"
#include "canopen/base/result.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/value_bits.hpp"
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
template <Bus B>
class SdoClient {
 public:
  constexpr SdoClient(B& can_bus, SdoChannel channel, SdoClientOptions options = {})
      : bus_{can_bus}, options_{options}, channel_{channel} {}
  constexpr SdoClient(B& can_bus, NodeId server, SdoClientOptions options = {})
      : SdoClient{can_bus, default_sdo(server), options} {}
  constexpr SdoClient(B& can_bus, NodeId server, Duration timeout)
      : SdoClient{can_bus, server, SdoClientOptions{.timeout = timeout}} {}

  /// Starts to read an entry into `memory`. 0504 0005h: the value is longer than that. Returns false while busy.
  bool upload(std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> memory, TimePoint now) {
    if (busy()) return false;
    memory_ = memory;
    sink_ = {};
    begin_upload(index, sub_index, memory.size() > options_.block_threshold, now);
    return true;
  }

  /// Starts to read an entry piece by piece. Returns false while busy.
  bool upload(std::uint16_t index, std::uint8_t sub_index, SdoSink sink, TimePoint now) {
    if (busy()) return false;
    memory_ = {};
    sink_ = sink;
    begin_upload(index, sub_index, true, now);
    return true;
  }

  /// Starts to write an entry. Returns false while busy.
  bool download(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> bytes, TimePoint now) {
    if (busy()) return false;
    memory_ = {};
    bytes_ = bytes;
    source_ = {};
    begin_download(index, sub_index, static_cast<std::uint32_t>(bytes.size()), now);
    return true;
  }

  /// Starts to write an entry piece by piece. Returns false while busy.
  bool download(std::uint16_t index, std::uint8_t sub_index, SdoSource source, TimePoint now) {
    if (busy()) return false;
    memory_ = {};
    bytes_ = {};
    source_ = source;
    begin_download(index, sub_index, source.size, now);
    return true;
  }

  /// Starts to read an object of a generated dictionary; `value()` returns it. Strings and DOMAINs need `upload`.
  template <DictionaryObject O>
  requires(O::bits > 0) bool read(TimePoint now) { return upload(O::index, O::sub_index, number_, now); }

  /// Returns the value that `read<O>` has read; empty if the transfer has failed or, with `result()` 0607 0010h, if its
  /// length is wrong.
  template <DictionaryObject O>
  requires(O::bits > 0) [[nodiscard]] std::optional<typename O::type> value() {
    if (busy() || result_ != ok) return std::nullopt;
    constexpr std::uint32_t size = (O::bits + 7u) / 8u;
    if (position_ != size && (size_ != sdo::unknown_size || position_ < size)) {
      result_ = AbortCode::length_mismatch;
      return std::nullopt;
    }
    return value_detail::value_from<O>(std::span{number_}.first(size));
  }

  /// Starts to write an object of a generated dictionary.
  template <DictionaryObject O>
  requires(O::bits > 0) bool write(const typename O::type& value, TimePoint now) {
    if (busy()) return false;
    const std::uint64_t raw = value_detail::to_bits(value);
    std::memcpy(number_.data(), &raw, sizeof raw);
    return download(O::index, O::sub_index, std::span{number_}.first((O::bits + 7u) / 8u), now);
  }

  /// Ends the transfer with an abort code, which is sent to the server unless the first request has not been sent yet.
  void cancel(AbortCode code, TimePoint now) {
    now_ = now;
    if (state_ != State::idle) give_up(code);
    flush();
  }

  /// Reports that the boot-up message of the server has arrived. Ends the transfer with 0800 0022h. Responses to
  /// requests from before the reset do not arrive after the boot-up message, so the same entry can be requested
  /// again at once.
  void server_reset(TimePoint now) {
    cancel(AbortCode::device_state, now);
    if (left_over_ == LeftOver::any) left_over_ = LeftOver::none;
    was_reset_ = true;
  }

  /// Sets the options of the next transfers; not while busy.
  void set_options(const SdoClientOptions& options) { options_ = options; }

  /// Accepts a response of the server; other frames are ignored.
  void on_frame(const Frame& frame, TimePoint now) {
    now_ = now;
    if (frame.remote || frame.size != 8) return;
    if (frame.extended != channel_.response.extended() || frame.id != channel_.response.can_id()) return;
    const bool waits = held();
    const bool late = take_left_over(frame.data);
    if (waits) {
      if (!held()) release();
    } else if (!late && state_ != State::idle) {
      handle(frame.data);
      flush();
    }
  }

  /// Sends what could not be sent yet, and ends a transfer whose server does not respond; an abort that cannot be sent
  /// within the timeout is dropped. Call it at `next_deadline()`, and when the bus has room again.
  void on_time(TimePoint now) {
    now_ = now;
    const bool waits = held();
    if ((waits || state_ == State::idle) && !is_late_answer_due(now)) left_over_ = LeftOver::none;
    if (waits && !held()) return release();
    flush();
    if (held() || now < deadline_) return;
    if (state_ == State::idle) {
      has_request_ = false;  // an abort that could not be sent within the timeout
      return;
    }
    if (state_ == State::block_uploading && sequence_ != 0) {
      confirm_sub_block();  // the server repeats what was lost
    } else {
      give_up(AbortCode::timeout);
    }
    flush();
  }

  /// Returns when `on_time` is next due; while a frame waits for room on the bus, the time of the last call.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    if (held()) return late_until_;
    if (has_request_) return now_;
    return state_ == State::idle ? std::nullopt : std::optional{deadline_};
  }

  /// Whether a transfer is running, or its abort waits for room on the bus.
  [[nodiscard]] bool busy() const { return state_ != State::idle || has_request_; }

  /// Whether the client is not busy and no response of an earlier transfer is expected: another client may use the SDO.
  [[nodiscard]] bool settled(TimePoint now) const {
    return !busy() && (left_over_ == LeftOver::none || !is_late_answer_due(now));
  }

  /// Returns when the late response of an earlier transfer counts as lost.
  [[nodiscard]] std::optional<TimePoint> settled_at() const {
    return left_over_ == LeftOver::none ? std::nullopt : std::optional{late_until_};
  }

  /// Returns how the last transfer ended: `ok`, or the abort code of either side.
  [[nodiscard]] AbortCode result() const { return result_; }

  /// Whether the server has indicated the size of the value that it has sent; an expedited response need not do so.
  [[nodiscard]] bool size_known() const { return size_ != sdo::unknown_size; }

  /// Returns the bytes that a successful upload has read into memory; empty after a download.
  [[nodiscard]] std::span<const std::uint8_t> data() const {
    return memory_.empty() ? memory_ : memory_.first(position_);
  }

 private:
  enum class State : std::uint8_t {
    idle,
    initiating_upload,
    uploading,
    initiating_download,
    downloading,
    initiating_block_upload,
    block_uploading,      ///< receives segments
    block_upload_ending,  ///< waits for the CRC
    initiating_block_download,
    block_downloading,      ///< sends a sub-block, then waits for its confirmation
    block_download_ending,  ///< waits for the final response of the server
  };

  /// The late response that an earlier transfer is still waiting for.
  enum class LeftOver : std::uint8_t {
    none,
    entry,  ///< an initiate response or abort, of `late_entry_`
    any,    ///< segments of a block upload, or several initiate responses
  };

  void begin(std::uint16_t index, std::uint8_t sub_index) {
    if (!is_late_answer_due(now_)) left_over_ = LeftOver::none;
    index_ = index;
    sub_index_ = sub_index;
    result_ = ok;
    restart();
  }

  [[nodiscard]] std::uint32_t entry() const { return sdo::multiplexer(index_, sub_index_); }

  [[nodiscard]] bool is_initiating() const {
    return state_ == State::initiating_upload || state_ == State::initiating_download ||
           state_ == State::initiating_block_upload || state_ == State::initiating_block_download;
  }

  /// Whether the first request waits because a late response could be mistaken for its response.
  [[nodiscard]] bool held() const {
    if (!has_request_ || !is_initiating() || left_over_ == LeftOver::none) return false;
    return left_over_ == LeftOver::any || (late_entry_ == entry() && !was_reset_);
  }

  /// Whether a response is the late one of an earlier transfer. The responses of a server that was reset belong to the
  /// running transfer.
  [[nodiscard]] bool take_left_over(const sdo::Data& answer) {
    if (left_over_ != LeftOver::entry || !names_some_entry(answer)) return false;
    if (sdo::multiplexer_of(answer) != late_entry_) return false;
    if (was_reset_ && is_initiating() && late_entry_ == entry()) {
      was_reset_ = false;  // the next one with this entry is the response to the other request
      return false;
    }
    left_over_ = LeftOver::none;
    return true;
  }

  [[nodiscard]] bool is_late_answer_due(TimePoint now) const { return is_within(late_until_, options_.timeout, now); }

  /// Sends the first request, which has waited long enough.
  void release() {
    deadline_ = now_ + options_.timeout;
    flush();
  }

  /// Ends a transfer whose last request has no response. If the server does not know of it, nothing is sent.
  void give_up(AbortCode code) {
    const bool started = !(is_initiating() && has_request_);
    if (!started) return finish(code);
    if (is_initiating()) {
      const bool another = left_over_ != LeftOver::none && late_entry_ != entry();
      left_over_ = another ? LeftOver::any : LeftOver::entry;
      late_entry_ = entry();
      was_reset_ = false;
    } else if (state_ == State::block_uploading) {
      left_over_ = LeftOver::any;
    } else if (left_over_ == LeftOver::none) {  // the server may still abort the transfer
      left_over_ = LeftOver::entry;
      late_entry_ = entry();
      was_reset_ = false;
    }
    late_until_ = now_ + options_.timeout;
    abort(code);
  }

  void restart() {
    position_ = 0;
    toggle_ = 0;
    crc_ = 0;
    sequence_ = 0;
    repeated_ = 0;
    unused_ = 0;
    failures_ = 0;
    last_ = false;
  }

  void begin_upload(std::uint16_t index, std::uint8_t sub_index, bool long_enough, TimePoint now) {
    now_ = now;
    begin(index, sub_index);
    size_ = sdo::unknown_size;
    if (options_.block_transfer && long_enough && !block_refused_) {
      initiate_block_upload();
    } else {
      initiate_upload();
    }
    flush();
  }

  void begin_download(std::uint16_t index, std::uint8_t sub_index, std::uint32_t size, TimePoint now) {
    now_ = now;
    begin(index, sub_index);
    size_ = size;
    if (options_.block_transfer && size > options_.block_threshold && !block_refused_) {
      initiate_block_download();
    } else {
      initiate_download();
    }
    flush();
  }

  void handle(const sdo::Data& answer) {
    if (state_ == State::block_uploading && answer[0] != sdo::abort_command) return take_block_segment(answer);
    if (names_some_entry(answer) ? !names_entry(answer) : is_initiating()) return;  // of an earlier transfer
    const sdo::ServerCommand command = sdo::server_command(answer[0]);
    if (command == sdo::ServerCommand::abort) return aborted(answer);
    switch (state_) {
      case State::initiating_upload:
        if (command != sdo::ServerCommand::initiate_upload) break;
        return upload_initiated(answer);
      case State::uploading:
        if (command != sdo::ServerCommand::upload_segment) break;
        return segment_uploaded(answer);
      case State::initiating_download:
        if (command != sdo::ServerCommand::initiate_download) break;
        return download_initiated();
      case State::downloading:
        if (command != sdo::ServerCommand::download_segment) break;
        return segment_downloaded(answer);
      case State::initiating_block_upload:
        if (command == sdo::ServerCommand::initiate_upload) return upload_initiated(answer);  // a short value
        if (command != sdo::ServerCommand::block_upload || (answer[0] & 1) != 0) break;
        return block_upload_initiated(answer);
      case State::block_upload_ending:
        if ((answer[0] & sdo::block_end_mask) != sdo::block_upload_end) break;
        return block_upload_ended(answer);
      case State::initiating_block_download:
        if (command != sdo::ServerCommand::block_download || (answer[0] & 3) != 0) break;
        return block_download_initiated(answer);
      case State::block_downloading:
        if (answer[0] != sdo::block_download_confirm) break;
        return sub_block_confirmed(answer);
      case State::block_download_ending:
        if (answer[0] != sdo::block_download_end_answer) break;
        return finish(ok);
      case State::block_uploading:
      case State::idle: return;
    }
    abort(AbortCode::command_specifier);
  }

  /// Whether a response contains an index and sub-index: initiate responses and aborts.
  [[nodiscard]] static bool names_some_entry(const sdo::Data& answer) {
    switch (sdo::server_command(answer[0])) {
      case sdo::ServerCommand::initiate_upload:
      case sdo::ServerCommand::initiate_download:
      case sdo::ServerCommand::abort: return true;
      case sdo::ServerCommand::block_upload: return (answer[0] & 1) == 0;
      case sdo::ServerCommand::block_download: return (answer[0] & 3) == 0;
      case sdo::ServerCommand::upload_segment:
      case sdo::ServerCommand::download_segment:
      case sdo::ServerCommand::reserved: return false;
    }
    return false;
  }

  [[nodiscard]] bool names_entry(const sdo::Data& answer) const { return sdo::multiplexer_of(answer) == entry(); }

  void aborted(const sdo::Data& answer) {
    const auto code = static_cast<AbortCode>(sdo::word_of(answer));
    const bool refused = code == AbortCode::command_specifier || code == AbortCode::general;
    if (refused && state_ == State::initiating_block_upload) {
      fall_back(code);
      initiate_upload();
    } else if (refused && state_ == State::initiating_block_download) {
      fall_back(code);
      initiate_download();
    } else {
      finish(code == ok ? AbortCode::general : code);
    }
  }

  /// The server does not support block transfer, in general or for this entry.
  void fall_back(AbortCode code) {
    block_refused_ = code == AbortCode::command_specifier;
    restart();
  }

  // Upload

  void initiate_upload() {
    state_ = State::initiating_upload;
    request(0x40);
    sdo::put_multiplexer(request_, index_, sub_index_);
  }

  void upload_initiated(const sdo::Data& answer) {
    const bool size_indicated = (answer[0] & sdo::size_indicated) != 0;
    if ((answer[0] & sdo::expedited) != 0) {
      std::uint32_t size = size_indicated ? 4u - ((answer[0] >> 2) & 3u) : 4u;
      if (!size_indicated && sink_.take == nullptr)
        size = std::min<std::uint32_t>(size, static_cast<std::uint32_t>(memory_.size()));
      if (size_indicated) size_ = size;
      if (take(&answer[4], size, true)) finish(ok);
      return;
    }
    if (!room_for(size_indicated, answer)) return;
    state_ = State::uploading;
    request(0x60);
  }

  /// Checks the size that the server announces.
  [[nodiscard]] bool room_for(bool size_indicated, const sdo::Data& answer) {
    if (!size_indicated) return true;
    size_ = sdo::word_of(answer);
    if (sink_.take != nullptr || size_ <= memory_.size()) return true;
    abort(AbortCode::out_of_memory);
    return false;
  }

  void segment_uploaded(const sdo::Data& answer) {
    if ((answer[0] & sdo::toggle) != toggle_) return abort(AbortCode::toggle_bit);
    const bool last = (answer[0] & sdo::last_segment) != 0;
    if (!take(&answer[1], sdo::segment_bytes - ((answer[0] >> 1) & 7u), last)) return;
    if (last) return finish(ok);
    toggle_ ^= sdo::toggle;
    request(static_cast<std::uint8_t>(0x60 | toggle_));
  }

  [[nodiscard]] bool take(const std::uint8_t* from, std::uint32_t size, bool last) {
    AbortCode code = ok;
    if (size_ != sdo::unknown_size && size > size_ - position_) {
      code = AbortCode::length_too_high;
    } else if (last && size_ != sdo::unknown_size && position_ + size != size_) {
      code = AbortCode::length_mismatch;
    } else if (size == 0 && !last) {
      code = AbortCode::length_too_low;  // a transfer of such segments would not end
    } else if (sink_.take != nullptr) {
      code = sink_.take(sink_.context, position_, {from, size}, last);
    } else if (size > memory_.size() - position_) {
      code = AbortCode::out_of_memory;
    } else if (size != 0) {
      std::memcpy(&memory_[position_], from, size);
    }
    if (code != ok) {
      abort(code);
      return false;
    }
    position_ += size;
    return true;
  }

  // Download

  void initiate_download() {
    state_ = State::initiating_download;
    if (source_.give == nullptr && size_ >= 1 && size_ <= 4) {
      request(static_cast<std::uint8_t>(0x23 | ((4 - size_) << 2)));
      std::memcpy(&request_[4], bytes_.data(), size_);
      last_ = true;
    } else if (size_ == sdo::unknown_size) {
      request(0x20);
    } else {
      request(0x21);
      sdo::put_word(request_, size_);
    }
    sdo::put_multiplexer(request_, index_, sub_index_);
  }

  void download_initiated() {
    if (last_) return finish(ok);
    state_ = State::downloading;
    send_segment();
  }

  void segment_downloaded(const sdo::Data& answer) {
    if ((answer[0] & sdo::toggle) != toggle_) return abort(AbortCode::toggle_bit);
    if (last_) return finish(ok);
    toggle_ ^= sdo::toggle;
    send_segment();
  }

  void send_segment() {
    request(toggle_);
    const std::optional<std::uint32_t> size = fetch();
    if (!size) return;
    request_[0] = static_cast<std::uint8_t>(toggle_ | ((sdo::segment_bytes - *size) << 1) | (last_ ? 1 : 0));
  }

  /// Writes the next bytes of a download after the command byte; empty if the source has ended the transfer.
  [[nodiscard]] std::optional<std::uint32_t> fetch() {
    std::uint32_t size = std::min(size_ - position_, sdo::segment_bytes);
    if (source_.give != nullptr) {
      const Result<std::uint32_t> count =
          source_.give(source_.context, position_, std::span{request_}.subspan(1, size));
      const bool sized = size_ != sdo::unknown_size;
      if (!count || *count > size || (sized && *count != size)) {
        abort(count ? AbortCode::no_data : count.abort_code());
        return std::nullopt;
      }
      last_ = sized ? position_ + size == size_ : *count != size;
      size = *count;
    } else {
      if (size != 0) std::memcpy(&request_[1], &bytes_[position_], size);
      last_ = position_ + size == size_;
    }
    position_ += size;
    return size;
  }

  // Block upload

  void initiate_block_upload() {
    state_ = State::initiating_block_upload;
    request(static_cast<std::uint8_t>(sdo::block_upload_initiate | (options_.crc ? sdo::crc_supported : 0)));
    sdo::put_multiplexer(request_, index_, sub_index_);
    request_[4] = options_.block_size;
    request_[5] = options_.block_threshold;
  }

  void block_upload_initiated(const sdo::Data& answer) {
    checked_ = options_.crc && (answer[0] & sdo::crc_supported) != 0;
    if (!room_for((answer[0] & sdo::block_size_indicated) != 0, answer)) return;
    state_ = State::block_uploading;
    request(sdo::block_upload_start);
  }

  /// Accepts the next segment in sequence; another one is only checked for the end of its sub-block. The last segment
  /// is held until the end of the transfer indicates how many of its bytes are valid.
  void take_block_segment(const sdo::Data& answer) {
    const auto sequence = static_cast<std::uint8_t>(answer[0] & sdo::sequence_mask);
    const bool last = (answer[0] & sdo::last_block_segment) != 0;
    if (sequence == 0 || sequence > options_.block_size) return abort(AbortCode::sequence_number);
    deadline_ = now_ + options_.timeout;
    if (sequence == sequence_ + 1) {
      if (last) {
        std::memcpy(last_segment_.data(), &answer[1], last_segment_.size());
        state_ = State::block_upload_ending;
      } else {
        if (!take(&answer[1], sdo::segment_bytes, false)) return;
        add_to_crc(&answer[1], sdo::segment_bytes);
      }
      sequence_ = sequence;
    }
    if (last || sequence == options_.block_size) confirm_sub_block();
  }

  void confirm_sub_block() {
    if (!progress(sequence_ != 0)) return;
    request(sdo::block_upload_confirm);
    request_[1] = sequence_;
    request_[2] = options_.block_size;
    sequence_ = 0;
  }

  /// Counts consecutive sub-blocks without progress; false, with an abort, if there are too many.
  [[nodiscard]] bool progress(bool some) {
    failures_ = some ? std::uint8_t{0} : static_cast<std::uint8_t>(failures_ + 1);
    if (failures_ <= options_.block_retries) return true;
    abort(AbortCode::sequence_number);
    return false;
  }

  void block_upload_ended(const sdo::Data& answer) {
    const std::uint32_t size = sdo::segment_bytes - ((answer[0] >> 2) & 7u);
    add_to_crc(last_segment_.data(), size);
    if (checked_ && std::memcmp(&answer[1], &crc_, sizeof crc_) != 0) return abort(AbortCode::crc);
    if (!take(last_segment_.data(), size, true)) return;
    finish(ok);
    request(sdo::block_upload_end_answer);
  }

  void add_to_crc(const std::uint8_t* bytes, std::uint32_t size) {
    for (std::uint32_t i = 0; i < size; ++i) crc_ = crc16_ccitt(crc_, bytes[i]);
  }

  // Block download

  void initiate_block_download() {
    state_ = State::initiating_block_download;
    const bool sized = size_ != sdo::unknown_size;
    request(static_cast<std::uint8_t>(sdo::block_download_initiate | (options_.crc ? sdo::crc_supported : 0) |
                                      (sized ? sdo::block_size_indicated : 0)));
    sdo::put_multiplexer(request_, index_, sub_index_);
    if (sized) sdo::put_word(request_, size_);
  }

  void block_download_initiated(const sdo::Data& answer) {
    checked_ = options_.crc && (answer[0] & sdo::crc_supported) != 0;
    state_ = State::block_downloading;
    begin_sub_block(answer[4]);
  }

  void begin_sub_block(std::uint8_t size) {
    if (size == 0 || size > sdo::largest_block) return abort(AbortCode::block_size);
    block_size_ = size;
    sequence_ = 0;
    send_block_segment();
  }

  void send_block_segment() {
    request(++sequence_);
    const std::optional<std::uint32_t> size = fetch();
    if (!size) return;
    if (last_) {
      request_[0] |= sdo::last_block_segment;
      unused_ = static_cast<std::uint8_t>(sdo::segment_bytes - *size);
    }
    if (repeated_ != 0) {
      --repeated_;
    } else {
      add_to_crc(&request_[1], *size);
    }
  }

  /// The server has received the first segments of the sub-block. The missing ones are sent again, in the next
  /// sub-block.
  void sub_block_confirmed(const sdo::Data& answer) {
    if (answer[1] > sequence_) return abort(AbortCode::sequence_number);
    const auto lost = static_cast<std::uint8_t>(sequence_ - answer[1]);
    if (lost == 0 && last_) {
      state_ = State::block_download_ending;
      request(static_cast<std::uint8_t>(sdo::block_download_end | (unused_ << 2)));
      if (checked_) std::memcpy(&request_[1], &crc_, sizeof crc_);
      return;
    }
    if (!progress(answer[1] != 0)) return;
    if (lost != 0) {
      position_ += unused_;
      position_ -= lost * sdo::segment_bytes;
      repeated_ = static_cast<std::uint8_t>(repeated_ + lost);
      unused_ = 0;
      last_ = false;
    }
    begin_sub_block(answer[2]);
  }

  // Requests

  void abort(AbortCode code) {
    finish(code);
    request(sdo::abort_command);
    sdo::put_multiplexer(request_, index_, sub_index_);
    sdo::put_word(request_, static_cast<std::uint32_t>(code));
  }

  void finish(AbortCode code) {
    result_ = code;
    state_ = State::idle;
    has_request_ = false;
  }

  void request(std::uint8_t command) {
    request_ = {};
    request_[0] = command;
    has_request_ = true;
    deadline_ = now_ + options_.timeout;
  }

  /// Sends the pending request, and during a block download as many segments as the bus has room for.
  void flush() {
    while (has_request_ && !held()) {
      Frame frame{};
      frame.id = channel_.request.can_id();
      frame.extended = channel_.request.extended();
      frame.size = 8;
      frame.data = request_;
      if (!bus_.send(frame)) return;
      has_request_ = false;
      deadline_ = now_ + options_.timeout;
      if (state_ == State::block_downloading && !last_ && sequence_ != block_size_) send_block_segment();
    }
  }

  B& bus_;
  SdoClientOptions options_;
  SdoChannel channel_;
  std::span<std::uint8_t> memory_{};       ///< upload: destination
  std::span<const std::uint8_t> bytes_{};  ///< download: source
  SdoSink sink_{};
  SdoSource source_{};
  alignas(8) std::array<std::uint8_t, 8> number_{};
  alignas(4) sdo::Data request_{};
  std::array<std::uint8_t, sdo::segment_bytes> last_segment_{};  ///< block upload: until its valid bytes are known
  std::uint32_t size_ = sdo::unknown_size;                       ///< of the value, if known
  std::uint32_t position_ = 0;
  std::uint32_t late_entry_ = 0;
  TimePoint now_{};
  TimePoint deadline_{};
  TimePoint late_until_{};  ///< when the late response counts as lost
  AbortCode result_ = ok;
  std::uint16_t index_ = 0;
  std::uint16_t crc_ = 0;
  std::uint8_t sub_index_ = 0;
  State state_ = State::idle;
  LeftOver left_over_ = LeftOver::none;
  std::uint8_t toggle_ = 0;
  std::uint8_t block_size_ = 0;  ///< download: segments of this sub-block
  std::uint8_t sequence_ = 0;    ///< of the last segment
  std::uint8_t repeated_ = 0;    ///< download: next segments that the CRC already includes
  std::uint8_t unused_ = 0;      ///< download: unused bytes of the last segment
  std::uint8_t failures_ = 0;
  bool last_ = false;     ///< download: no more bytes follow
  bool checked_ = false;  ///< the CRC is used
  bool block_refused_ = false;
  bool was_reset_ = false;  ///< the server has been reset since the late response was requested
  bool has_request_ = false;
};

}  // namespace canopen
