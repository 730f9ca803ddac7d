/// The block transfers of the model of an SDO server.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "sdo_server_model.hpp"

namespace model {

// ---- block download (7.2.4.3.9 to 7.2.4.3.11)

const char* SdoServer::block_download() {
  if ((q()[0] & 1) != 0) return block_download_end();
  begin();
  if (entry_ == nullptr) return aborts({missing_}, "no such object or sub-index");
  if (!entry_->writable) return aborts({read_only}, "0601 0002h: a read-only object is written");
  announced_.reset();
  if ((q()[0] & 2) != 0) {
    announced_ = word(q());
    if (const std::uint32_t code = length_error(*announced_); code != 0)
      return aborts({code}, "the length does not fit");
  }
  crc_ = (q()[0] & 4) != 0;
  // The server chooses the segments of a sub-block: 1..127.
  if (answers_.size() != 1 || answers_[0][4] < 1 || answers_[0][4] > 127) return "a block size is 1..127";
  start_sub_block(answers_[0][4]);
  last_arrived_ = false;
  return expect(frame(0xA4, block_size_), "a block download is confirmed: A4h, CRC supported");
}

void SdoServer::start_sub_block(std::uint8_t segments) {
  phase_ = Phase::block_download;
  block_size_ = segments;
  in_order_ = 0;
}

const char* SdoServer::block_download_segment() {
  const unsigned number = q()[0] & 0x7F;
  // 0 is not a sequence number, and a number above the block size cannot belong to this sub-block.
  if (number == 0 || number > block_size_) return aborts({sequence_number}, "0504 0003h: invalid sequence number");
  const bool last = (q()[0] & 0x80) != 0;
  if (number == in_order_ + 1) {
    ++in_order_;
    taken_.insert(taken_.end(), q().begin() + 1, q().end());
    last_arrived_ = last;
    // The last segment may have up to seven unused bytes.
    if (too_many(taken_.size() - (last ? 7 : 0)) && answers_abort())
      return aborts({too_long, length_mismatch}, "too many bytes");
  }
  // Segments after a gap are ignored; the confirmation at the end of the sub-block requests them again.
  if (!last && number != block_size_) return answers_.empty() ? nullptr : "segments of a sub-block are not answered";
  const unsigned confirmed = in_order_;
  if (answers_.size() != 1 || answers_[0][2] < 1 || answers_[0][2] > 127) return "a block size is 1..127";
  if (last_arrived_) {
    phase_ = Phase::block_download_end;
    block_size_ = answers_[0][2];
  } else {
    start_sub_block(answers_[0][2]);
  }
  return expect(Data{0xA2, static_cast<std::uint8_t>(confirmed), block_size_}, "a sub-block is confirmed");
}

const char* SdoServer::block_download_end() {
  if (phase_ != Phase::block_download_end) return unknown_command();
  Octets bytes(taken_.begin(), taken_.end() - (q()[0] >> 2 & 7));
  const bool crc_right = !crc_ || crc_of(bytes) == (q()[1] | q()[2] << 8);
  const std::uint32_t length = length_error(bytes.size());
  Code announced = 0;
  if (announced_ && bytes.size() != *announced_) announced = bytes.size() < *announced_ ? too_short : too_long;
  // If both the CRC and the length are wrong, either code is allowed.
  if (!crc_right && announced != 0) return aborts({crc_error, length_mismatch, announced}, "CRC and length");
  if (!crc_right && length != 0) return aborts({crc_error, length}, "CRC and length");
  if (!crc_right) return aborts({crc_error}, "0504 0004h: the CRC is wrong");
  if (announced != 0) return aborts({length_mismatch, announced}, "another length than announced");
  return take(bytes, Data{0xA1}, "the end of a block download is confirmed");
}

// ---- block upload (7.2.4.3.12 to 7.2.4.3.15)

const char* SdoServer::block_upload() {
  switch (q()[0] & 3) {
    case 0: return initiate_block_upload();
    case 1:
      if (phase_ != Phase::block_upload_end) return unknown_command();
      finish();
      return answers_.empty() ? nullptr : "the client's end is not answered";
    case 2: return confirm_block_upload();
    default:
      if (phase_ != Phase::block_upload_initiated) return unknown_command();
      return expect_sub_block();
  }
}

const char* SdoServer::initiate_block_upload() {
  begin();
  const bool size_right = q()[4] >= 1 && q()[4] <= 127;
  if (entry_ == nullptr || !entry_->readable) {
    const std::uint32_t code = entry_ == nullptr ? missing_ : write_only;
    return size_right ? aborts({code}, "what cannot be read") : aborts({code, block_size}, "what cannot be read");
  }
  if (!size_right) return aborts({block_size}, "0504 0002h: the block size is not 1..127");
  // Protocol switch threshold: a normal upload is allowed if the value is not longer. 0: not allowed.
  if (q()[5] != 0 && entry_->value.size() <= q()[5] && answers_.size() == 1 && answers_[0][0] >> 5 == 2)
    return answer_upload();
  if (entry_->value.empty() && answers_abort()) return aborts({no_data}, "0800 0024h: no data");
  crc_ = (q()[0] & 4) != 0;
  block_size_ = q()[4];
  position_ = 0;
  phase_ = Phase::block_upload_initiated;
  return expect(frame(0xC6, static_cast<std::uint32_t>(entry_->value.size())), "a block upload tells its size: C6h");
}

const char* SdoServer::expect_sub_block() {
  phase_ = Phase::block_upload_sent;
  const std::size_t size = entry_->value.size();
  std::size_t from = position_;
  for (in_order_ = 1;; ++in_order_) {
    const std::size_t length = std::min<std::size_t>(7, size - from);
    const bool last = from + length == size;
    Data segment{static_cast<std::uint8_t>(last ? in_order_ | 0x80 : in_order_)};
    copy_value(from, length, segment);
    if (answers_.size() < in_order_ || answers_[in_order_ - 1] != segment) return "a segment of a block upload";
    from += length;
    last_arrived_ = last;
    if (last || in_order_ == block_size_) break;
  }
  return answers_.size() == in_order_ ? nullptr : "no more segments than the block size";
}

const char* SdoServer::confirm_block_upload() {
  if (phase_ != Phase::block_upload_sent) return unknown_command();
  const unsigned confirmed = q()[1];
  const bool size_right = q()[2] >= 1 && q()[2] <= 127;
  if (confirmed > in_order_)
    return size_right ? aborts({sequence_number}, "0504 0003h: more segments confirmed than sent")
                      : aborts({sequence_number, block_size}, "more segments confirmed than sent");
  const std::size_t size = entry_->value.size();
  if (confirmed == in_order_ && last_arrived_) {
    // No sub-block follows: a server may or may not check its size.
    if (!size_right && answers_abort()) return aborts({block_size}, "0504 0002h");
    phase_ = Phase::block_upload_end;
    const std::size_t unused = size == 0 ? 7 : (7 - size % 7) % 7;
    const std::uint16_t crc = crc_ ? crc_of(entry_->value) : std::uint16_t{0};
    return expect(Data{static_cast<std::uint8_t>(0xC1 | unused << 2), static_cast<std::uint8_t>(crc),
                       static_cast<std::uint8_t>(crc >> 8)},
                  "the end of a block upload");
  }
  if (!size_right) return aborts({block_size}, "0504 0002h: the block size is not 1..127");
  block_size_ = q()[2];
  position_ += std::size_t{7} * confirmed;
  return expect_sub_block();
}

}  // namespace model
