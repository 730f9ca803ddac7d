/// SDO access of a case: transfers by the client of edsc, and single frames.
#include <fmt/format.h>

#include <algorithm>
#include <canopen/sdo/sdo_client.hpp>

#include "conform/dut/dut.hpp"
#include "values/little_endian.hpp"

namespace edsc::conform {

namespace sdo = canopen::sdo;

LiveEntry Dut::live(std::uint16_t index, std::uint8_t sub_index) const { return live_entry(&sheet_, index, sub_index); }

SdoOutcome Dut::upload(std::uint16_t index, std::uint8_t sub_index, SdoTransfer transfer) {
  return edsc::upload(sdo_, live(index, sub_index), transfer);
}

SdoOutcome Dut::download(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value,
                         SdoTransfer transfer) {
  remember(index, sub_index);
  return sdo_.download(index, sub_index, value, transfer);
}

SdoOutcome Dut::download(std::uint16_t index, std::uint8_t sub_index, std::uint64_t number) {
  return download(index, sub_index, bytes_of(index, sub_index, number));
}

SdoOutcome Dut::command(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value) {
  constexpr unsigned to_store_ms = 5000;  // a device may erase a page of flash before it answers
  sdo_.set_timeout(std::max(settings_.sdo.timeout_ms, to_store_ms));
  SdoOutcome outcome = sdo_.download(index, sub_index, value);
  sdo_.set_timeout(settings_.sdo.timeout_ms);
  return outcome;
}

Bytes Dut::bytes_of(std::uint16_t index, std::uint8_t sub_index, std::uint64_t number) const {
  const Entry* const found = entry(index, sub_index);
  const unsigned bits = found == nullptr || found->type == nullptr ? 32 : found->type->bits;
  return edsc::bytes_of(number, bits == 0 ? 4 : bytes_for(bits));
}

Bytes Dut::read(std::uint16_t index, std::uint8_t sub_index) {
  SdoOutcome outcome = upload(index, sub_index);
  expect(outcome.done(), "the value of " + label(index, sub_index), outcome_text(outcome));
  return std::move(outcome.bytes);
}

std::uint64_t Dut::read_number(std::uint16_t index, std::uint8_t sub_index) {
  return number_of(read(index, sub_index));
}

void Dut::write(std::uint16_t index, std::uint8_t sub_index, std::uint64_t number) {
  const Bytes bytes = bytes_of(index, sub_index, number);
  const SdoOutcome outcome = download(index, sub_index, bytes);
  expect_done(outcome, fmt::format("{:X}h written to {}", number, label(index, sub_index)));
}

void Dut::request(const sdo::Data& data) {
  transfer_open_ = true;
  send(canopen::default_sdo(node()).request.can_id(), data);
}

std::optional<sdo::Data> Dut::answer() {
  const auto is_answer = [this](const canopen::Frame& frame) {
    return frame.size == 8 && with_id(canopen::default_sdo(node()).response.can_id())(frame);
  };
  const auto found = wait_for(is_answer, milliseconds{settings_.sdo.timeout_ms}, next_answer_);
  if (!found) return std::nullopt;
  next_answer_ = static_cast<Mark>(last_match_) + 1;
  return found->frame.data;
}

std::optional<sdo::Data> Dut::exchange(const sdo::Data& data) {
  next_answer_ = mark();
  request(data);
  return answer();
}

void Dut::end_transfer(std::uint16_t index, std::uint8_t sub_index) {
  sdo::Data abort{sdo::abort_command};
  sdo::put_multiplexer(abort, index, sub_index);
  sdo::put_word(abort, static_cast<std::uint32_t>(canopen::AbortCode::general));
  send(canopen::default_sdo(node()).request.can_id(), abort);
  pass_time(milliseconds{5});
  transfer_open_ = false;
}

std::string outcome_text(const SdoOutcome& outcome) {
  if (outcome.done()) return outcome.bytes.empty() ? "done" : "the value " + hex_bytes(outcome.bytes);
  return outcome.end == SdoEnd::refused ? abort_text(outcome.code) : failure_text(outcome);
}

}  // namespace edsc::conform
