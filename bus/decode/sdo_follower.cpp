#include "decode/sdo_follower.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/base/crc16.hpp>
#include <iterator>
#include <utility>

#include "device/entry_text.hpp"
#include "device/index_range.hpp"
#include "text/counted.hpp"
#include "values/append.hpp"
#include "values/little_endian.hpp"

namespace edsc {
namespace {

using canopen::sdo::ClientCommand;
using canopen::sdo::Data;
using canopen::sdo::ServerCommand;

/// For an unknown type: a number, a text, or bytes.
void append_untyped(std::string& text, std::span<const std::uint8_t> bytes) {
  constexpr auto row = [](canopen::DataType type) { return canopen::find_data_type(static_cast<std::uint32_t>(type)); };
  const auto printable = [](std::uint8_t c) { return c >= 0x20 && c < 0x7F; };
  if (bytes.size() == 1 || bytes.size() == 2 || bytes.size() == 4) {
    append_number(text, *row(canopen::DataType::unsigned32), number_of(bytes), static_cast<unsigned>(bytes.size()) * 8);
  } else if (!bytes.empty() && std::ranges::all_of(bytes, printable)) {
    append_value(text, *row(canopen::DataType::visible_string), bytes);
  } else {
    append_value(text, *row(canopen::DataType::domain), bytes);
  }
}

}  // namespace

std::string SdoFollower::description() const {
  std::string text = (download_ ? "write of " : "read of ") + label_;
  if (total_ > 0 && !expedited_) text += " after " + counted(total_, "byte");
  return text;
}

std::span<const std::uint8_t> SdoFollower::whole_value() const {
  if (!complete_ || kept_.size() != total_) return {};
  return kept_;
}

// Message texts

void SdoFollower::put_transfer(TransferStep transfer_step, Message& message) const {
  message.step = transfer_step;
  message.download = download_;
  message.index = index_;
  message.sub_index = sub_index_;
  message.size = total_;
}

/// `write 1008h:00 Manufacturer device name`, and what the frame does.
void SdoFollower::part(std::string_view what, const Step& step) const {
  step.message.text += download_ ? "write " : "read ";
  step.message.text += label_;
  step.message.text += what;
  put_transfer(TransferStep::part, step.message);
}

void SdoFollower::report(SdoFault fault, const Step& step) const {
  step.message.problem = true;
  step.message.fault = fault;
}

/// Whether the frame continues the transfer as expected; else reports it as a part of a transfer that is not known.
bool SdoFollower::continues(bool expected, std::string_view what, const Step& step) const {
  if (expected) return true;
  step.message.text += what;
  step.message.text += " of a transfer whose start is not in the log";
  if (begun_) step.message.fault = open() || step.message.from_client ? SdoFault::command : SdoFault::unrequested;
  return false;
}

void SdoFollower::put_duration(const Step& step) const {
  if (!start_ || !step.timed.has_time || step.timed.microseconds < *start_) return;
  step.message.duration_us = step.timed.microseconds - *start_;
  fmt::format_to(std::back_inserter(step.message.text), ", {}.{:03} ms", step.message.duration_us / 1000,
                 step.message.duration_us % 1000);
}

void SdoFollower::put_value(Message& message) const {
  MessageValue value;
  value.index = index_;
  value.sub_index = sub_index_;
  value.name = name_;
  value.type = entry_ != nullptr ? entry_->type : nullptr;
  if (entry_ != nullptr && entry_->meaning && kept_.size() == total_ && kept_.size() == bytes_for(entry_->type->bits)) {
    value.meaning = meaning_of_integer(*entry_);
    value.quantity = quantity_of(*entry_);
    value.other = model_->selector_of(*entry_);
  }
  value.bytes = kept_;
  value.text_begin = message.text.size();
  const bool maps = model_ != nullptr && contains(mapping_parameters, index_) && sub_index_ != 0 && kept_.size() == 4;
  if (const auto mapping = static_cast<std::uint32_t>(number_of(kept_)); maps && mapping != 0) {
    append_hex_number(message.text, mapping, 8);
    message.text += " " + model_->mapped_name(mapping);
  } else if (entry_ != nullptr) {
    append_device_value(message.text, model_->device(), *entry_, kept_, value.other);
  } else {
    append_untyped(message.text, kept_);
  }
  if (kept_.size() != total_) message.text += " ...";
  value.text_end = message.text.size();
  message.values.push_back(value);
}

void SdoFollower::put_bytes(std::uint32_t offset, std::uint32_t bytes, bool last, const Step& step) const {
  std::string what = bytes == 0 ? ", no bytes" : bytes == 1 ? ", byte " : ", bytes ";
  if (bytes > 0) append_decimal(what, offset);
  if (bytes > 1) {
    what += "..";
    append_decimal(what, offset + bytes - 1);
  }
  if (last) what += ", the last";
  part(what, step);
}

// Begin and end of a transfer

void SdoFollower::append(std::span<const std::uint8_t> bytes) {
  total_ += static_cast<std::uint32_t>(bytes.size());
  const std::size_t room = max_kept - std::min(kept_.size(), max_kept);
  const auto shown = bytes.first(std::min(room, bytes.size()));
  kept_.insert(kept_.end(), shown.begin(), shown.end());
  if (crc_used_) crc_ = canopen::crc16_ccitt(crc_, bytes);
}

void SdoFollower::begin(const Step& step, bool download, std::string_view how) {
  if (open()) {
    step.message.text += "(the " + description() + " was not finished) ";
    report(SdoFault::unfinished, step);
  }
  phase_ = Phase::asked;
  begun_ = true;
  download_ = download;
  expedited_ = last_seen_ = asked_ = toggle_ = holds_ = client_crc_ = crc_used_ = false;
  complete_ = true;
  start_ = step.timed.has_time ? std::optional{step.timed.microseconds} : std::nullopt;
  index_ = canopen::sdo::index_of(step.data);
  sub_index_ = step.data[3];
  announced_.reset();
  total_ = 0;
  crc_ = 0;
  kept_.clear();
  seen_.reset();
  highest_ = 0;
  model_ = step.model;
  const Object* object = model_ != nullptr ? model_->device().find(index_) : nullptr;
  entry_ = object != nullptr ? object->find(sub_index_) : nullptr;
  name_ = entry_ != nullptr ? display_name(*object, *entry_) : object != nullptr ? object->name : "";
  label_.clear();
  append_entry_label(label_, index_, sub_index_);
  if (!name_.empty()) label_ += " " + name_;
  part(how, step);
}

/// The number of bytes in the frame that initiates a transfer.
void SdoFollower::announce(bool has_size, const Step& step) {
  if (has_size) announced_ = canopen::sdo::word_of(step.data);
  if (!announced_) return;
  step.message.text += ", " + counted(*announced_, "byte") + (*announced_ == 1 ? " follows" : " follow");
}

void SdoFollower::finish(const Step& step) {
  Message& message = step.message;
  put_transfer(TransferStep::finished, message);
  message.text += (download_ ? "written " : "read ") + label_ + " = ";
  put_value(message);
  if (!expedited_) message.text += ", " + counted(total_, "byte");
  if (announced_ && *announced_ != total_ && !expedited_) {
    fmt::format_to(std::back_inserter(message.text), " of {} announced", *announced_);
    report(SdoFault::size, step);
  }
  if (!complete_) {
    message.text += ", not all of them in the log";
    report(SdoFault::sequence, step);
  }
  put_duration(step);
  phase_ = Phase::idle;
}

void SdoFollower::abort(const Step& step) {
  // The last segment of a block has the command of an abort in its upper bits, and a sequence number in the others.
  const bool is_exact = step.data[0] == canopen::sdo::abort_command;
  if (!continues(is_exact || begun_, "segment", step)) return;
  Message& message = step.message;
  message.abort_code = canopen::sdo::word_of(step.data);
  message.problem = true;
  message.text += "abort ";
  append_abort(message.text, message.abort_code);
  message.text += ", ";
  if (!open()) {
    message.step = TransferStep::aborted;
    message.index = canopen::sdo::index_of(step.data);
    message.sub_index = step.data[3];
    return append_entry_label(message.text, message.index, message.sub_index);
  }
  put_transfer(TransferStep::aborted, message);
  message.text += description();
  put_duration(step);
  phase_ = Phase::idle;
}

// Expedited and segmented transfer

/// If the frame does not state the length of the value, uses that of its type.
std::span<const std::uint8_t> SdoFollower::expedited_value(const Data& data) const {
  std::size_t bytes = 4;
  if ((data[0] & canopen::sdo::size_indicated) != 0) {
    bytes -= data[0] >> 2 & 3U;
  } else if (entry_ != nullptr && entry_->type->bits != 0) {
    bytes = std::min(bytes, bytes_for(entry_->type->bits));
  }
  return std::span{data}.subspan(4, bytes);
}

void SdoFollower::initiate_download(const Step& step) {
  begin(step, true);
  expedited_ = (step.data[0] & canopen::sdo::expedited) != 0;
  if (!expedited_) return announce((step.data[0] & canopen::sdo::size_indicated) != 0, step);
  append(expedited_value(step.data));
  step.message.size = total_;
  step.message.text += " = ";
  put_value(step.message);
}

void SdoFollower::upload_answer(const Step& step) {
  const Data& data = step.data;
  const bool other = canopen::sdo::index_of(data) != index_ || data[3] != sub_index_;
  if (phase_ != Phase::asked || download_ || other) {
    step.message.text += "response to a read of ";
    append_entry_label(step.message.text, canopen::sdo::index_of(data), data[3]);
    step.message.text += open() && other ? ", which was not requested" : " that is not in the log";
    step.message.problem = open();
    if (begun_) step.message.fault = open() ? SdoFault::command : SdoFault::unrequested;
    return;
  }
  expedited_ = (data[0] & canopen::sdo::expedited) != 0;
  if (expedited_) {
    append(expedited_value(data));
    return finish(step);
  }
  phase_ = Phase::segments;
  part("", step);
  announce((data[0] & canopen::sdo::size_indicated) != 0, step);
}

/// A data segment of either direction. One with the toggle bit of the last one is a repetition of it.
void SdoFollower::segment(const Step& step, bool from_client) {
  if (!continues(phase_ == Phase::segments && download_ == from_client, "segment", step)) return;
  const Data& data = step.data;
  const std::uint32_t bytes = canopen::sdo::segment_bytes - (data[0] >> 1 & 7U);
  const bool last = (data[0] & canopen::sdo::last_segment) != 0;
  if (((data[0] & canopen::sdo::toggle) != 0) != toggle_) {
    report(SdoFault::toggle, step);
    asked_ = from_client;
    return part(", a segment with the wrong toggle bit", step);
  }
  if (from_client == asked_) {
    report(from_client ? SdoFault::command : SdoFault::unrequested, step);
    if (from_client) return part(", a segment before the previous one is confirmed", step);
    step.message.text += "(not requested) ";
  }
  asked_ = from_client;
  put_bytes(total_, bytes, last, step);
  append(std::span{data}.subspan(1, bytes));
  step.message.size = total_;
  last_seen_ = last;
  if (!download_) toggle_ = !toggle_;
  if (download_ || !last) return;
  step.message.text += "; ";
  finish(step);
}

void SdoFollower::segment_requested(const Step& step) {
  if (!continues(phase_ == Phase::segments && !download_, "request for a segment", step)) return;
  const bool again = std::exchange(asked_, true);
  if (((step.data[0] & canopen::sdo::toggle) != 0) != toggle_) {
    report(SdoFault::toggle, step);
    return part(", next segment with the wrong toggle bit", step);
  }
  if (again) report(SdoFault::command, step);
  part(again ? ", next segment, before the response to the previous request" : ", next segment", step);
}

/// The confirmation of a segment by the server; the client confirms one of an upload by its next request.
void SdoFollower::segment_confirmed(const Step& step) {
  if (!continues(phase_ == Phase::segments && download_, "confirmation of a segment", step)) return;
  const bool right = ((step.data[0] & canopen::sdo::toggle) != 0) == toggle_;
  const bool sent = std::exchange(asked_, false);
  if (!right || !sent) report(right ? SdoFault::unrequested : SdoFault::toggle, step);
  part(!right ? ", segment confirmed with the wrong toggle bit"
       : sent ? ", segment confirmed"
              : ", a segment confirmed that was not sent",
       step);
  toggle_ = !toggle_;
  if (!last_seen_) return;
  step.message.text += "; ";
  finish(step);
}

// Frames

void SdoFollower::follow(const TimedFrame& timed, bool from_client, const NodeModel* model, Message& message) {
  const Step step{timed, timed.frame.data, model, message};
  const bool sends = phase_ == Phase::block_running || (phase_ == Phase::block_last && from_client);
  if (sends && download_ == from_client && step.data[0] != canopen::sdo::abort_command) return block_segment(step);
  return from_client ? request(step) : response(step);
}

void SdoFollower::request(const Step& step) {
  switch (canopen::sdo::client_command(step.data[0])) {
    case ClientCommand::download_segment: return segment(step, true);
    case ClientCommand::initiate_download: return initiate_download(step);
    case ClientCommand::initiate_upload: return begin(step, false);
    case ClientCommand::upload_segment: return segment_requested(step);
    case ClientCommand::abort: return abort(step);
    case ClientCommand::block_upload: return block_upload_command(step);
    case ClientCommand::block_download:
      return (step.data[0] & 1) == 0 ? initiate_block_download(step) : block_end(step);
    case ClientCommand::reserved: break;
  }
  step.message.text += "an unknown SDO request";
  report(SdoFault::command, step);
}

void SdoFollower::response(const Step& step) {
  switch (canopen::sdo::server_command(step.data[0])) {
    case ServerCommand::upload_segment: return segment(step, false);
    case ServerCommand::download_segment: return segment_confirmed(step);
    case ServerCommand::initiate_upload: return upload_answer(step);
    case ServerCommand::initiate_download:
      if (!continues(phase_ == Phase::asked && download_, "confirmation", step)) return;
      if (canopen::sdo::index_of(step.data) != index_ || step.data[3] != sub_index_) {
        step.message.text += "confirmation of a write of ";
        append_entry_label(step.message.text, canopen::sdo::index_of(step.data), step.data[3]);
        step.message.text += ", which was not requested";
        return report(SdoFault::command, step);
      }
      if (expedited_) return finish(step);
      phase_ = Phase::segments;
      return part(", ready for the segments", step);
    case ServerCommand::abort: return abort(step);
    case ServerCommand::block_download: return block_download_answer(step);
    case ServerCommand::block_upload: return block_upload_answer(step);
    case ServerCommand::reserved: break;
  }
  step.message.text += "an unknown SDO response";
  report(SdoFault::command, step);
}

}  // namespace edsc
