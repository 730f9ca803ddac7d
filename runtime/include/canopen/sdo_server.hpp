/// SDO server: expedited and segmented upload and download (CiA 301, 7.2.4.3).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>

#include "canopen/abort_code.hpp"
#include "canopen/dictionary.hpp"
#include "canopen/frame.hpp"
#include "canopen/object_store.hpp"
#include "canopen/sdo_protocol.hpp"
#include "canopen/time.hpp"

namespace canopen {

/// What a server asks of the node around it:
///   EntryAccess entries();
///   AbortCode before_read(index, sub_index);            may refresh the value, or refuse
///   AbortCode before_write(index, sub_index, bytes);    the bytes fit the entry; may refuse, or change them
///   void after_write(index, sub_index);
template <class T>
concept SdoServerHooks = requires(T hooks, std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
  { hooks.entries() } -> std::same_as<EntryAccess>;
  { hooks.before_read(index, sub_index) } -> std::same_as<AbortCode>;
  { hooks.before_write(index, sub_index, bytes) } -> std::same_as<AbortCode>;
  hooks.after_write(index, sub_index);
};

/// One server. It takes requests of eight bytes and leaves at most one answer of eight bytes, which stays until it is
/// sent.
///
/// Strings and DOMAINs are uploaded in place: what the application changes meanwhile is what goes out. Numbers are
/// taken as they were when the upload began. A download is written when it is complete; only a DOMAIN fills up as it
/// comes, and is empty until its last byte is there.
template <class Device>
class SdoServer {
 public:
  /// Takes a request. A new initiate ends the transfer before; an answer that could not be sent yet is replaced.
  void on_request(const std::array<std::uint8_t, 8>& request, SdoServerHooks auto&& hooks, TimePoint now) {
    if constexpr (has_timeout) last_request_ = now;
    if (const AbortCode code = handle(request, hooks); code != ok) abort(code);
  }

  /// Aborts a transfer whose client has been silent for too long (0504 0000h).
  void on_time([[maybe_unused]] TimePoint now) {
    if constexpr (has_timeout) {
      if (state_ != State::idle && now >= last_request_ + timeout) abort(AbortCode::timeout);
    }
  }

  /// When the client will have been silent for too long.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    if constexpr (has_timeout) {
      if (state_ != State::idle) return last_request_ + timeout;
    }
    return std::nullopt;
  }

  /// Whether an answer waits to be sent.
  [[nodiscard]] bool has_reply() const { return has_reply_; }
  [[nodiscard]] const std::array<std::uint8_t, 8>& reply() const { return reply_; }
  void reply_sent() { has_reply_ = false; }

  /// Forgets the transfer and the answer.
  void reset() {
    state_ = State::idle;
    has_reply_ = false;
  }

  /// The memory behind a DOMAIN is another one now: a transfer from or to the old one ends.
  void domain_rebound(std::uint16_t index, std::uint8_t sub_index) {
    if (state_ != State::idle && index_ == index && sub_index_ == sub_index) abort(AbortCode::not_stored);
  }

 private:
  enum class State : std::uint8_t { idle, uploading, downloading };

  static constexpr Duration timeout = from_milliseconds(Device::options.sdo_timeout);
  static constexpr bool has_timeout = timeout.count() != 0;
  static constexpr std::size_t number_bytes = 8;
  static constexpr std::size_t buffer_bytes = std::max<std::size_t>(number_bytes, Device::longest_download);

  [[nodiscard]] AbortCode handle(const std::array<std::uint8_t, 8>& request, auto& hooks) {
    switch (sdo::client_command(request[0])) {
      case sdo::ClientCommand::initiate_upload: begin(request); return initiate_upload(hooks);
      case sdo::ClientCommand::initiate_download: begin(request); return initiate_download(request, hooks);
      case sdo::ClientCommand::upload_segment: return upload_segment(request[0]);
      case sdo::ClientCommand::download_segment: return download_segment(request, hooks);
      case sdo::ClientCommand::abort: state_ = State::idle; return ok;
      case sdo::ClientCommand::block_upload:
      case sdo::ClientCommand::block_download:
      case sdo::ClientCommand::reserved: begin(request); break;
    }
    return AbortCode::command_specifier;
  }

  void begin(const std::array<std::uint8_t, 8>& request) {
    state_ = State::idle;
    toggle_ = 0;
    index_ = sdo::index_of(request);
    sub_index_ = request[3];
  }

  /// Finds the entry and its right; `refusal` answers where the right is missing.
  [[nodiscard]] AbortCode find(entry::Word right, AbortCode refusal) {
    word_ = Device::dictionary.find(index_, sub_index_);
    if (word_ == Dictionary::no_object) return AbortCode::no_object;
    if (word_ == Dictionary::no_sub_index) return AbortCode::no_sub_index;
    return (word_ & right) != 0 ? ok : refusal;
  }

  [[nodiscard]] AbortCode initiate_upload(auto& hooks) {
    if (const AbortCode code = find(entry::readable, AbortCode::write_only); code != ok) return code;
    if (const AbortCode code = hooks.before_read(index_, sub_index_); code != ok) return code;
    const std::span<const std::uint8_t> bytes =
        hooks.entries().read(word_, std::span<std::uint8_t, 8>{buffer_.data(), 8});
    if (bytes.data() == nullptr) return AbortCode::no_data;
    const std::size_t size = bytes.size();
    if (size >= 1 && size <= 4) {
      const auto unused = static_cast<std::uint8_t>((4 - size) << 2);
      answer(Device::options.sdo_upload_size_indicated ? static_cast<std::uint8_t>(0x43 | unused) : std::uint8_t{0x42});
      std::memcpy(&reply_[4], bytes.data(), size);
      return ok;
    }
    source_ = bytes.data();
    if (entry::class_of(word_) != entry::Class::special && source_ != buffer_.data()) {
      std::memcpy(buffer_.data(), source_, size);
      source_ = buffer_.data();
    }
    left_ = static_cast<std::uint32_t>(size);
    state_ = State::uploading;
    answer(0x41);
    sdo::put_word(reply_, left_);
    return ok;
  }

  [[nodiscard]] AbortCode upload_segment(std::uint8_t command) {
    if (state_ != State::uploading) return AbortCode::command_specifier;
    if ((command & sdo::toggle) != toggle_) return AbortCode::toggle_bit;
    const std::uint32_t size = std::min<std::uint32_t>(left_, sdo::segment_bytes);
    clear_reply(static_cast<std::uint8_t>(toggle_ | ((sdo::segment_bytes - size) << 1)));
    if (size != 0) std::memcpy(&reply_[1], source_, size);
    source_ += size;
    left_ -= size;
    toggle_ ^= sdo::toggle;
    if (left_ == 0) {
      reply_[0] |= sdo::last_segment;
      state_ = State::idle;
    }
    return ok;
  }

  [[nodiscard]] AbortCode initiate_download(const std::array<std::uint8_t, 8>& request, auto& hooks) {
    if (const AbortCode code = find(entry::writable, AbortCode::read_only); code != ok) return code;
    const EntryAccess entries = hooks.entries();
    if (entry::is_domain(word_) && entries.domain(word_).data == nullptr) return AbortCode::not_stored;
    size_indicated_ = (request[0] & sdo::size_indicated) != 0;

    if ((request[0] & sdo::expedited) != 0) {
      std::size_t size = 4u - ((request[0] >> 2) & 3u);
      if (!size_indicated_)
        size = entry::wire_bytes(word_) == 0 ? 4u : std::min<std::size_t>(entry::wire_bytes(word_), 4);
      std::memcpy(buffer_.data(), &request[4], size);
      if (const AbortCode code = commit({buffer_.data(), size}, hooks); code != ok) return code;
    } else {
      if (const AbortCode code = prepare(sdo::word_of(request), entries); code != ok) return code;
    }
    answer(0x60);
    return ok;
  }

  /// Room for a segmented download: `left_` is what may still come.
  [[nodiscard]] AbortCode prepare(std::uint32_t announced, const EntryAccess& entries) {
    if (size_indicated_) {
      if (const AbortCode code = entries.check_length(index_, sub_index_, word_, announced); code != ok) return code;
      left_ = announced;
      if (!entry::is_domain(word_) && announced > buffer_bytes) return AbortCode::out_of_memory;
    } else {
      left_ = entries.longest(index_, sub_index_, word_);
    }
    if (entry::is_domain(word_)) entries.resize_domain(word_, 0);
    received_ = 0;
    state_ = State::downloading;
    return ok;
  }

  [[nodiscard]] AbortCode download_segment(const std::array<std::uint8_t, 8>& request, auto& hooks) {
    if (state_ != State::downloading) return AbortCode::command_specifier;
    if ((request[0] & sdo::toggle) != toggle_) return AbortCode::toggle_bit;
    const std::uint32_t size = sdo::segment_bytes - ((request[0] >> 1) & 7u);
    if (size > left_) return AbortCode::length_too_high;
    std::uint8_t* target = buffer_.data();
    if (entry::is_domain(word_)) {
      target = hooks.entries().domain(word_).data;
    } else if (received_ + size > buffer_bytes) {
      return AbortCode::out_of_memory;
    }
    if (size != 0) std::memcpy(target + received_, &request[1], size);
    received_ += size;
    left_ -= size;
    if ((request[0] & sdo::last_segment) != 0) {
      if (size_indicated_ && left_ != 0) return AbortCode::length_mismatch;
      state_ = State::idle;
      if (const AbortCode code = commit({target, received_}, hooks); code != ok) return code;
    }
    clear_reply(static_cast<std::uint8_t>(0x20 | toggle_));
    toggle_ ^= sdo::toggle;
    return ok;
  }

  [[nodiscard]] AbortCode commit(std::span<std::uint8_t> bytes, auto& hooks) {
    const EntryAccess entries = hooks.entries();
    if (const AbortCode code = entries.check(index_, sub_index_, word_, bytes); code != ok) return code;
    if (const AbortCode code = hooks.before_write(index_, sub_index_, bytes); code != ok) return code;
    entries.write(word_, bytes);
    hooks.after_write(index_, sub_index_);
    return ok;
  }

  void clear_reply(std::uint8_t command) {
    reply_ = {};
    reply_[0] = command;
    has_reply_ = true;
  }

  /// An answer that names the entry.
  void answer(std::uint8_t command) {
    clear_reply(command);
    sdo::put_multiplexer(reply_, index_, sub_index_);
  }

  void abort(AbortCode code) {
    state_ = State::idle;
    answer(sdo::abort_command);
    sdo::put_word(reply_, static_cast<std::uint32_t>(code));
  }

  struct NoTime {};

  alignas(4) std::array<std::uint8_t, 8> reply_{};
  alignas(4) std::array<std::uint8_t, buffer_bytes> buffer_{};
  const std::uint8_t* source_ = nullptr;  ///< upload: the next byte
  std::uint32_t left_ = 0;                ///< upload: bytes to send; download: bytes that may still come
  std::uint32_t received_ = 0;
  entry::Word word_ = 0;
  [[no_unique_address]] std::conditional_t<has_timeout, TimePoint, NoTime> last_request_{};
  std::uint16_t index_ = 0;
  std::uint8_t sub_index_ = 0;
  State state_ = State::idle;
  std::uint8_t toggle_ = 0;
  bool size_indicated_ = false;
  bool has_reply_ = false;
};

}  // namespace canopen
