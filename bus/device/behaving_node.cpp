#include "device/behaving_node.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/bus_status.hpp>
#include <canopen/lss/lss_protocol.hpp>
#include <canopen/od/dictionary.hpp>
#include <utility>

#include "values/little_endian.hpp"

namespace edsc {
namespace {

constexpr std::uint16_t first_tpdo = 0x1800;
constexpr std::uint64_t longest_wait_us = 1'000'000'000;
constexpr canopen::Duration full_bus_wait{1'000};

std::uint16_t index_of(std::uint32_t key) { return static_cast<std::uint16_t>(key >> 8); }
std::uint8_t sub_index_of(std::uint32_t key) { return static_cast<std::uint8_t>(key); }

}  // namespace

BehavingNode::BehavingNode(BehavingNodeSettings settings, canopen::SimulatedBus& bus, canopen::SimulatedMemory& memory)
    : settings_{std::move(settings)},
      bus_{bus},
      memory_{memory},
      faults_{{[this] { return unsigned{node_->node_id().value()}; },
               [this](unsigned number) -> std::optional<std::uint32_t> {
                 const auto bytes = node_->get(static_cast<std::uint16_t>(first_tpdo + number - 1), 1);
                 if (!bytes) return std::nullopt;
                 return static_cast<std::uint32_t>(number_of(*bytes));
               }}},
      behaviour_{*this, settings_.seed},
      profile_{make_profile_behaviour(settings_.profile, *this)} {
  node_ = make_dynamic_node(settings_.sheet, *this, memory_, settings_.memory, this);
}

void BehavingNode::set_time(canopen::TimePoint now) {
  now_us_ += (now - now_).count();
  now_ = now;
  behaviour_.advance(now_us_);
}

void BehavingNode::start(canopen::TimePoint now) {
  now_ = now;
  if (std::exchange(has_started_, true)) {
    power_cycle();
  } else {
    power_on();
  }
  serve();
}

void BehavingNode::power_on() {
  must_start_ = settings_.starts_operational;
  node_->start(now_);
  behaviour_.on_power_on(now_us_);
}

void BehavingNode::on_frame(const canopen::Frame& frame, canopen::TimePoint now) {
  set_time(now);
  if (connected_ && faults_.receive(frame, now_us_)) node_->on_frame(frame, now);
  serve();
}

void BehavingNode::on_time(canopen::TimePoint now) {
  set_time(now);
  node_->on_time(now);
  serve();
}

void BehavingNode::serve() {
  if (profile_) profile_->on_time(now_);
  behaviour_.on_time(now_us_);
  if (std::exchange(must_start_, false)) node_->request(canopen::NmtCommand::start, now_);
  node_->on_time(now_);
  faults_.on_time(now_us_);
  follow_lost_node_id();
  send_queued();
}

std::optional<canopen::TimePoint> BehavingNode::next_deadline() const {
  std::uint64_t wait = longest_wait_us;
  const auto consider = [&](std::optional<std::uint64_t> time) {
    if (time) wait = std::min(wait, *time > now_us_ ? *time - now_us_ : 0);
  };
  consider(behaviour_.next_us());
  if (const std::optional<std::uint64_t> queued = faults_.next_us()) {
    consider(was_full_ ? std::max(*queued, now_us_ + full_bus_wait.count()) : *queued);
  }
  canopen::TimePoint next = now_ + canopen::Duration{static_cast<std::uint32_t>(wait)};
  for (const std::optional<canopen::TimePoint> time :
       {node_->next_deadline(), profile_ ? profile_->next_deadline() : std::nullopt}) {
    if (time && *time < next) next = *time;
  }
  return next;
}

canopen::AbortCode BehavingNode::set(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> bytes) {
  if (faults_.has(NodeFaultKind::stuck, index, sub_index)) return canopen::ok;
  return node_->set(index, sub_index, bytes);
}

bool BehavingNode::send(const canopen::Frame& frame) {
  if (!connected_) return true;
  faults_.send(frame, now_us_);
  send_queued();
  return true;
}

void BehavingNode::send_queued() {
  was_full_ = false;
  while (const canopen::Frame* const frame = faults_.first_due(now_us_)) {
    // A node that is not connected does not keep frames.
    if (connected_ && !bus_.send(*frame)) {
      was_full_ = true;
      return;
    }
    faults_.sent();
  }
}

canopen::AbortCode BehavingNode::before_write(std::uint32_t key, std::span<std::uint8_t> bytes) {
  const std::uint16_t index = index_of(key);
  const std::uint8_t sub_index = sub_index_of(key);
  canopen::AbortCode code = behaviour_.before_write(index, sub_index, bytes);
  if (code == canopen::ok && profile_) code = profile_->before_write(key, bytes);
  if (code != canopen::ok || !faults_.has(NodeFaultKind::stuck, index, sub_index)) return code;
  // The present value replaces the written one.
  const auto present = node_->get(index, sub_index);
  return present ? node_->set(index, sub_index, *present) : code;
}

void BehavingNode::after_write(std::uint32_t key) {
  if (profile_) profile_->after_write(key);
  behaviour_.after_write(index_of(key), sub_index_of(key));
}

canopen::AbortCode BehavingNode::before_read(std::uint32_t key) {
  return behaviour_.before_read(index_of(key), sub_index_of(key));
}

void BehavingNode::on_state(canopen::NmtState state) {
  if (state == canopen::NmtState::initialisation) {
    must_start_ = settings_.starts_operational;
    if (profile_) profile_->restart();
  }
  behaviour_.on_state(state);
}

void BehavingNode::on_sync() {
  if (profile_) profile_->on_sync();
  behaviour_.on_sync();
}

void BehavingNode::on_error(std::uint16_t code) {
  if (profile_) profile_->on_error(code);
}

std::optional<std::vector<std::uint8_t>> BehavingNode::get(std::uint16_t index, std::uint8_t sub_index) {
  return node_->get(index, sub_index);
}

void BehavingNode::power_cycle() {
  node_ = make_dynamic_node(settings_.sheet, *this, memory_, settings_.memory, this);
  power_on();
}

void BehavingNode::set_connected(bool connected) {
  connected_ = connected;
  node_->on_bus_status({connected ? canopen::BusState::active : canopen::BusState::off, false}, now_);
}

void BehavingNode::start_fault(const NodeFault& fault) {
  faults_.start(fault, now_us_);
  follow_lost_node_id();
}

void BehavingNode::clear_faults() {
  faults_.clear();
  follow_lost_node_id();
}

void BehavingNode::follow_lost_node_id() {
  const bool is_lost = faults_.has(NodeFaultKind::lost_node_id);
  if (is_lost == lost_node_id_.has_value()) return;
  if (is_lost) {
    lost_node_id_ = node_->node_id();
    static_cast<void>(memory_.store(canopen::unconfigured_node_id, memory_.bit_timing()));
  } else {
    static_cast<void>(memory_.store(*lost_node_id_, memory_.bit_timing()));
    lost_node_id_.reset();
  }
  power_cycle();
}

std::string BehavingNode::state_text() const {
  std::string text{node_->node_id().valid() ? canopen::to_text(node_->state()) : "no node-ID"};
  if (!connected_) text += ", not connected";
  if (const std::string faults = faults_.text(); !faults.empty()) text += ", faults: " + faults;
  return text;
}

}  // namespace edsc
