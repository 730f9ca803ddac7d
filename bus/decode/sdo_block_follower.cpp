/// Block transfer (CiA 301, 7.2.4.3.8 to 7.2.4.3.16).
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "decode/sdo_follower.hpp"
#include "text/counted.hpp"

namespace edsc {

using canopen::sdo::Data;

void SdoFollower::initiate_block_download(const Step& step) {
  begin(step, true, " by blocks");
  client_crc_ = (step.data[0] & canopen::sdo::crc_supported) != 0;
  announce((step.data[0] & canopen::sdo::block_size_indicated) != 0, step);
}

void SdoFollower::initiate_block_upload(const Step& step) {
  begin(step, false, " by blocks");
  client_crc_ = (step.data[0] & canopen::sdo::crc_supported) != 0;
  step.message.text += ", " + counted(unsigned{step.data[4]}, "segment") + " in a block";
}

void SdoFollower::block_segment(const Step& step) {
  const auto sequence = static_cast<std::uint8_t>(step.data[0] & canopen::sdo::sequence_mask);
  const bool last = (step.data[0] & canopen::sdo::last_block_segment) != 0;
  if (sequence == 0) {
    step.message.text += (download_ ? "write " : "read ") + label_ + ", a segment with the sequence number 0";
    report(SdoFault::sequence, step);
    return;
  }
  if (sequence != highest_ + 1) step.message.fault = SdoFault::sequence;
  const std::size_t at = (sequence - 1U) * segment_bytes;
  std::copy_n(step.data.begin() + 1, segment_bytes, block_.begin() + static_cast<std::ptrdiff_t>(at));
  seen_.set(sequence);
  highest_ = std::max(highest_, sequence);
  const std::uint32_t before = total_ + (holds_ ? canopen::sdo::segment_bytes : 0U);
  put_bytes(before + static_cast<std::uint32_t>(at), canopen::sdo::segment_bytes, last, step);
  if (last) {
    last_seen_ = true;
    highest_ = sequence;
    phase_ = Phase::block_last;
  }
}

void SdoFollower::flush_held(std::size_t bytes) {
  if (holds_) append(std::span{held_}.first(bytes));
  holds_ = false;
}

/// The receiver has confirmed the segments up to a sequence number; those after it are repeated.
void SdoFollower::block_confirmed(const Step& step) {
  if (!continues(phase_ == Phase::block_running || phase_ == Phase::block_last, "confirmation", step)) return;
  const std::uint8_t taken = std::min(step.data[1], canopen::sdo::largest_block);
  for (unsigned sequence = 1; sequence <= taken; ++sequence) {
    flush_held(segment_bytes);
    std::copy_n(block_.begin() + static_cast<std::ptrdiff_t>((sequence - 1) * segment_bytes), segment_bytes,
                held_.begin());
    holds_ = true;
    if (!seen_.test(sequence)) complete_ = false;
  }
  std::string what = fmt::format(", confirmed up to segment {}", taken);
  if (taken < highest_) {
    fmt::format_to(std::back_inserter(what), " of {}; the others are repeated", highest_);
    step.message.problem = true;
  } else if (taken > highest_) {
    step.message.fault = SdoFault::sequence;
  }
  part(what, step);
  const bool all = last_seen_ && taken >= highest_;
  if (!all) last_seen_ = false;
  phase_ = all ? Phase::block_ending : Phase::block_running;
  seen_.reset();
  highest_ = 0;
}

/// The sender states the used bytes of the last segment, and the CRC.
void SdoFollower::block_end(const Step& step) {
  if (!continues(phase_ == Phase::block_ending, "end", step)) return;
  const Data& data = step.data;
  const std::size_t unused = data[0] >> 2 & 7U;
  flush_held(segment_bytes - unused);
  const auto crc = static_cast<std::uint16_t>(data[1] | data[2] << 8);
  part(", end of the blocks", step);
  if (crc_used_ && complete_ && crc != crc_) {
    fmt::format_to(std::back_inserter(step.message.text), ", wrong CRC {:04X}h, expected {:04X}h", crc, crc_);
    report(SdoFault::crc, step);
  }
  phase_ = Phase::block_ended;
}

void SdoFollower::block_upload_command(const Step& step) {
  using canopen::sdo::BlockUpload;
  switch (static_cast<BlockUpload>(step.data[0] & 3)) {
    case BlockUpload::initiate: return initiate_block_upload(step);
    case BlockUpload::start:
      if (!continues(phase_ == Phase::block_answered, "start of the blocks", step)) return;
      phase_ = Phase::block_running;
      return part(", start of the blocks", step);
    case BlockUpload::confirm: return block_confirmed(step);
    case BlockUpload::end:
      if (continues(phase_ == Phase::block_ended, "end", step)) finish(step);
      return;
  }
}

void SdoFollower::block_download_answer(const Step& step) {
  switch (step.data[0] & 3) {
    case 0:
      if (!continues(phase_ == Phase::asked && download_, "answer", step)) return;
      crc_used_ = client_crc_ && (step.data[0] & canopen::sdo::crc_supported) != 0;
      phase_ = Phase::block_running;
      return part(", " + counted(unsigned{step.data[4]}, "segment") + " in a block", step);
    case 1:
      if (continues(phase_ == Phase::block_ended, "end", step)) finish(step);
      return;
    case 2: return block_confirmed(step);
    default: step.message.text += "an unknown SDO response"; report(SdoFault::command, step);
  }
}

void SdoFollower::block_upload_answer(const Step& step) {
  if ((step.data[0] & 1) != 0) return block_end(step);
  if (!continues(phase_ == Phase::asked && !download_, "answer", step)) return;
  crc_used_ = client_crc_ && (step.data[0] & canopen::sdo::crc_supported) != 0;
  phase_ = Phase::block_answered;
  part("", step);
  announce((step.data[0] & canopen::sdo::block_size_indicated) != 0, step);
}

}  // namespace edsc
