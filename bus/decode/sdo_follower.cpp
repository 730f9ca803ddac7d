#include "decode/sdo_follower.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/base/abort_code.hpp>
#include <canopen/base/crc16.hpp>
#include <iterator>

#include "text/counted.hpp"
#include "values/append.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

using canopen::sdo::ClientCommand;
using canopen::sdo::Data;
using canopen::sdo::ServerCommand;

const char* noun(bool download) { return download ? "write of " : "read of "; }
const char* verb(bool download) { return download ? "write " : "read "; }

/// For an unknown type: a number, a text, or bytes.
void append_untyped(std::string& text, std::span<const std::uint8_t> bytes) {
  constexpr auto row = [](canopen::DataType type) { return canopen::find_data_type(static_cast<std::uint32_t>(type)); };
  const auto printable = [](std::uint8_t c) { return c >= 0x20 && c < 0x7F; };
  if (bytes.size() == 1 || bytes.size() == 2 || bytes.size() == 4) {
    std::uint64_t number = 0;
    for (std::size_t i = bytes.size(); i-- > 0;) number = number << 8 | bytes[i];
    append_number(text, *row(canopen::DataType::unsigned32), number, static_cast<unsigned>(bytes.size()) * 8);
  } else if (!bytes.empty() && std::ranges::all_of(bytes, printable)) {
    append_value(text, *row(canopen::DataType::visible_string), bytes);
  } else {
    append_value(text, *row(canopen::DataType::domain), bytes);
  }
}

void append_milliseconds(std::string& text, std::int64_t microseconds) {
  fmt::format_to(std::back_inserter(text), "{}.{:03} ms", microseconds / 1000, microseconds % 1000);
}

}  // namespace

std::string SdoFollower::description() const {
  std::string text = noun(download_) + label_;
  if (total_ > 0 && !expedited_) fmt::format_to(std::back_inserter(text), " after {}", counted(total_, "byte"));
  return text;
}

std::span<const std::uint8_t> SdoFollower::whole_value() const {
  if (!complete_ || kept_.size() != total_) return {};
  return kept_;
}

// Message texts

void SdoFollower::put_transfer(TransferStep step, Message& message) const {
  message.step = step;
  message.download = download_;
  message.index = index_;
  message.sub_index = sub_index_;
  message.size = total_;
}

void SdoFollower::put_duration(const TimedFrame& frame, Message& message) const {
  if (!has_start_ || !frame.has_time || frame.microseconds < start_) return;
  message.duration_us = frame.microseconds - start_;
  message.text += ", ";
  append_milliseconds(message.text, message.duration_us);
}

void SdoFollower::put_value(Message& message) const {
  MessageValue value;
  value.index = index_;
  value.sub_index = sub_index_;
  value.name = name_;
  value.type = entry_ != nullptr ? entry_->type : nullptr;
  value.unit = entry_ != nullptr ? entry_->unit : std::string_view{};
  value.bytes = kept_;
  value.text_begin = message.text.size();
  const std::uint32_t mapping = mapped_object();
  if (mapping != 0) {
    append_hex(message.text, mapping, 8);
    message.text += "h " + model_->mapped_name(mapping);
  } else if (drive_word_ != DriveWord::none && kept_.size() == 2) {
    append_drive_word(message.text, drive_word_, static_cast<std::uint16_t>(kept_[0] | kept_[1] << 8));
  } else if (entry_ != nullptr) {
    append_value(message.text, *entry_, kept_);
  } else {
    append_untyped(message.text, kept_);
  }
  if (kept_.size() != total_) message.text += " ...";
  value.text_end = message.text.size();
  message.values.push_back(value);
}

void SdoFollower::put_part(std::uint32_t offset, std::uint32_t bytes, bool last, Message& message) const {
  message.text += verb(download_);
  message.text += label_;
  if (bytes == 0) {
    message.text += ", no bytes";
  } else {
    message.text += bytes == 1 ? ", byte " : ", bytes ";
    append_decimal(message.text, offset);
    if (bytes > 1) message.text += "..";
    if (bytes > 1) append_decimal(message.text, offset + bytes - 1);
  }
  if (last) message.text += ", the last";
  put_transfer(TransferStep::part, message);
}

std::uint32_t SdoFollower::mapped_object() const {
  const bool rpdo = index_ >= 0x1600 && index_ <= 0x17FF, tpdo = index_ >= 0x1A00 && index_ <= 0x1BFF;
  if (model_ == nullptr || (!rpdo && !tpdo) || sub_index_ == 0 || kept_.size() != 4) return 0;
  return kept_[0] | std::uint32_t{kept_[1]} << 8 | std::uint32_t{kept_[2]} << 16 | std::uint32_t{kept_[3]} << 24;
}

void SdoFollower::stray(std::string_view what, Message& message) {
  message.text += what;
  message.text += " of a transfer whose start is not in the log";
}

// Data of a transfer

void SdoFollower::append(std::span<const std::uint8_t> bytes) {
  total_ += static_cast<std::uint32_t>(bytes.size());
  const std::size_t room = max_kept - std::min(kept_.size(), max_kept);
  const auto shown = bytes.first(std::min(room, bytes.size()));
  kept_.insert(kept_.end(), shown.begin(), shown.end());
  if (crc_used_) crc_ = canopen::crc16_ccitt(crc_, bytes);
}

void SdoFollower::begin(const TimedFrame& frame, const NodeModel* model, bool download, bool block, Message& message) {
  if (open()) {
    message.text += "(the " + description() + " was not finished) ";
    message.problem = true;
  }
  const Data& data = frame.frame.data;
  phase_ = Phase::asked;
  download_ = download;
  expedited_ = last_seen_ = toggle_ = holds_ = client_crc_ = crc_used_ = false;
  complete_ = true;
  has_start_ = frame.has_time;
  start_ = frame.microseconds;
  index_ = canopen::sdo::index_of(data);
  sub_index_ = data[3];
  announced_.reset();
  total_ = 0;
  crc_ = 0;
  kept_.clear();
  seen_.reset();
  highest_ = 0;
  const Object* object = model != nullptr ? model->device().find(index_) : nullptr;
  entry_ = object != nullptr ? object->find(sub_index_) : nullptr;
  model_ = model;
  drive_word_ = model != nullptr && model->profile() == 402 ? drive_word_at(index_, sub_index_) : DriveWord::none;
  name_ = entry_ != nullptr ? display_name(*object, *entry_) : object != nullptr ? object->name : "";
  label_.clear();
  append_entry_label(label_, index_, sub_index_);
  if (!name_.empty()) label_ += " " + name_;
  put_transfer(TransferStep::part, message);
  message.text += verb(download);
  message.text += label_;
  if (block) message.text += " by blocks";
}

void SdoFollower::finish(const TimedFrame& frame, Message& message) {
  put_transfer(TransferStep::finished, message);
  message.text += download_ ? "written " : "read ";
  message.text += label_;
  message.text += " = ";
  put_value(message);
  if (!expedited_) fmt::format_to(std::back_inserter(message.text), ", {}", counted(total_, "byte"));
  if (announced_ && *announced_ != total_ && !expedited_) {
    fmt::format_to(std::back_inserter(message.text), " of {} announced", *announced_);
    message.problem = true;
  }
  if (!complete_) {
    message.text += ", not all of them in the log";
    message.problem = true;
  }
  put_duration(frame, message);
  phase_ = Phase::idle;
}

void SdoFollower::abort(const TimedFrame& frame, Message& message) {
  const std::uint32_t code = canopen::sdo::word_of(frame.frame.data);
  message.abort_code = code;
  message.problem = true;
  message.text += "abort ";
  append_hex(message.text, code >> 16, 4);
  message.text += ' ';
  append_hex(message.text, code, 4);
  message.text += "h ";
  message.text += canopen::to_text(static_cast<canopen::AbortCode>(code));
  if (!open()) {
    message.text += ", ";
    append_entry_label(message.text, canopen::sdo::index_of(frame.frame.data), frame.frame.data[3]);
    message.step = TransferStep::aborted;
    message.index = canopen::sdo::index_of(frame.frame.data);
    message.sub_index = frame.frame.data[3];
    return;
  }
  put_transfer(TransferStep::aborted, message);
  message.text += ", " + description();
  put_duration(frame, message);
  phase_ = Phase::idle;
}

// Expedited and segmented transfer

/// If the frame does not state the length of the value, uses that of its type.
std::span<const std::uint8_t> SdoFollower::expedited_value(const Data& data) const {
  std::size_t bytes = 4;
  if ((data[0] & canopen::sdo::size_indicated) != 0) {
    bytes -= data[0] >> 2 & 3U;
  } else if (entry_ != nullptr && entry_->type->bits != 0) {
    bytes = std::min<std::size_t>(bytes, (entry_->type->bits + 7U) / 8U);
  }
  return std::span{data}.subspan(4, bytes);
}

void SdoFollower::initiate_download(const TimedFrame& frame, const NodeModel* model, Message& message) {
  begin(frame, model, true, false, message);
  const Data& data = frame.frame.data;
  const bool sized = (data[0] & canopen::sdo::size_indicated) != 0;
  expedited_ = (data[0] & canopen::sdo::expedited) != 0;
  if (!expedited_) {
    if (sized) announced_ = canopen::sdo::word_of(data);
    if (announced_)
      fmt::format_to(std::back_inserter(message.text), ", {} {}", counted(*announced_, "byte"),
                     *announced_ == 1 ? "follows" : "follow");
    return;
  }
  append(expedited_value(data));
  message.size = total_;
  message.text += " = ";
  put_value(message);
}

void SdoFollower::upload_answer(const TimedFrame& frame, Message& message) {
  const Data& data = frame.frame.data;
  const bool other = canopen::sdo::index_of(data) != index_ || data[3] != sub_index_;
  if (phase_ != Phase::asked || download_ || other) {
    message.text += "response to a read of ";
    append_entry_label(message.text, canopen::sdo::index_of(data), data[3]);
    message.text += open() && other ? ", which was not requested" : " that is not in the log";
    message.problem = open();
    return;
  }
  const bool sized = (data[0] & canopen::sdo::size_indicated) != 0;
  expedited_ = (data[0] & canopen::sdo::expedited) != 0;
  if (expedited_) {
    append(expedited_value(data));
    return finish(frame, message);
  }
  phase_ = Phase::segments;
  if (sized) announced_ = canopen::sdo::word_of(data);
  put_transfer(TransferStep::part, message);
  message.text += verb(false) + label_;
  if (announced_)
    fmt::format_to(std::back_inserter(message.text), ", {} {}", counted(*announced_, "byte"),
                   *announced_ == 1 ? "follows" : "follow");
}

/// A data segment of either direction. One with the toggle bit of the last one is a repetition of it.
void SdoFollower::segment(const TimedFrame& frame, bool from_client, Message& message) {
  if (phase_ != Phase::segments || download_ != from_client) return stray("segment", message);
  const Data& data = frame.frame.data;
  const std::uint32_t bytes = canopen::sdo::segment_bytes - (data[0] >> 1 & 7U);
  const bool last = (data[0] & canopen::sdo::last_segment) != 0;
  const bool toggle = (data[0] & canopen::sdo::toggle) != 0;
  if (toggle != toggle_) {
    message.text += verb(download_) + label_ + ", a segment with the wrong toggle bit";
    message.problem = true;
    return put_transfer(TransferStep::part, message);
  }
  put_part(total_, bytes, last, message);
  append(std::span{data}.subspan(1, bytes));
  message.size = total_;
  last_seen_ = last;
  if (!download_) toggle_ = !toggle_;
  if (download_ || !last) return;
  message.text += "; ";
  finish(frame, message);
}

/// The confirmation of a segment: of a download by the server; of an upload by the client's next request.
void SdoFollower::segment_confirmed(const TimedFrame& frame, bool last, Message& message) {
  message.text += verb(download_) + label_ + ", segment confirmed";
  put_transfer(TransferStep::part, message);
  toggle_ = !toggle_;
  if (!last) return;
  message.text += "; ";
  finish(frame, message);
}

// Block transfer

void SdoFollower::initiate_block_download(const TimedFrame& frame, const NodeModel* model, Message& message) {
  begin(frame, model, true, true, message);
  const Data& data = frame.frame.data;
  client_crc_ = (data[0] & canopen::sdo::crc_supported) != 0;
  if ((data[0] & canopen::sdo::block_size_indicated) != 0) announced_ = canopen::sdo::word_of(data);
  if (announced_)
    fmt::format_to(std::back_inserter(message.text), ", {} {}", counted(*announced_, "byte"),
                   *announced_ == 1 ? "follows" : "follow");
}

void SdoFollower::initiate_block_upload(const TimedFrame& frame, const NodeModel* model, Message& message) {
  begin(frame, model, false, true, message);
  const Data& data = frame.frame.data;
  client_crc_ = (data[0] & canopen::sdo::crc_supported) != 0;
  fmt::format_to(std::back_inserter(message.text), ", {} in a block", counted(unsigned{data[4]}, "segment"));
}

void SdoFollower::block_segment(const Data& data, Message& message) {
  const auto sequence = static_cast<std::uint8_t>(data[0] & canopen::sdo::sequence_mask);
  const bool last = (data[0] & canopen::sdo::last_block_segment) != 0;
  if (sequence == 0) {
    message.text += verb(download_) + label_ + ", a segment with the sequence number 0";
    message.problem = true;
    return;
  }
  const std::size_t at = (sequence - 1U) * segment_bytes;
  std::copy_n(data.begin() + 1, segment_bytes, block_.begin() + static_cast<std::ptrdiff_t>(at));
  seen_.set(sequence);
  highest_ = std::max(highest_, sequence);
  const std::uint32_t before = total_ + (holds_ ? canopen::sdo::segment_bytes : 0U);
  put_part(before + static_cast<std::uint32_t>(at), canopen::sdo::segment_bytes, last, message);
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
void SdoFollower::block_confirmed(const Data& data, Message& message) {
  const std::uint8_t taken = std::min(data[1], canopen::sdo::largest_block);
  for (unsigned sequence = 1; sequence <= taken; ++sequence) {
    flush_held(segment_bytes);
    std::copy_n(block_.begin() + static_cast<std::ptrdiff_t>((sequence - 1) * segment_bytes), segment_bytes,
                held_.begin());
    holds_ = true;
    if (!seen_.test(sequence)) complete_ = false;
  }
  message.text += verb(download_) + label_;
  fmt::format_to(std::back_inserter(message.text), ", confirmed up to segment {}", taken);
  if (taken < highest_) {
    fmt::format_to(std::back_inserter(message.text), " of {}; the others are repeated", highest_);
    message.problem = true;
  }
  const bool all = last_seen_ && taken >= highest_;
  if (!all) last_seen_ = false;
  phase_ = all ? Phase::block_ending : Phase::block_running;
  seen_.reset();
  highest_ = 0;
  put_transfer(TransferStep::part, message);
}

/// The sender states the used bytes of the last segment, and the CRC.
void SdoFollower::block_end(const Data& data, Message& message) {
  const std::size_t unused = data[0] >> 2 & 7U;
  flush_held(segment_bytes - unused);
  const auto crc = static_cast<std::uint16_t>(data[1] | data[2] << 8);
  message.text += verb(download_) + label_ + ", end of the blocks";
  put_transfer(TransferStep::part, message);
  if (crc_used_ && complete_ && crc != crc_) {
    fmt::format_to(std::back_inserter(message.text), ", wrong CRC {:04X}h, expected {:04X}h", crc, crc_);
    message.problem = true;
  }
  phase_ = Phase::block_ended;
}

void SdoFollower::block_upload_command(const TimedFrame& frame, const NodeModel* model, Message& message) {
  using canopen::sdo::BlockUpload;
  const Data& data = frame.frame.data;
  switch (static_cast<BlockUpload>(data[0] & 3)) {
    case BlockUpload::initiate: return initiate_block_upload(frame, model, message);
    case BlockUpload::start:
      if (phase_ != Phase::block_answered) return stray("start of the blocks", message);
      phase_ = Phase::block_running;
      message.text += verb(false) + label_ + ", start of the blocks";
      return put_transfer(TransferStep::part, message);
    case BlockUpload::confirm:
      if (phase_ != Phase::block_running && phase_ != Phase::block_last) return stray("confirmation", message);
      return block_confirmed(data, message);
    case BlockUpload::end:
      if (phase_ != Phase::block_ended) return stray("end", message);
      return finish(frame, message);
  }
}

void SdoFollower::block_download_answer(const TimedFrame& frame, Message& message) {
  const Data& data = frame.frame.data;
  switch (data[0] & 3) {
    case 0:
      if (phase_ != Phase::asked || !download_) return stray("answer", message);
      crc_used_ = client_crc_ && (data[0] & canopen::sdo::crc_supported) != 0;
      phase_ = Phase::block_running;
      message.text += verb(true) + label_;
      fmt::format_to(std::back_inserter(message.text), ", {} in a block", counted(unsigned{data[4]}, "segment"));
      return put_transfer(TransferStep::part, message);
    case 1:
      if (phase_ != Phase::block_ended) return stray("end", message);
      return finish(frame, message);
    case 2:
      if (phase_ != Phase::block_running && phase_ != Phase::block_last) return stray("confirmation", message);
      return block_confirmed(data, message);
    default: message.text += "an unknown SDO response"; message.problem = true;
  }
}

void SdoFollower::block_upload_answer(const TimedFrame& frame, Message& message) {
  const Data& data = frame.frame.data;
  if ((data[0] & 1) != 0) {
    if (phase_ != Phase::block_ending) return stray("end", message);
    return block_end(data, message);
  }
  if (phase_ != Phase::asked || download_) return stray("answer", message);
  crc_used_ = client_crc_ && (data[0] & canopen::sdo::crc_supported) != 0;
  if ((data[0] & canopen::sdo::block_size_indicated) != 0) announced_ = canopen::sdo::word_of(data);
  phase_ = Phase::block_answered;
  message.text += verb(false) + label_;
  if (announced_)
    fmt::format_to(std::back_inserter(message.text), ", {} {}", counted(*announced_, "byte"),
                   *announced_ == 1 ? "follows" : "follow");
  put_transfer(TransferStep::part, message);
}

// Frames

void SdoFollower::request(const TimedFrame& frame, const NodeModel* model, Message& message) {
  const Data& data = frame.frame.data;
  const bool in_block = download_ && (phase_ == Phase::block_running || phase_ == Phase::block_last);
  if (in_block && data[0] != canopen::sdo::abort_command) return block_segment(data, message);
  switch (canopen::sdo::client_command(data[0])) {
    case ClientCommand::download_segment: return segment(frame, true, message);
    case ClientCommand::initiate_download: return initiate_download(frame, model, message);
    case ClientCommand::initiate_upload: return begin(frame, model, false, false, message);
    case ClientCommand::upload_segment:
      if (phase_ != Phase::segments || download_) return stray("request for a segment", message);
      message.text += verb(false) + label_ + ", next segment";
      return put_transfer(TransferStep::part, message);
    case ClientCommand::abort: return abort(frame, message);
    case ClientCommand::block_upload: return block_upload_command(frame, model, message);
    case ClientCommand::block_download:
      if ((data[0] & 1) == 0) return initiate_block_download(frame, model, message);
      if (phase_ != Phase::block_ending) return stray("end", message);
      return block_end(data, message);
    case ClientCommand::reserved: break;
  }
  message.text += "an unknown SDO request";
  message.problem = true;
}

void SdoFollower::response(const TimedFrame& frame, const NodeModel*, Message& message) {
  const Data& data = frame.frame.data;
  const bool in_block = !download_ && phase_ == Phase::block_running;
  if (in_block && data[0] != canopen::sdo::abort_command) return block_segment(data, message);
  switch (canopen::sdo::server_command(data[0])) {
    case ServerCommand::upload_segment: return segment(frame, false, message);
    case ServerCommand::download_segment:
      if (phase_ != Phase::segments || !download_) return stray("confirmation of a segment", message);
      return segment_confirmed(frame, last_seen_, message);
    case ServerCommand::initiate_upload: return upload_answer(frame, message);
    case ServerCommand::initiate_download:
      if (phase_ != Phase::asked || !download_) return stray("confirmation", message);
      if (expedited_) return finish(frame, message);
      phase_ = Phase::segments;
      message.text += verb(true) + label_ + ", ready for the segments";
      return put_transfer(TransferStep::part, message);
    case ServerCommand::abort: return abort(frame, message);
    case ServerCommand::block_download: return block_download_answer(frame, message);
    case ServerCommand::block_upload: return block_upload_answer(frame, message);
    case ServerCommand::reserved: break;
  }
  message.text += "an unknown SDO response";
  message.problem = true;
}

}  // namespace edsc
