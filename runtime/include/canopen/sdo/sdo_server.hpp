/// SDO server: expedited, segmented and block upload and download (CiA 301, 7.2.4.3).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/bytes.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/base/crc16.hpp"
#include "canopen/base/optimization.hpp"
#include "canopen/base/result.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/od/device_options.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/sdo/sdo_protocol.hpp"
#include "canopen/sdo/sdo_server_hooks.hpp"

namespace canopen {

/// One SDO server of a node; it contains the whole state of a transfer. It accepts requests of eight bytes and holds at
/// most one response of eight bytes until it has been sent. During a block upload the next segment is ready as soon as
/// the one before has been sent: a node sends responses until none is left or its bus is full.
///
/// Strings and DOMAINs are uploaded in place: changes by the application during the transfer are sent. Numbers are
/// sampled at the start of the upload. A download is written when it is complete; only a DOMAIN is filled as bytes
/// arrive, and is empty until its last byte has arrived.
///
/// Block transfer is compiled in with `Device::options.sdo_block_transfer`; otherwise its initiate is aborted with 0504
/// 0001h. A new initiate ends the previous transfer, except during the segments of a block download, from which it
/// cannot be distinguished.
template <class Device>
class SdoServer {
 public:
  /// Accepts a request. A response that has not been sent yet is replaced.
  void on_request(const std::array<std::uint8_t, 8>& request, SdoServerHooks<Device> auto&& hooks, TimePoint now) {
    if constexpr (has_timeout) last_activity_ = now;
    if (const AbortCode code = handle(request, hooks); code != ok) abort(code);
  }

  /// Aborts a transfer whose client has not sent anything for too long (0504 0000h). A sub-block that stops for half of
  /// that time is confirmed as far as it has been received, so that the client repeats the rest.
  void on_time([[maybe_unused]] TimePoint now) {
    if constexpr (has_timeout) {
      if (state_ == State::idle || now < last_activity_ + current_timeout()) return;
      if constexpr (has_block) {
        if (sub_block_begun()) return confirm_sub_block();
      }
      abort(AbortCode::timeout);
    }
  }

  /// Returns when the timeout of the client elapses.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    if constexpr (has_timeout) {
      if (state_ != State::idle) return last_activity_ + current_timeout();
    }
    return std::nullopt;
  }

  /// Whether a response is waiting to be sent.
  [[nodiscard]] bool has_reply() const { return has_reply_; }
  [[nodiscard]] const std::array<std::uint8_t, 8>& reply() const { return reply_; }

  /// Reports that the response has been passed to the controller: the next segment of a block upload replaces it.
  void reply_sent(SdoServerHooks<Device> auto&& hooks, [[maybe_unused]] TimePoint now) {
    if constexpr (has_timeout) last_activity_ = now;
    has_reply_ = false;
    if constexpr (has_block) {
      if (state_ != State::block_uploading || block_.sequence == block_.size || block_.last) return;
      if (const AbortCode code = next_block_segment(hooks); code != ok) abort(code);
    }
  }

  /// The same for a device without block transfer.
  void reply_sent() {
    static_assert(!has_block, "the next segment of a block upload needs the hooks");
    has_reply_ = false;
  }

  /// Whether segments of a block download are expected, whose first byte is not a command.
  [[nodiscard]] bool takes_segments() const { return has_block && state_ == State::block_downloading; }

  /// Discards the transfer and the response.
  void reset() {
    state_ = State::idle;
    has_reply_ = false;
  }

  /// Aborts a transfer of a DOMAIN that has been bound to other memory, or that another server writes now.
  void domain_rebound(std::uint16_t index, std::uint8_t sub_index) {
    if (state_ != State::idle && multiplexer_ == sdo::multiplexer(index, sub_index)) abort(AbortCode::not_stored);
  }

 private:
  enum class State : std::uint8_t {
    idle,
    uploading,
    downloading,
    block_upload_initiated,  ///< waits for the start
    block_uploading,         ///< sends a sub-block, then waits for its confirmation
    block_upload_ending,     ///< waits for the client to confirm the end
    block_downloading,       ///< receives segments
    block_download_ending,   ///< waits for the CRC
  };

  static constexpr Duration timeout = from_milliseconds(sdo_timeout_of(Device::options));
  static constexpr bool has_timeout = timeout.count() != 0;
  static constexpr bool has_block = Device::options.sdo_block_transfer;
  static constexpr std::size_t number_bytes = 8;
  static constexpr std::size_t buffer_bytes = std::max<std::size_t>(number_bytes, Device::longest_download);

  /// Whether a string is longer than the buffer.
  static constexpr bool buffer_is_short = [] {
    const Dictionary& dictionary = Device::dictionary;
    return std::any_of(dictionary.limits.begin(), dictionary.limits.end(), [&](const Limits& row) {
      const entry::Word word =
          dictionary.find(static_cast<std::uint16_t>(row.key >> 8), static_cast<std::uint8_t>(row.key & 0xFF));
      return entry::is_string(word) && (word & entry::writable) != 0 && row.high > buffer_bytes;
    });
  }();

  [[nodiscard]] AbortCode handle(const std::array<std::uint8_t, 8>& request, auto& hooks) {
    if constexpr (has_block) {
      if (state_ == State::block_downloading && request[0] != sdo::abort_command)
        return take_block_segment(request, hooks);
    }
    const sdo::ClientCommand command = sdo::client_command(request[0]);
    if (command == sdo::ClientCommand::upload_segment) return upload_segment(request[0], hooks);
    if (command == sdo::ClientCommand::download_segment) return download_segment(request, hooks);
    if (command == sdo::ClientCommand::abort) {
      state_ = State::idle;
      return ok;
    }
    if constexpr (has_block) {
      if (command == sdo::ClientCommand::block_upload &&
          static_cast<sdo::BlockUpload>(request[0] & 3) != sdo::BlockUpload::initiate)
        return block_upload(request, hooks);
      if (command == sdo::ClientCommand::block_download && (request[0] & 1) != 0)
        return end_block_download(request, hooks);
    }
    // An unknown command does not start a transfer: its abort contains the multiplexer of the transfer that it ends.
    if (command == sdo::ClientCommand::reserved && state_ != State::idle) return AbortCode::command_specifier;
    begin(request);
    if (command == sdo::ClientCommand::initiate_upload) return initiate_upload(hooks);
    if (command == sdo::ClientCommand::initiate_download) return initiate_download(request, hooks);
    if constexpr (has_block) {
      if (command == sdo::ClientCommand::block_upload) return initiate_block_upload(request, hooks);
      if (command == sdo::ClientCommand::block_download) return initiate_block_download(request, hooks);
    }
    return AbortCode::command_specifier;
  }

  void begin(const std::array<std::uint8_t, 8>& request) {
    state_ = State::idle;
    toggle_ = 0;
    position_ = 0;
    multiplexer_ = sdo::multiplexer_of(request);
  }

  [[nodiscard]] std::uint16_t index() const { return static_cast<std::uint16_t>(multiplexer_ >> 8); }
  [[nodiscard]] std::uint8_t sub_index() const { return static_cast<std::uint8_t>(multiplexer_ >> 24); }

  /// Finds the entry and checks its access right; returns `refusal` if the right is missing.
  [[nodiscard]] AbortCode find(entry::Word right, AbortCode refusal) {
    word_ = EntryAccess<Device>::find(index(), sub_index());
    if (word_ == Dictionary::no_object) return AbortCode::no_object;
    if (word_ == Dictionary::no_sub_index) return AbortCode::no_sub_index;
    return (word_ & right) != 0 ? ok : refusal;
  }

  [[nodiscard]] bool is_domain() const { return EntryAccess<Device>::is_domain(word_); }

  // Upload

  /// Finds an entry that can be read now.
  [[nodiscard]] AbortCode find_readable(auto& hooks) {
    if (const AbortCode code = find(entry::readable, AbortCode::write_only); code != ok) return code;
    return hooks.before_read(index(), sub_index());
  }

  /// Sets `bytes_` and `size_` to the value to send: for a streamed one, a null pointer and `unknown_size`.
  template <class Hooks>
  [[nodiscard]] AbortCode open_upload(Hooks& hooks) {
    if constexpr (DomainStreamHooks<Hooks, Device>) {
      bytes_ = nullptr;
      size_ = sdo::unknown_size;
      if (is_domain() && hooks.streams_upload(index(), sub_index())) return ok;
    }
    const std::span<const std::uint8_t> bytes =
        hooks.entries().read(word_, std::span<std::uint8_t, 8>{buffer_.data(), 8});
    if (bytes.data() == nullptr) return AbortCode::no_data;
    bytes_ = const_cast<std::uint8_t*>(bytes.data());  // an upload only reads
    size_ = static_cast<std::uint32_t>(bytes.size());
    return ok;
  }

  /// Copies a number that is sent in several frames, so that it does not change.
  void hold_number() {
    if (entry::class_of(word_) == entry::Class::special || bytes_ == buffer_.data()) return;
    copy_bytes(buffer_.data(), bytes_, size_);
    bytes_ = buffer_.data();
  }

  template <class Hooks>
  [[nodiscard]] AbortCode initiate_upload(Hooks& hooks) {
    if (const AbortCode code = find_readable(hooks); code != ok) return code;
    const std::uint32_t bytes = entry::size_of(word_);
    if (entry::class_of(word_) != entry::Class::special && bytes <= 4) {
      answer_value(bytes, hooks.entries().number(word_) & (0xFFFF'FFFF >> (32 - 8 * bytes)));
      return ok;
    }
    if (const AbortCode code = open_upload(hooks); code != ok) return code;
    answer_upload();
    return ok;
  }

  /// Sets an expedited response.
  void answer_value(std::uint32_t bytes, std::uint32_t value) {
    answer(Device::options.sdo_upload_size_indicated ? 0x43u | (4 - bytes) << 2 : 0x42u, value);
  }

  void answer_upload() {
    if (size_ - 1u < 4u) {
      answer_value(size_, 0);
      copy_bytes(&reply_[4], bytes_, size_);
      return;
    }
    hold_number();
    state_ = State::uploading;
    answer_with_size(0x40, sdo::size_indicated);
  }

  /// Sets a response that indicates the size, if it is known.
  void answer_with_size(unsigned command, unsigned indicated) {
    if (size_ == sdo::unknown_size) return answer(command);
    answer(command | indicated, size_);
  }

  /// Writes the next bytes of an upload after the command byte. `size` is their number; `last` marks the end.
  template <class Hooks>
  [[nodiscard]] AbortCode fetch([[maybe_unused]] Hooks& hooks, std::uint32_t& size, bool& last) {
    if constexpr (DomainStreamHooks<Hooks, Device>) {
      if (bytes_ == nullptr) {
        const Result<std::uint32_t> count = hooks.read_domain(
            index(), sub_index(), position_, std::span{reply_}.template subspan<1, sdo::segment_bytes>());
        if (!count) return count.abort_code();
        size = std::min(*count, sdo::segment_bytes);
        last = size != sdo::segment_bytes;
        position_ += size;
        return ok;
      }
    }
    size = std::min(size_ - position_, sdo::segment_bytes);
    copy(&reply_[1], bytes_ + position_, size);
    position_ += size;
    last = position_ == size_;
    return ok;
  }

  template <class Hooks>
  [[nodiscard]] AbortCode upload_segment(std::uint8_t command, Hooks& hooks) {
    if (state_ != State::uploading) return AbortCode::command_specifier;
    if ((command & sdo::toggle) != toggle_) return AbortCode::toggle_bit;
    clear_reply(toggle_);
    std::uint32_t size = 0;
    bool last = false;
    if (const AbortCode code = fetch(hooks, size, last); code != ok) return code;
    reply_[0] = static_cast<std::uint8_t>(reply_[0] | ((sdo::segment_bytes - size) << 1));
    toggle_ ^= sdo::toggle;
    if (last) {
      reply_[0] |= sdo::last_segment;
      state_ = State::idle;
    }
    return ok;
  }

  // Download

  [[nodiscard]] AbortCode initiate_download(const std::array<std::uint8_t, 8>& request, auto& hooks) {
    if (const AbortCode code = find(entry::writable, AbortCode::read_only); code != ok) return code;
    const bool indicated = (request[0] & sdo::size_indicated) != 0;
    if ((request[0] & sdo::expedited) != 0) {
      const std::uint32_t size = indicated ? 4u - ((request[0] >> 2) & 3u) : size_without_indication();
      if (const AbortCode code = take_expedited(&request[4], size, hooks); code != ok) return code;
    } else {
      size_indicated_ = indicated;
      if (const AbortCode code = prepare(sdo::word_of(request), hooks); code != ok) return code;
      state_ = State::downloading;
    }
    answer(0x60);
    return ok;
  }

  /// Accepts four bytes, of which the first `size` are the value.
  [[nodiscard]] AbortCode take_expedited(const std::uint8_t* bytes, std::uint32_t size, auto& hooks) {
    std::memcpy(buffer_.data(), bytes, 4);
    if (is_domain()) {
      size_indicated_ = true;
      if (const AbortCode code = prepare(size, hooks); code != ok) return code;
      if (const AbortCode code = store(hooks, buffer_.data(), size, true); code != ok) return code;
      return finish(hooks);
    }
    const AbortCode code = hooks.entries().check_length(index(), sub_index(), word_, size);
    return code != ok ? code : write({buffer_.data(), size}, hooks);
  }

  /// Returns the size of an expedited download that does not indicate it: that of the entry, or four bytes if it
  /// is variable.
  [[nodiscard]] std::uint32_t size_without_indication() const {
    const std::uint32_t size = EntryAccess<Device>::bytes_of(word_);
    return size - 1u < 4u ? size : 4u;
  }

  /// Sets `bytes_` to the destination of a download and `size_` to the number of bytes it may have: for a streamed
  /// DOMAIN, a null pointer.
  template <class Hooks>
  [[nodiscard]] AbortCode prepare(std::uint32_t announced, Hooks& hooks) {
    size_ = size_indicated_ ? announced : sdo::unknown_size;
    if constexpr (DomainStreamHooks<Hooks, Device>) {
      bytes_ = nullptr;
      if (is_domain() && hooks.streams_download(index(), sub_index())) return ok;
    }
    bytes_ = buffer_.data();
    std::uint32_t room = buffer_bytes;
    const EntryAccess<Device> entries = hooks.entries();
    if (is_domain()) {
      const Domain memory = entries.domain(word_);
      if (memory.data == nullptr) return AbortCode::not_stored;
      bytes_ = memory.data;
      room = memory.capacity;
    }
    if (size_indicated_) {
      if (const AbortCode code = entries.check_length(index(), sub_index(), word_, size_); code != ok) return code;
      if (buffer_is_short && size_ > room) return AbortCode::out_of_memory;
    } else {
      size_ = room;
    }
    if (is_domain()) entries.resize_domain(word_, 0);
    return ok;
  }

  /// Checks whether this number of further bytes is accepted.
  [[nodiscard]] AbortCode check_room(std::uint32_t size) const {
    if (size <= size_ - position_) return ok;
    if (buffer_is_short && size_ == buffer_bytes && !size_indicated_ && !is_domain()) return AbortCode::out_of_memory;
    return AbortCode::length_too_high;
  }

  /// Accepts the next bytes of a download.
  template <class Hooks>
  [[nodiscard]] AbortCode store([[maybe_unused]] Hooks& hooks, const std::uint8_t* from, std::uint32_t size,
                                [[maybe_unused]] bool last) {
    if (const AbortCode code = check_room(size); code != ok) return code;
    if constexpr (DomainStreamHooks<Hooks, Device>) {
      if (bytes_ == nullptr) {
        if (last && size_indicated_ && position_ + size != size_) return AbortCode::length_mismatch;
        const AbortCode code = hooks.write_domain(index(), sub_index(), position_, {from, size}, last);
        position_ += size;
        return code;
      }
    }
    if (from != bytes_ + position_) copy(bytes_ + position_, from, size);
    position_ += size;
    return ok;
  }

  [[nodiscard]] AbortCode download_segment(const std::array<std::uint8_t, 8>& request, auto& hooks) {
    if (state_ != State::downloading) return AbortCode::command_specifier;
    if ((request[0] & sdo::toggle) != toggle_) return AbortCode::toggle_bit;
    const bool last = (request[0] & sdo::last_segment) != 0;
    const std::uint32_t size = sdo::segment_bytes - ((request[0] >> 1) & 7u);
    if (const AbortCode code = store(hooks, &request[1], size, last); code != ok) return code;
    if (last) {
      if (const AbortCode code = finish(hooks); code != ok) return code;
    }
    clear_reply(static_cast<std::uint8_t>(0x20 | toggle_));
    toggle_ ^= sdo::toggle;
    return ok;
  }

  /// Completes a download.
  template <class Hooks>
  [[nodiscard]] AbortCode finish(Hooks& hooks) {
    state_ = State::idle;
    if (size_indicated_ && position_ != size_) return AbortCode::length_mismatch;
    if (streamed(hooks)) {
      hooks.after_write(index(), sub_index());
      return ok;
    }
    if (const AbortCode code = check_length(hooks.entries()); code != ok) return code;
    return write({bytes_, position_}, hooks);
  }

  /// Writes bytes whose length fits. "save" needs much stack, so writing a value has a stack frame of its own.
  [[nodiscard, gnu::noinline]] AbortCode write(std::span<std::uint8_t> bytes, auto& hooks) {
    if (entry::place_of(word_) != entry::Place::ram) return hooks.command(index(), sub_index(), bytes);
    if constexpr (takes_commands) return write_value_apart(bytes, hooks);
    return write_value(bytes, hooks);
  }

  static constexpr bool takes_commands = Device::dictionary.has(0x1010, 0) || Device::dictionary.has(0x1011, 0);
  [[nodiscard, gnu::noinline]] AbortCode write_value_apart(std::span<std::uint8_t> bytes, auto& hooks) {
    return write_value(bytes, hooks);
  }

  /// Writes a value, unless a check rejects it.
  [[nodiscard]] AbortCode write_value(std::span<std::uint8_t> bytes, auto& hooks) {
    const EntryAccess<Device> entries = hooks.entries();
    if (const AbortCode code = entries.check_value(index(), sub_index(), word_, bytes); code != ok) return code;
    if (const AbortCode code = hooks.before_write(index(), sub_index(), bytes); code != ok) return code;
    // A handler may have bound a DOMAIN to other memory: the application has then taken the bytes.
    const bool in_place = !is_domain() || entries.domain(word_).data == bytes.data();
    if (in_place && is_new(bytes, hooks)) entries.write(word_, bytes);
    hooks.after_write(index(), sub_index());
    return ok;
  }

  [[nodiscard]] bool is_new(std::span<const std::uint8_t> bytes, auto& hooks) const {
    if constexpr (requires { hooks.is_new(word_, bytes); }) {
      return hooks.is_new(word_, bytes);
    } else {
      return true;
    }
  }

  /// If the size was announced, the length has already been checked.
  [[nodiscard]] AbortCode check_length(EntryAccess<Device> entries) const {
    return size_indicated_ ? ok : entries.check_length(index(), sub_index(), word_, position_);
  }

  /// Whether the application reads or writes the bytes of this transfer.
  template <class Hooks>
  [[nodiscard]] bool streamed([[maybe_unused]] const Hooks& hooks) const {
    if constexpr (DomainStreamHooks<Hooks, Device>) return bytes_ == nullptr;
    return false;
  }

  // Block upload

  [[nodiscard]] AbortCode block_upload(const std::array<std::uint8_t, 8>& request, auto& hooks) {
    switch (static_cast<sdo::BlockUpload>(request[0] & 3)) {
      case sdo::BlockUpload::initiate: break;
      case sdo::BlockUpload::start:
        if (state_ != State::block_upload_initiated) break;
        state_ = State::block_uploading;
        return next_block_segment(hooks);
      case sdo::BlockUpload::confirm:
        if (state_ != State::block_uploading) break;
        return sub_block_confirmed(request, hooks);
      case sdo::BlockUpload::end:
        if (state_ != State::block_upload_ending) break;
        state_ = State::idle;
        return ok;
    }
    return AbortCode::command_specifier;
  }

  [[nodiscard]] AbortCode initiate_block_upload(const std::array<std::uint8_t, 8>& request, auto& hooks) {
    if (!set_block_size(request[4])) return AbortCode::block_size;
    if (const AbortCode code = find_readable(hooks); code != ok) return code;
    if (const AbortCode code = open_upload(hooks); code != ok) return code;
    if (size_ <= request[5] && request[5] != 0) {  // protocol switch threshold; 0: no switch
      answer_upload();
      return ok;
    }
    hold_number();
    begin_blocks(request[0]);
    state_ = State::block_upload_initiated;
    answer_with_size(sdo::block_upload_answer | sdo::crc_supported, sdo::block_size_indicated);
    return ok;
  }

  [[nodiscard]] bool set_block_size(std::uint8_t size) {
    block_.size = size;
    return size - 1u < sdo::largest_block;
  }

  void begin_blocks(std::uint8_t command) {
    block_.crc = 0;
    block_.checked = (command & sdo::crc_supported) != 0;
    block_.sequence = 0;
    block_.repeated = 0;
    block_.unused = 0;
    block_.last = false;
  }

  [[nodiscard]] AbortCode next_block_segment(auto& hooks) {
    clear_reply(++block_.sequence);
    std::uint32_t size = 0;
    if (const AbortCode code = fetch(hooks, size, block_.last); code != ok) return code;
    if (block_.last) {
      reply_[0] |= sdo::last_block_segment;
      block_.unused = static_cast<std::uint8_t>(sdo::segment_bytes - size);
    }
    if (block_.repeated != 0) {
      --block_.repeated;
    } else {
      add_to_crc(&reply_[1], size);
    }
    return ok;
  }

  void add_to_crc(const std::uint8_t* bytes, std::uint32_t size) {
    if (!prefers_size && size == sdo::segment_bytes) {
      std::uint16_t crc = crc16_ccitt(block_.crc, bytes[0], bytes[1]);
      crc = crc16_ccitt(crc, bytes[2], bytes[3]);
      crc = crc16_ccitt(crc, bytes[4], bytes[5]);
      block_.crc = crc16_ccitt(crc, bytes[6]);
      return;
    }
    block_.crc = crc16_ccitt(block_.crc, {bytes, size});
  }

  /// The client has received the first segments of the sub-block. The missing ones are sent again, in the next
  /// sub-block.
  [[nodiscard]] AbortCode sub_block_confirmed(const std::array<std::uint8_t, 8>& request, auto& hooks) {
    if (request[1] > block_.sequence) return AbortCode::sequence_number;
    const auto lost = static_cast<std::uint8_t>(block_.sequence - request[1]);
    if (lost == 0 && block_.last) {
      state_ = State::block_upload_ending;
      clear_reply(static_cast<std::uint8_t>(sdo::block_upload_end | (block_.unused << 2)));
      if (block_.checked) {
        reply_[1] = static_cast<std::uint8_t>(block_.crc);
        reply_[2] = static_cast<std::uint8_t>(block_.crc >> 8);
      }
      return ok;
    }
    if (!set_block_size(request[2])) return AbortCode::block_size;
    if (lost != 0) {
      position_ += block_.unused;
      position_ -= lost * sdo::segment_bytes;
      block_.repeated = static_cast<std::uint8_t>(block_.repeated + lost);
      block_.unused = 0;
      block_.last = false;
    }
    block_.sequence = 0;
    return next_block_segment(hooks);
  }

  // Block download

  [[nodiscard]] AbortCode initiate_block_download(const std::array<std::uint8_t, 8>& request, auto& hooks) {
    if (const AbortCode code = find(entry::writable, AbortCode::read_only); code != ok) return code;
    size_indicated_ = (request[0] & sdo::block_size_indicated) != 0;
    if (const AbortCode code = prepare(sdo::word_of(request), hooks); code != ok) return code;
    begin_blocks(request[0]);
    state_ = State::block_downloading;
    answer(sdo::block_download_answer | sdo::crc_supported, sdo::largest_block);
    return ok;
  }

  /// Accepts the next segment in sequence; another one is only checked for the end of its sub-block. How many bytes of
  /// the last one are valid is not known before the end of the transfer: they are put in place, and counted then.
  [[nodiscard]] AbortCode take_block_segment(const std::array<std::uint8_t, 8>& request, auto& hooks) {
    const auto sequence = static_cast<std::uint8_t>(request[0] & sdo::sequence_mask);
    const bool last = (request[0] & sdo::last_block_segment) != 0;
    if (sequence == 0) return AbortCode::sequence_number;
    if (sequence == block_.sequence + 1) {
      block_.sequence = sequence;
      if (last) {
        std::uint32_t size = sdo::segment_bytes;
        while (check_room(size) != ok) --size;
        copy(last_segment(), &request[1], size);
        state_ = State::block_download_ending;
      } else {
        if (const AbortCode code = store(hooks, &request[1], sdo::segment_bytes, false); code != ok) return code;
        add_to_crc(&request[1], sdo::segment_bytes);
      }
    }
    if (last || sequence == sdo::largest_block) confirm_sub_block();
    return ok;
  }

  [[nodiscard]] std::uint8_t* last_segment() { return bytes_ == nullptr ? buffer_.data() : bytes_ + position_; }

  void confirm_sub_block() {
    clear_reply(sdo::block_download_confirm);
    reply_[1] = block_.sequence;
    reply_[2] = sdo::largest_block;
    block_.sequence = 0;
  }

  [[nodiscard]] AbortCode end_block_download(const std::array<std::uint8_t, 8>& request, auto& hooks) {
    if (state_ != State::block_download_ending) return AbortCode::command_specifier;
    const std::uint32_t size = sdo::segment_bytes - ((request[0] >> 2) & 7u);
    if (const AbortCode code = check_room(size); code != ok) return code;
    add_to_crc(last_segment(), size);
    if (block_.checked && (request[1] | request[2] << 8) != block_.crc) return AbortCode::crc;
    if (const AbortCode code = store(hooks, last_segment(), size, true); code != ok) return code;
    if (const AbortCode code = finish(hooks); code != ok) return code;
    clear_reply(sdo::block_download_end_answer);
    return ok;
  }

  /// Whether a sub-block has been received in part.
  [[nodiscard]] bool sub_block_begun() const { return state_ == State::block_downloading && block_.sequence != 0; }

  [[nodiscard]] Duration current_timeout() const {
    if constexpr (has_block) {
      if (sub_block_begun()) return timeout / 2;
    }
    return timeout;
  }

  // Responses

  /// Seven bytes, the usual number, do not need a call if speed matters.
  static void copy(std::uint8_t* to, const std::uint8_t* from, std::uint32_t size) {
    if (!prefers_size && size == sdo::segment_bytes) return copy_bytes(to, from, sdo::segment_bytes);
    copy_bytes(to, from, size);
  }

  void put_reply(std::uint32_t low, std::uint32_t high) {
    std::memcpy(std::assume_aligned<4>(reply_.data()), &low, sizeof low);
    std::memcpy(std::assume_aligned<4>(reply_.data() + 4), &high, sizeof high);
    has_reply_ = true;
  }

  void clear_reply(std::uint8_t command) { put_reply(command, 0); }

  /// Sets a response with the index, the sub-index and four more bytes.
  void answer(unsigned command, std::uint32_t word = 0) { put_reply(multiplexer_ | command, word); }

  void abort(AbortCode code) {
    if constexpr (!Device::options.sdo_length_codes) {
      if (code == AbortCode::length_too_high || code == AbortCode::length_too_low) code = AbortCode::length_mismatch;
    }
    state_ = State::idle;
    answer(sdo::abort_command, static_cast<std::uint32_t>(code));
  }

  struct Nothing {};

  struct Block {
    std::uint16_t crc = 0;
    std::uint8_t size = 0;      ///< upload: segments of this sub-block
    std::uint8_t sequence = 0;  ///< of the last segment
    std::uint8_t repeated = 0;  ///< upload: next segments that the CRC already includes
    std::uint8_t unused = 0;    ///< upload: unused bytes of the last segment
    bool last = false;          ///< upload: the last segment has been built
    bool checked = false;       ///< the client uses the CRC
  };

  // Bytes first: a Cortex-M0+ accesses offsets up to 31 with one instruction.
  State state_ = State::idle;
  bool has_reply_ = false;
  std::uint8_t toggle_ = 0;
  bool size_indicated_ = false;
  [[no_unique_address]] std::conditional_t<has_block, Block, Nothing> block_{};
  std::uint32_t multiplexer_ = 0;  ///< index and sub-index, at their position in a frame
  entry::Word word_ = 0;
  std::uint8_t* bytes_ = nullptr;  ///< start of the value; null: the application streams it
  std::uint32_t size_ = 0;         ///< upload: bytes of the value; download: bytes that are accepted
  std::uint32_t position_ = 0;     ///< of the next byte
  [[no_unique_address]] std::conditional_t<has_timeout, TimePoint, Nothing> last_activity_{};
  alignas(4) std::array<std::uint8_t, 8> reply_{};
  alignas(4) std::array<std::uint8_t, buffer_bytes> buffer_{};
};

}  // namespace canopen
