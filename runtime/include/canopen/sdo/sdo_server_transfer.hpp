/// The entry, the bytes and the response of a transfer of an SDO server, whichever its protocol (CiA 301, 7.2.4.3).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/assume_aligned.hpp"
#include "canopen/base/bytes.hpp"
#include "canopen/base/optimization.hpp"
#include "canopen/base/result.hpp"
#include "canopen/od/device_options.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/od/sheet.hpp"
#include "canopen/sdo/sdo_block_progress.hpp"
#include "canopen/sdo/sdo_protocol.hpp"
#include "canopen/sdo/sdo_server_hooks.hpp"

namespace canopen {

/// The transfer of a server: the entry that it is for, the place of its bytes, how many have been transferred, which
/// message is expected next, and the response of eight bytes that is to be sent. The server and its block transfers are
/// the protocols that use it.
template <class Device>
class SdoServerTransfer {
  using Entries = EntryAccess<Device>;

 public:
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

  /// Starts a transfer of the entry that a request names, and ends the previous one.
  void begin(const sdo::Data& request) {
    state_ = State::idle;
    toggle_ = 0;
    position_ = 0;
    multiplexer_ = sdo::multiplexer_of(request);
  }

  /// Rejects a request that does not belong to the state of the transfer: the abort contains the entry of the transfer
  /// that it ends, or 0000h:00 if none is running.
  [[nodiscard]] AbortCode reject_command() {
    if (state_ == State::idle) multiplexer_ = 0;
    return AbortCode::command_specifier;
  }

  [[nodiscard]] State state() const { return state_; }
  void enter(State next) { state_ = next; }

  /// Whether a transfer of this entry is running.
  [[nodiscard]] bool transfers(std::uint16_t index, std::uint8_t sub_index) const {
    return state_ != State::idle && multiplexer_ == sdo::multiplexer(index, sub_index);
  }

  /// Returns the toggle bit of the next segment.
  [[nodiscard]] std::uint8_t toggle() const { return toggle_; }
  void alternate_toggle() { toggle_ ^= sdo::toggle; }

  /// Returns the progress of a block transfer, if the device supports them.
  [[nodiscard]] auto& progress() { return progress_; }
  [[nodiscard]] const auto& progress() const { return progress_; }

  /// Finds the entry of the request; returns `refusal` if it does not have this access right.
  [[nodiscard]] AbortCode find(entry::Word right, AbortCode refusal, [[maybe_unused]] auto hooks) {
    word_ = hooks.entries().find(index(), sub_index());
    if (word_ == Dictionary::no_object) return AbortCode::no_object;
    if (word_ == Dictionary::no_sub_index) return AbortCode::no_sub_index;
    return (word_ & right) != 0 ? ok : refusal;
  }

  // Upload

  /// Finds an entry that can be read now.
  [[nodiscard]] AbortCode find_readable(auto hooks) {
    if (const AbortCode code = find(entry::readable, AbortCode::write_only, hooks); code != ok) return code;
    return hooks.before_read(index(), sub_index());
  }

  /// Whether the value is a number that fits into an expedited response. Its bytes are read with `answer_number`.
  [[nodiscard]] bool is_short_number() const {
    return entry::class_of(word_) != entry::Class::special && entry::size_of(word_) <= 4;
  }
  void answer_number(auto hooks) {
    const std::uint32_t bytes = entry::size_of(word_);
    answer_value(bytes, hooks.entries().number(word_) & (0xFFFF'FFFF >> (32 - 8 * bytes)), hooks);
  }

  /// Finds the bytes to send.
  template <class Hooks>
  [[nodiscard]] AbortCode open_upload(Hooks hooks) {
    if constexpr (DomainStreamHooks<Hooks, Device>) {
      bytes_ = nullptr;
      size_ = sdo::unknown_size;
      if (Entries::is_domain(word_) && hooks.streams_upload(index(), sub_index())) return ok;
    }
    std::span<const std::uint8_t> bytes;
    if constexpr (has_long_numbers) {
      bytes = hooks.entries().read(word_, std::span<std::uint8_t, 8>{buffer_.data(), 8});
    } else {
      if (has_block && entry::class_of(word_) != entry::Class::special) return open_number(hooks.entries());
      bytes = hooks.entries().read_variable_length(word_);
    }
    if (bytes.data() == nullptr) return AbortCode::no_data;
    bytes_ = const_cast<std::uint8_t*>(bytes.data());  // an upload only reads
    size_ = static_cast<std::uint32_t>(bytes.size());
    return ok;
  }

  /// Returns the number of bytes to send; `unknown_size` if the application streams them.
  [[nodiscard]] std::uint32_t size() const { return size_; }

  /// Copies a number or a string that is sent in several frames, so that it does not change.
  void hold_value() {
    if constexpr (has_long_numbers || longest_string != 0) {
      const bool is_number = entry::class_of(word_) != entry::Class::special;
      if (!(is_number || is_string_in_ram(word_)) || bytes_ == buffer_.data()) return;
      copy_bytes(buffer_.data(), bytes_, size_);
      bytes_ = buffer_.data();
    }
  }

  /// Sets the response to an initiate: the value, if it fits; otherwise its size, and segments are requested next.
  void answer_upload(auto hooks) {
    if (size_ - 1u < 4u) {
      answer_value(size_, 0, hooks);
      copy_bytes(&reply_[4], bytes_, size_);
      return;
    }
    hold_value();
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
  [[nodiscard]] AbortCode fetch([[maybe_unused]] Hooks hooks, std::uint32_t& size, bool& last) {
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

  /// Makes `fetch` return the last bytes again.
  void step_back(std::uint32_t bytes) { position_ -= bytes; }

  // Download

  /// Returns the size of an expedited download that does not indicate it: that of the entry, or four bytes if it
  /// is variable.
  [[nodiscard]] std::uint32_t size_without_indication() const {
    const std::uint32_t size = Entries::bytes_of(word_);
    return size - 1u < 4u ? size : 4u;
  }

  /// Accepts four bytes, of which the first `size` are the value.
  [[nodiscard]] AbortCode take_expedited(const std::uint8_t* bytes, std::uint32_t size, auto hooks) {
    std::memcpy(buffer_.data(), bytes, 4);
    if (Entries::is_domain(word_)) {
      if (const AbortCode code = open_download(true, size, hooks); code != ok) return code;
      if (const AbortCode code = store(hooks, buffer_.data(), size, true); code != ok) return code;
      return finish(hooks);
    }
    const AbortCode code = hooks.entries().check_length(index(), sub_index(), word_, size);
    return code != ok ? code : write({buffer_.data(), size}, hooks);
  }

  /// Finds the destination of a download and the number of bytes that it accepts: those announced, if the client has
  /// indicated the size.
  template <class Hooks>
  [[nodiscard]] AbortCode open_download(bool indicated, std::uint32_t announced, Hooks hooks) {
    size_indicated_ = indicated;
    size_ = size_indicated_ ? announced : sdo::unknown_size;
    if constexpr (DomainStreamHooks<Hooks, Device>) {
      bytes_ = nullptr;
      if (Entries::is_domain(word_) && hooks.streams_download(index(), sub_index())) return ok;
    }
    bytes_ = buffer_.data();
    std::uint32_t room = room_in_buffer(hooks);
    const Entries entries = hooks.entries();
    if (Entries::is_domain(word_)) {
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
    if (Entries::is_domain(word_)) entries.resize_domain(word_, 0);
    return ok;
  }

  /// Checks whether this number of further bytes is accepted.
  [[nodiscard]] AbortCode check_room(std::uint32_t size) const {
    if (size <= size_ - position_) return ok;
    if (buffer_is_short && size_ == buffer_bytes && !size_indicated_ && !Entries::is_domain(word_))
      return AbortCode::out_of_memory;
    return AbortCode::length_too_high;
  }

  /// Accepts the next bytes of a download.
  template <class Hooks>
  [[nodiscard]] AbortCode store([[maybe_unused]] Hooks hooks, const std::uint8_t* from, std::uint32_t size,
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

  /// Puts the last segment of a block download in place, as far as there is room, without accepting it: how many of its
  /// bytes are valid is not known yet.
  void hold_segment(const std::uint8_t* from) {
    std::uint32_t size = sdo::segment_bytes;
    while (check_room(size) != ok) --size;
    copy(held_segment(), from, size);
  }
  [[nodiscard]] std::uint8_t* held_segment() { return bytes_ == nullptr ? buffer_.data() : bytes_ + position_; }

  /// Completes a download.
  template <class Hooks>
  [[nodiscard]] AbortCode finish(Hooks hooks) {
    state_ = State::idle;
    if (size_indicated_ && position_ != size_) return AbortCode::length_mismatch;
    if (streamed(hooks)) {
      hooks.written(index(), sub_index());
      return ok;
    }
    if (const AbortCode code = check_length(hooks.entries()); code != ok) return code;
    return write({bytes_, position_}, hooks);
  }

  // Response

  /// Whether a response is waiting to be sent.
  [[nodiscard]] bool has_reply() const { return reply_state_ == ReplyState::ready; }
  [[nodiscard]] const sdo::Data& reply() const { return reply_; }
  [[nodiscard]] sdo::Data& reply() { return reply_; }
  void drop_reply() { reply_state_ = ReplyState::none; }
  /// Keeps the response until `release_reply` or `abort`.
  void hold_reply() { reply_state_ = ReplyState::held; }
  [[nodiscard]] bool holds_reply() const { return reply_state_ == ReplyState::held; }
  void release_reply() { reply_state_ = ReplyState::ready; }

  /// Sets a response of a command byte and zeroes.
  void clear_reply(std::uint8_t command) { put_reply(command, 0); }

  /// Sets a response with the index, the sub-index and four more bytes.
  void answer(unsigned command, std::uint32_t word = 0) { put_reply(multiplexer_ | command, word); }

  /// Ends the transfer with an abort, with the code of the device for a wrong length.
  void abort(AbortCode code, auto hooks) {
    if (!options_of<Device>(hooks.entries()).sdo_length_codes) {
      if (code == AbortCode::length_too_high || code == AbortCode::length_too_low) code = AbortCode::length_mismatch;
    }
    abort(code);
  }
  /// Ends the transfer with an abort.
  void abort(AbortCode code) {
    state_ = State::idle;
    answer(sdo::abort_command, static_cast<std::uint32_t>(code));
  }

 private:
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

  [[nodiscard]] static constexpr bool is_string_in_ram(entry::Word word) {
    return entry::is_string(word) && entry::place_of(word) == entry::Place::ram;
  }

  /// The longest string in RAM that can be read, in bytes.
  static constexpr std::size_t longest_string = [] {
    std::size_t longest = 0;
    const Dictionary& dictionary = Device::dictionary;
    for (const Limits& row : dictionary.limits) {
      const entry::Word word =
          dictionary.find(static_cast<std::uint16_t>(row.key >> 8), static_cast<std::uint8_t>(row.key & 0xFF));
      if (is_string_in_ram(word) && (word & entry::readable) != 0) longest = std::max<std::size_t>(longest, row.high);
    }
    return longest;
  }();

  /// Whether there are numbers of more than four bytes, or BOOLEANs, which `answer_number` cannot send.
  static constexpr bool has_long_numbers = Entries::kinds.wide_numbers || Entries::kinds.booleans;

  /// Copies a number for a block upload.
  [[nodiscard]] AbortCode open_number(Entries entries) {
    const std::uint32_t value = entries.number(word_);
    std::memcpy(assume_aligned<4>(buffer_.data()), &value, sizeof value);
    bytes_ = buffer_.data();
    size_ = entry::size_of(word_);
    return ok;
  }

  [[nodiscard]] std::uint16_t index() const { return static_cast<std::uint16_t>(multiplexer_ >> 8); }
  [[nodiscard]] std::uint8_t sub_index() const { return static_cast<std::uint8_t>(multiplexer_ >> 24); }

  /// Returns the bytes of the buffer that a download may use.
  [[nodiscard]] static std::uint32_t room_in_buffer([[maybe_unused]] auto hooks) {
    if constexpr (has_sheet<Device>) {
      const std::size_t longest = Device::sheet_of(hooks.entries()).longest_download;
      return static_cast<std::uint32_t>(std::clamp(longest, number_bytes, buffer_bytes));  // of all strings at most
    } else {
      return buffer_bytes;
    }
  }

  /// Writes bytes whose length fits. "save" needs much stack, so writing a value has a stack frame of its own.
  [[nodiscard, gnu::noinline]] AbortCode write(std::span<std::uint8_t> bytes, auto hooks) {
    if (entry::place_of(word_) != entry::Place::ram) return hooks.command(index(), sub_index(), bytes);
    if constexpr (takes_commands) return write_value_apart(bytes, hooks);
    return write_value(bytes, hooks);
  }

  static constexpr bool takes_commands = Device::dictionary.has(0x1010, 0) || Device::dictionary.has(0x1011, 0);
  [[nodiscard, gnu::noinline]] AbortCode write_value_apart(std::span<std::uint8_t> bytes, auto hooks) {
    return write_value(bytes, hooks);
  }

  /// Writes a value, unless a check rejects it.
  [[nodiscard]] AbortCode write_value(std::span<std::uint8_t> bytes, auto hooks) {
    const Entries entries = hooks.entries();
    const std::uint16_t index = this->index();
    const std::uint8_t sub_index = this->sub_index();
    if constexpr (has_sheet<Device>) {
      if (const AbortCode code = entries.check_value(index, sub_index, word_, bytes, entries); code != ok) return code;
    } else {
      if (const AbortCode code = entries.check_value(index, sub_index, word_, bytes); code != ok) return code;
    }
    return hooks.write(index, sub_index, word_, bytes);
  }

  [[nodiscard]] AbortCode check_length(Entries entries) const {
    return size_indicated_ ? ok : entries.check_length(index(), sub_index(), word_, position_);
  }

  /// Whether the application reads or writes the bytes of this transfer.
  template <class Hooks>
  [[nodiscard]] bool streamed([[maybe_unused]] Hooks hooks) const {
    if constexpr (DomainStreamHooks<Hooks, Device>) return bytes_ == nullptr;
    return false;
  }

  /// Seven bytes, the usual number, do not need a call if speed matters: saves 27 instructions of a Cortex-M4, takes 20
  /// bytes of a Cortex-M0+.
  static void copy(std::uint8_t* to, const std::uint8_t* from, std::uint32_t size) {
    if (!prefers_size && size == sdo::segment_bytes) return copy_bytes(to, from, sdo::segment_bytes);
    copy_bytes(to, from, size);
  }

  /// Sets an expedited response.
  void answer_value(std::uint32_t bytes, std::uint32_t value, [[maybe_unused]] auto hooks) {
    answer(options_of<Device>(hooks.entries()).sdo_upload_size_indicated ? 0x43u | (4 - bytes) << 2 : 0x42u, value);
  }

  void put_reply(std::uint32_t low, std::uint32_t high) {
    std::memcpy(assume_aligned<4>(reply_.data()), &low, sizeof low);
    std::memcpy(assume_aligned<4>(reply_.data() + 4), &high, sizeof high);
    reply_state_ = ReplyState::ready;
  }

  enum class ReplyState : std::uint8_t { none, ready, held };
  struct NoProgress {};

  // Bytes first: a Cortex-M0+ accesses offsets up to 31 with one instruction.
  State state_ = State::idle;
  ReplyState reply_state_ = ReplyState::none;
  std::uint8_t toggle_ = 0;
  bool size_indicated_ = false;
  [[no_unique_address]] std::conditional_t<has_block, SdoBlockProgress, NoProgress> progress_{};
  std::uint32_t multiplexer_ = 0;  ///< index and sub-index, at their position in a frame
  entry::Word word_ = 0;
  std::uint8_t* bytes_ = nullptr;  ///< start of the value; null: the application streams it
  std::uint32_t size_ = 0;         ///< upload: bytes of the value; download: bytes that are accepted
  std::uint32_t position_ = 0;     ///< of the next byte
  alignas(4) sdo::Data reply_{};
  alignas(4) std::array<std::uint8_t, std::max(buffer_bytes, longest_string)> buffer_{};
};

}  // namespace canopen
