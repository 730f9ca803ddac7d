/// Block upload and block download of an SDO client (CiA 301, 7.2.4.3.9 to 7.2.4.3.16).
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/crc16.hpp"
#include "canopen/base/result.hpp"
#include "canopen/sdo/sdo_client_value.hpp"
#include "canopen/sdo/sdo_protocol.hpp"
#include "canopen/sdo/sdo_transfer.hpp"

namespace canopen {

/// The numbering, the repetition and the CRC of the segments of one block transfer. Requests have their command byte
/// when they are passed. An abort code other than `ok` ends the transfer.
class SdoClientBlocks {
 public:
  void begin() {
    crc_ = 0;
    sequence_ = 0;
    repeated_ = 0;
    unused_ = 0;
    failures_ = 0;
  }

  /// The server has accepted the initiate request with this command byte.
  void initiated(std::uint8_t command, const SdoClientOptions& options) {
    checked_ = options.crc && (command & sdo::crc_supported) != 0;
  }

  // Upload

  [[nodiscard]] static bool is_last(const sdo::Data& segment) { return (segment[0] & sdo::last_block_segment) != 0; }
  [[nodiscard]] static std::uint8_t sequence_of(const sdo::Data& segment) {
    return static_cast<std::uint8_t>(segment[0] & sdo::sequence_mask);
  }

  /// Whether a segment is the next one in sequence. Others are only checked for the end of their sub-block.
  [[nodiscard]] bool is_next(const sdo::Data& segment) const { return sequence_of(segment) == sequence_ + 1; }

  /// Accepts the next segment in sequence. The last one is held until the end of the transfer indicates how many of its
  /// bytes are valid.
  [[nodiscard]] AbortCode take(const sdo::Data& segment, SdoClientValue& value) {
    if (is_last(segment)) {
      std::memcpy(last_segment_.data(), &segment[1], last_segment_.size());
    } else {
      if (const AbortCode code = value.take(&segment[1], sdo::segment_bytes, false); code != ok) return code;
      add_to_crc(&segment[1], sdo::segment_bytes);
    }
    sequence_ = sequence_of(segment);
    return ok;
  }

  /// Whether a sub-block has been received in part.
  [[nodiscard]] bool sub_block_begun() const { return sequence_ != 0; }

  /// Confirms the segments that have been received in sequence; the server repeats the others.
  [[nodiscard]] AbortCode confirm_sub_block(sdo::Data& request, const SdoClientOptions& options) {
    if (const AbortCode code = count_failure(sequence_ == 0, options); code != ok) return code;
    request[1] = sequence_;
    request[2] = options.block_size;
    sequence_ = 0;
    return ok;
  }

  /// Accepts the end of an upload, with the CRC.
  [[nodiscard]] AbortCode end_upload(const sdo::Data& answer, SdoClientValue& value) {
    const std::uint32_t size = sdo::segment_bytes - ((answer[0] >> 2) & 7u);
    add_to_crc(last_segment_.data(), size);
    if (checked_ && std::memcmp(&answer[1], &crc_, sizeof crc_) != 0) return AbortCode::crc;
    return value.take(last_segment_.data(), size, true);
  }

  // Download

  /// Starts a sub-block of this many segments.
  [[nodiscard]] AbortCode begin_sub_block(std::uint8_t size) {
    if (size == 0 || size > sdo::largest_block) return AbortCode::block_size;
    block_size_ = size;
    sequence_ = 0;
    return ok;
  }

  /// Whether the sub-block has a further segment to send.
  [[nodiscard]] bool has_segment(const SdoClientValue& value) const {
    return !value.is_sent() && sequence_ != block_size_;
  }

  /// Makes a request the next segment.
  [[nodiscard]] AbortCode put_segment(sdo::Data& request, SdoClientValue& value) {
    request[0] = ++sequence_;
    const Result<std::uint32_t> size = value.fetch(request);
    if (!size) return size.abort_code();
    if (value.is_sent()) {
      request[0] |= sdo::last_block_segment;
      unused_ = static_cast<std::uint8_t>(sdo::segment_bytes - *size);
    }
    if (repeated_ != 0) {
      --repeated_;
    } else {
      add_to_crc(&request[1], *size);
    }
    return ok;
  }

  /// Whether a confirmation shows that the server has received all segments of the value.
  [[nodiscard]] bool is_complete(const sdo::Data& confirmation, const SdoClientValue& value) const {
    return confirmation[1] == sequence_ && value.is_sent();
  }

  /// Makes a request the end of a download, with the CRC.
  void put_end(sdo::Data& request) const {
    request[0] = static_cast<std::uint8_t>(sdo::block_download_end | (unused_ << 2));
    if (checked_) std::memcpy(&request[1], &crc_, sizeof crc_);
  }

  /// The server has received the first segments of the sub-block. The missing ones are sent again, in the next
  /// sub-block.
  [[nodiscard]] AbortCode sub_block_confirmed(const sdo::Data& confirmation, SdoClientValue& value,
                                              const SdoClientOptions& options) {
    if (confirmation[1] > sequence_) return AbortCode::sequence_number;
    const auto lost = static_cast<std::uint8_t>(sequence_ - confirmation[1]);
    if (const AbortCode code = count_failure(confirmation[1] == 0, options); code != ok) return code;
    if (lost != 0) {
      value.step_back(lost * sdo::segment_bytes - unused_);
      repeated_ = static_cast<std::uint8_t>(repeated_ + lost);
      unused_ = 0;
    }
    return begin_sub_block(confirmation[2]);
  }

 private:
  /// Counts consecutive sub-blocks without progress. 0504 0003h: there are too many.
  [[nodiscard]] AbortCode count_failure(bool failed, const SdoClientOptions& options) {
    failures_ = failed ? static_cast<std::uint8_t>(failures_ + 1) : std::uint8_t{0};
    return failures_ <= options.block_retries ? ok : AbortCode::sequence_number;
  }

  void add_to_crc(const std::uint8_t* bytes, std::uint32_t size) {
    for (std::uint32_t i = 0; i < size; ++i) crc_ = crc16_ccitt(crc_, bytes[i]);
  }

  std::uint16_t crc_ = 0;
  std::uint8_t block_size_ = 0;  ///< download: segments of this sub-block
  std::uint8_t sequence_ = 0;    ///< of the last segment
  std::uint8_t repeated_ = 0;    ///< download: next segments that the CRC already includes
  std::uint8_t unused_ = 0;      ///< download: unused bytes of the last segment
  std::uint8_t failures_ = 0;
  bool checked_ = false;                                         ///< the CRC is used
  std::array<std::uint8_t, sdo::segment_bytes> last_segment_{};  ///< upload: until its valid bytes are known
};

}  // namespace canopen
