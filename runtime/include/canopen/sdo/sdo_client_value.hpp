/// The value that an SDO client transfers: its bytes in memory of the caller, or a sink or source for them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/result.hpp"
#include "canopen/sdo/sdo_protocol.hpp"
#include "canopen/sdo/sdo_transfer.hpp"

namespace canopen {

/// Knows how many bytes have been transferred, and how many there are, if that is known.
class SdoClientValue {
 public:
  /// Makes this the destination of an upload.
  constexpr void upload_to(std::span<std::uint8_t> memory) {
    memory_ = memory;
    sink_ = {};
    size_ = sdo::unknown_size;
  }
  constexpr void upload_to(const SdoSink& sink) {
    memory_ = {};
    sink_ = sink;
    size_ = sdo::unknown_size;
  }

  /// Makes this the source of a download.
  constexpr void download_from(std::span<const std::uint8_t> bytes) {
    memory_ = {};
    bytes_ = bytes;
    source_ = {};
    size_ = static_cast<std::uint32_t>(bytes.size());
  }
  constexpr void download_from(const SdoSource& source) {
    memory_ = {};
    bytes_ = {};
    source_ = source;
    size_ = source.size;
  }

  /// Starts with the first byte.
  void rewind() {
    position_ = 0;
    last_ = false;
  }

  /// Returns the number of bytes of the value; `unknown_size` if it is unknown.
  [[nodiscard]] std::uint32_t size() const { return size_; }
  [[nodiscard]] bool size_known() const { return size_ != sdo::unknown_size; }
  /// Returns the number of bytes that have been transferred.
  [[nodiscard]] std::uint32_t position() const { return position_; }

  // Upload

  /// Sets the size that the server announces. 0504 0005h: the memory is smaller.
  [[nodiscard]] AbortCode announce(std::uint32_t size) {
    size_ = size;
    return sink_.take != nullptr || size_ <= memory_.size() ? ok : AbortCode::out_of_memory;
  }

  /// Accepts an expedited value of four bytes, of which the first ones may be meant, as the server does not indicate
  /// how many: as many as there is memory for.
  [[nodiscard]] AbortCode take_expedited(const std::uint8_t* from) {
    std::uint32_t size = 4;
    if (sink_.take == nullptr) size = std::min<std::uint32_t>(size, static_cast<std::uint32_t>(memory_.size()));
    return take(from, size, true);
  }
  /// The same for a value whose size is indicated.
  [[nodiscard]] AbortCode take_expedited(const std::uint8_t* from, std::uint32_t size) {
    size_ = size;
    return take(from, size, true);
  }

  /// Accepts the next bytes of an upload.
  [[nodiscard]] AbortCode take(const std::uint8_t* from, std::uint32_t size, bool last) {
    AbortCode code = ok;
    if (size_known() && size > size_ - position_) {
      code = AbortCode::length_too_high;
    } else if (last && size_known() && position_ + size != size_) {
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
    if (code == ok) position_ += size;
    return code;
  }

  /// Returns the bytes that have been uploaded into memory; empty after a download.
  [[nodiscard]] std::span<const std::uint8_t> uploaded() const {
    return memory_.empty() ? memory_ : memory_.first(position_);
  }

  // Download

  /// Whether the value fits into an expedited request.
  [[nodiscard]] bool is_short() const { return source_.give == nullptr && size_ >= 1 && size_ <= 4; }

  /// Writes a short value to a request.
  void fetch_expedited(sdo::Data& request) {
    std::memcpy(&request[4], bytes_.data(), size_);
    last_ = true;
  }

  /// Writes the next bytes of a download after the command byte, and returns their number; an abort code if the source
  /// ends the transfer.
  [[nodiscard]] Result<std::uint32_t> fetch(sdo::Data& request) {
    std::uint32_t size = std::min(size_ - position_, sdo::segment_bytes);
    if (source_.give != nullptr) {
      const Result<std::uint32_t> count = source_.give(source_.context, position_, std::span{request}.subspan(1, size));
      if (!count) return count.abort_code();
      if (*count > size || (size_known() && *count != size)) return AbortCode::no_data;
      last_ = size_known() ? position_ + size == size_ : *count != size;
      size = *count;
    } else {
      if (size != 0) std::memcpy(&request[1], &bytes_[position_], size);
      last_ = position_ + size == size_;
    }
    position_ += size;
    return size;
  }

  /// Whether `fetch` has returned all bytes.
  [[nodiscard]] bool is_sent() const { return last_; }

  /// Makes `fetch` return the last bytes again.
  void step_back(std::uint32_t bytes) {
    position_ -= bytes;
    last_ = false;
  }

 private:
  std::span<std::uint8_t> memory_{};       ///< upload: destination
  std::span<const std::uint8_t> bytes_{};  ///< download: source
  SdoSink sink_{};
  SdoSource source_{};
  std::uint32_t size_ = sdo::unknown_size;
  std::uint32_t position_ = 0;
  bool last_ = false;  ///< download: no more bytes follow
};

}  // namespace canopen
