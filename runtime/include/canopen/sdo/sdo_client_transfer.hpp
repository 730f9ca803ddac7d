/// The messages of an SDO client, without time and bus: expedited, segmented and block transfers (CiA 301, 7.2.4.3).
#pragma once

#include <cstdint>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/result.hpp"
#include "canopen/sdo/sdo_client_blocks.hpp"
#include "canopen/sdo/sdo_client_value.hpp"
#include "canopen/sdo/sdo_protocol.hpp"
#include "canopen/sdo/sdo_transfer.hpp"

namespace canopen {

/// One transfer at a time, as a state machine that turns each response into the next request. A request stays until
/// `request_sent`, which makes the next segment of a block download the request at once.
class SdoClientTransfer {
 public:
  constexpr explicit SdoClientTransfer(const SdoClientOptions& options) : options_{options} {}

  [[nodiscard]] const SdoClientOptions& options() const { return options_; }
  void set_options(const SdoClientOptions& options) { options_ = options; }

  /// Starts to read an entry into memory or a sink.
  void upload(std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> memory) {
    value_.upload_to(memory);
    begin_upload(index, sub_index, memory.size() > options_.block_threshold);
  }
  void upload(std::uint16_t index, std::uint8_t sub_index, const SdoSink& sink) {
    value_.upload_to(sink);
    begin_upload(index, sub_index, true);
  }

  /// Starts to write an entry from memory or a source.
  template <class Source>
  void download(std::uint16_t index, std::uint8_t sub_index, const Source& source) {
    value_.download_from(source);
    begin(index, sub_index);
    if (options_.block_transfer && value_.size() > options_.block_threshold && !block_refused_) {
      initiate_block_download();
    } else {
      initiate_download();
    }
  }

  [[nodiscard]] bool idle() const { return state_ == State::idle; }

  /// Whether the first response is expected.
  [[nodiscard]] bool is_initiating() const {
    return state_ == State::initiating_upload || state_ == State::initiating_download ||
           state_ == State::initiating_block_upload || state_ == State::initiating_block_download;
  }

  /// Whether segments of a block upload are expected.
  [[nodiscard]] bool receives_segments() const { return state_ == State::block_uploading; }
  /// Whether some of a sub-block have been received, so that the server can be asked for the others.
  [[nodiscard]] bool sub_block_begun() const { return receives_segments() && blocks_.sub_block_begun(); }

  /// Returns the entry as `sdo::multiplexer`.
  [[nodiscard]] std::uint32_t entry() const { return sdo::multiplexer(index_, sub_index_); }

  /// Returns how the last transfer ended.
  [[nodiscard]] AbortCode result() const { return result_; }
  [[nodiscard]] const SdoClientValue& value() const { return value_; }

  /// Accepts a response; returns false if it is ignored because it belongs to an earlier transfer.
  bool on_response(const sdo::Data& answer) {
    const bool is_segment = receives_segments() && answer[0] != sdo::abort_command;
    if (!is_segment) {
      // A server that has no transfer, as after its time-out, aborts a segment with 0000h:00.
      const bool without_entry = answer[0] == sdo::abort_command && sdo::multiplexer_of(answer) == 0;
      const bool earlier =
          sdo::has_multiplexer(answer) && !without_entry ? sdo::multiplexer_of(answer) != entry() : is_initiating();
      if (earlier) return false;
    }
    const AbortCode code = is_segment ? take_block_segment(answer) : handle(answer);
    if (code != ok) abort(code);
    return true;
  }

  /// Confirms the segments of a sub-block that has stopped; the server repeats what was lost.
  void confirm_sub_block() {
    if (const AbortCode code = request_next_sub_block(); code != ok) abort(code);
  }

  /// Ends the transfer with an abort, which is the next request.
  void abort(AbortCode code) {
    finish(code);
    request(sdo::abort_command);
    sdo::put_multiplexer(request_, index_, sub_index_);
    sdo::put_word(request_, code_in_frame(code));
  }

  /// Ends the transfer without a further request.
  void finish(AbortCode code) {
    result_ = code;
    state_ = State::idle;
    has_request_ = false;
  }

  // Requests

  [[nodiscard]] bool has_request() const { return has_request_; }
  [[nodiscard]] const sdo::Data& request() const { return request_; }
  void drop_request() { has_request_ = false; }

  /// Reports that the request has been sent.
  void request_sent() {
    has_request_ = false;
    if (state_ != State::block_downloading || !blocks_.has_segment(value_)) return;
    if (const AbortCode code = request_block_segment(); code != ok) abort(code);
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

  void begin(std::uint16_t index, std::uint8_t sub_index) {
    index_ = index;
    sub_index_ = sub_index;
    result_ = ok;
    restart();
  }

  void restart() {
    toggle_ = 0;
    value_.rewind();
    blocks_.begin();
  }

  void begin_upload(std::uint16_t index, std::uint8_t sub_index, bool long_enough) {
    begin(index, sub_index);
    if (options_.block_transfer && long_enough && !block_refused_) {
      initiate_block_upload();
    } else {
      initiate_upload();
    }
  }

  /// Processes a response other than a segment of a block upload.
  [[nodiscard]] AbortCode handle(const sdo::Data& answer) {
    const sdo::ServerCommand command = sdo::server_command(answer[0]);
    if (command == sdo::ServerCommand::abort) {
      aborted(abort_code_from(sdo::word_of(answer)));
      return ok;
    }
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
        finish(ok);
        return ok;
      case State::block_uploading:
      case State::idle: return ok;
    }
    return AbortCode::command_specifier;
  }

  void aborted(AbortCode code) {
    const bool refused = code == AbortCode::command_specifier || code == AbortCode::general;
    if (refused && state_ == State::initiating_block_upload) {
      fall_back(code);
      initiate_upload();
    } else if (refused && state_ == State::initiating_block_download) {
      fall_back(code);
      initiate_download();
    } else {
      finish(code);
    }
  }

  /// The server does not support block transfer, in general or for this entry.
  void fall_back(AbortCode code) {
    block_refused_ = code == AbortCode::command_specifier;
    restart();
  }

  // Expedited and segmented upload

  void initiate_upload() {
    state_ = State::initiating_upload;
    request(0x40);
    sdo::put_multiplexer(request_, index_, sub_index_);
  }

  [[nodiscard]] AbortCode upload_initiated(const sdo::Data& answer) {
    const bool size_indicated = (answer[0] & sdo::size_indicated) != 0;
    if ((answer[0] & sdo::expedited) != 0) {
      const AbortCode code = size_indicated ? value_.take_expedited(&answer[4], 4u - ((answer[0] >> 2) & 3u))
                                            : value_.take_expedited(&answer[4]);
      if (code == ok) finish(ok);
      return code;
    }
    if (size_indicated) {
      if (const AbortCode code = value_.announce(sdo::word_of(answer)); code != ok) return code;
    }
    state_ = State::uploading;
    request(0x60);
    return ok;
  }

  [[nodiscard]] AbortCode segment_uploaded(const sdo::Data& answer) {
    if ((answer[0] & sdo::toggle) != toggle_) return AbortCode::toggle_bit;
    const bool last = (answer[0] & sdo::last_segment) != 0;
    const std::uint32_t size = sdo::segment_bytes - ((answer[0] >> 1) & 7u);
    if (const AbortCode code = value_.take(&answer[1], size, last); code != ok) return code;
    if (last) {
      finish(ok);
      return ok;
    }
    toggle_ ^= sdo::toggle;
    request(static_cast<std::uint8_t>(0x60 | toggle_));
    return ok;
  }

  // Expedited and segmented download

  void initiate_download() {
    state_ = State::initiating_download;
    if (value_.is_short()) {
      request(static_cast<std::uint8_t>(0x23 | ((4 - value_.size()) << 2)));
      value_.fetch_expedited(request_);
    } else if (!value_.size_known()) {
      request(0x20);
    } else {
      request(0x21);
      sdo::put_word(request_, value_.size());
    }
    sdo::put_multiplexer(request_, index_, sub_index_);
  }

  [[nodiscard]] AbortCode download_initiated() {
    if (value_.is_sent()) {
      finish(ok);
      return ok;
    }
    state_ = State::downloading;
    return request_segment();
  }

  [[nodiscard]] AbortCode segment_downloaded(const sdo::Data& answer) {
    if ((answer[0] & sdo::toggle) != toggle_) return AbortCode::toggle_bit;
    if (value_.is_sent()) {
      finish(ok);
      return ok;
    }
    toggle_ ^= sdo::toggle;
    return request_segment();
  }

  [[nodiscard]] AbortCode request_segment() {
    request(toggle_);
    const Result<std::uint32_t> size = value_.fetch(request_);
    if (!size) return size.abort_code();
    const unsigned last = value_.is_sent() ? sdo::last_segment : 0;
    request_[0] = static_cast<std::uint8_t>(toggle_ | ((sdo::segment_bytes - *size) << 1) | last);
    return ok;
  }

  // Block upload

  void initiate_block_upload() {
    state_ = State::initiating_block_upload;
    request(static_cast<std::uint8_t>(sdo::block_upload_initiate | (options_.crc ? sdo::crc_supported : 0)));
    sdo::put_multiplexer(request_, index_, sub_index_);
    request_[4] = options_.block_size;
    request_[5] = options_.block_threshold;
  }

  [[nodiscard]] AbortCode block_upload_initiated(const sdo::Data& answer) {
    blocks_.initiated(answer[0], options_);
    if ((answer[0] & sdo::block_size_indicated) != 0) {
      if (const AbortCode code = value_.announce(sdo::word_of(answer)); code != ok) return code;
    }
    state_ = State::block_uploading;
    request(sdo::block_upload_start);
    return ok;
  }

  [[nodiscard]] AbortCode take_block_segment(const sdo::Data& answer) {
    const std::uint8_t sequence = SdoClientBlocks::sequence_of(answer);
    const bool last = SdoClientBlocks::is_last(answer);
    if (sequence == 0 || sequence > options_.block_size) return AbortCode::sequence_number;
    if (blocks_.is_next(answer)) {
      if (last) state_ = State::block_upload_ending;
      if (const AbortCode code = blocks_.take(answer, value_); code != ok) return code;
    }
    return last || sequence == options_.block_size ? request_next_sub_block() : ok;
  }

  [[nodiscard]] AbortCode request_next_sub_block() {
    request(sdo::block_upload_confirm);
    return blocks_.confirm_sub_block(request_, options_);
  }

  [[nodiscard]] AbortCode block_upload_ended(const sdo::Data& answer) {
    if (const AbortCode code = blocks_.end_upload(answer, value_); code != ok) return code;
    finish(ok);
    request(sdo::block_upload_end_answer);
    return ok;
  }

  // Block download

  void initiate_block_download() {
    state_ = State::initiating_block_download;
    const bool sized = value_.size_known();
    request(static_cast<std::uint8_t>(sdo::block_download_initiate | (options_.crc ? sdo::crc_supported : 0) |
                                      (sized ? sdo::block_size_indicated : 0)));
    sdo::put_multiplexer(request_, index_, sub_index_);
    if (sized) sdo::put_word(request_, value_.size());
  }

  [[nodiscard]] AbortCode block_download_initiated(const sdo::Data& answer) {
    blocks_.initiated(answer[0], options_);
    state_ = State::block_downloading;
    if (const AbortCode code = blocks_.begin_sub_block(answer[4]); code != ok) return code;
    return request_block_segment();
  }

  [[nodiscard]] AbortCode request_block_segment() {
    request(0);
    return blocks_.put_segment(request_, value_);
  }

  [[nodiscard]] AbortCode sub_block_confirmed(const sdo::Data& answer) {
    if (blocks_.is_complete(answer, value_)) {
      state_ = State::block_download_ending;
      request(sdo::block_download_end);
      blocks_.put_end(request_);
      return ok;
    }
    if (const AbortCode code = blocks_.sub_block_confirmed(answer, value_, options_); code != ok) return code;
    return request_block_segment();
  }

  void request(std::uint8_t command) {
    request_ = {};
    request_[0] = command;
    has_request_ = true;
  }

  // Bytes first: a Cortex-M0+ accesses offsets up to 31 with one instruction.
  State state_ = State::idle;
  bool has_request_ = false;
  bool block_refused_ = false;  ///< by the server, for all entries
  std::uint8_t toggle_ = 0;
  std::uint16_t index_ = 0;
  std::uint8_t sub_index_ = 0;
  SdoClientBlocks blocks_{};
  alignas(4) sdo::Data request_{};
  AbortCode result_ = ok;
  SdoClientOptions options_;
  SdoClientValue value_{};
};

}  // namespace canopen
