#include "discover/bus_survey.hpp"

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <cmath>

#include "decode/predefined_set.hpp"
#include "values/little_endian.hpp"

namespace edsc::discover {
namespace {

constexpr std::size_t max_pdos = 4096;
constexpr std::uint16_t first_parameter = 0x1000, last_parameter = 0x1BFF;
/// Fewer distances are not a period.
constexpr std::uint64_t min_distances = 3;

std::optional<std::uint32_t> parameter(const SurveyedNode& node, std::uint16_t index, std::uint8_t sub_index) {
  const auto found = node.parameters.find({index, sub_index});
  return found == node.parameters.end() ? std::nullopt : std::optional{found->second};
}

/// Whether the times are regular: their standard deviation is at most 5 % of the mean, or half a millisecond.
bool is_regular(const audit::Spread& spread) {
  constexpr double share = 0.05, least_us = 500;
  return spread.count() >= min_distances && spread.deviation() <= std::max(spread.mean() * share, least_us) &&
         spread.mean() > 2 * least_us;
}

/// The number of SYNCs from frame to frame, if it is the same for at least 95 % of them; otherwise 0.
std::uint64_t sync_step(const SurveyedPdo& pdo) {
  std::uint64_t all = 0;
  std::pair<std::uint64_t, std::uint64_t> most{0, 0};
  for (const auto& [step, count] : pdo.sync_steps) {
    all += count;
    if (count > most.second) most = {step, count};
  }
  constexpr std::uint64_t percent = 95;
  return all >= min_distances && most.second * 100 >= all * percent ? most.first : 0;
}

}  // namespace

std::string_view to_text(Transmission transmission) {
  constexpr std::string_view names[] = {"unknown", "sync", "timed", "event"};
  return names[static_cast<std::size_t>(transmission)];
}

std::int64_t round_period(double us) {
  constexpr double tolerance = 0.01;
  if (us < 1) return 0;
  const double magnitude = std::pow(10.0, std::floor(std::log10(us)));
  for (const double unit : {magnitude, magnitude / 10, magnitude / 100}) {
    const double rounded = std::round(us / unit) * unit;
    if (std::abs(rounded - us) <= us * tolerance) return std::llround(rounded);
  }
  return std::llround(us);
}

BusSurvey::BusSurvey() : decoder_{std::vector<KnownNode>{}} {}

std::int64_t BusSurvey::add(const canopen::Frame& frame, bool has_time, std::int64_t us) {
  const std::int64_t back_us = has_time ? time_.add(us) : 0;
  if (back_us > 0) restart_times();
  ++frames_;
  decoder_.decode({frame, has_time, us}, message_);
  const std::int64_t now = time_.now_us();
  cycle_times_.see({frame, message_, {static_cast<std::size_t>(frames_), has_time, now}}, audit_);
  switch (message_.service) {
    case Service::nmt: ++nmt_commands_; break;
    case Service::time: ++time_messages_; break;
    case Service::sync:
      ++syncs_;
      has_sync_counter_ |= frame.size == 1;
      if (has_time) last_sync_us_ = now;
      break;
    case Service::unknown: see_unknown(frame, has_time); break;
    default: see_node(message_, frame);
  }
  return back_us;
}

/// No distance from a frame before is a period.
void BusSurvey::restart_times() {
  audit_.times_since = time_.now_us();
  for (audit::NodeState& node : audit_.nodes) node.settings_since = audit_.times_since;
  for (auto& [cob_id, pdo] : pdos_) pdo.last_us.reset();
  last_sync_us_.reset();
}

void BusSurvey::see_node(const Message& message, const canopen::Frame& frame) {
  if (message.service == Service::sdo && message.step == TransferStep::finished) see_transfer(message);
  if (!is_from_node(message) || frame.remote || message.node_id == 0) return;
  SurveyedNode& node = nodes_[message.node_id];
  ++node.frames;
  if (message.state) node.state = message.state;
  if (message.service == Service::emcy) ++node.emergencies;
  if (message.service == Service::sdo) node.answers_sdo = true;
  if (message.service != Service::boot_up) return;
  ++node.boot_ups;
  node.state = canopen::NmtState::pre_operational;  // which follows it
  audit_.nodes[message.node_id].settings_since = time_.now_us();
}

/// Numbers of the communication profile, and the name.
void BusSurvey::see_transfer(const Message& message) {
  constexpr std::uint16_t name_index = 0x1008;
  if (message.values.empty() || message.index < first_parameter || message.index > last_parameter) return;
  const std::span<const std::uint8_t> bytes = message.values.front().bytes;
  SurveyedNode& node = nodes_[message.node_id];
  if (message.index == name_index) {
    node.name.emplace(bytes.begin(), bytes.end());
  } else if (!bytes.empty() && bytes.size() <= sizeof(std::uint32_t)) {
    node.parameters[{message.index, message.sub_index}] = static_cast<std::uint32_t>(number_of(bytes));
  }
}

void BusSurvey::see_unknown(const canopen::Frame& frame, bool has_time) {
  if (frame.remote) return;
  const std::uint32_t cob_id = canopen::cob_id_of(frame);
  if (pdos_.size() >= max_pdos && !pdos_.contains(cob_id)) return;
  SurveyedPdo& pdo = pdos_[cob_id];
  const bool is_first = pdo.frames == 0;
  pdo.frame = frame;
  pdo.min_bytes = std::min(pdo.min_bytes, frame.size);
  pdo.max_bytes = std::max(pdo.max_bytes, frame.size);
  ++pdo.frames;
  if (!is_first) ++pdo.sync_steps[syncs_ - pdo.last_sync];
  pdo.last_sync = syncs_;
  if (!has_time) return;
  const std::int64_t now = time_.now_us();
  if (pdo.last_us) pdo.distance.add(now - *pdo.last_us);
  if (last_sync_us_) pdo.after_sync.add(now - *last_sync_us_);
  pdo.last_us = now;
}

std::optional<std::int64_t> BusSurvey::duration_us() const {
  return time_.first_us() ? std::optional{time_.now_us()} : std::nullopt;
}

const audit::Cycle* BusSurvey::cycle(audit::CycleKind kind, std::uint8_t node_id) const {
  for (const auto& [key, cycle] : cycle_times_.cycles()) {
    if (key.kind == kind && key.node_id == node_id && cycle.distance.count() > 0) return &cycle;
  }
  return nullptr;
}

std::optional<std::int64_t> BusSurvey::sync_period_us() const {
  const audit::Cycle* const sync = cycle(audit::CycleKind::sync, 0);
  return sync != nullptr ? std::optional{round_period(sync->distance.mean())} : std::nullopt;
}

std::optional<std::int64_t> BusSurvey::heartbeat_period_us(std::uint8_t node_id) const {
  const audit::Cycle* const heartbeat = cycle(audit::CycleKind::heartbeat, node_id);
  return heartbeat != nullptr ? std::optional{round_period(heartbeat->distance.mean())} : std::nullopt;
}

GuessedPdo BusSurvey::guess(const SurveyedPdo& pdo) const {
  GuessedPdo guessed;
  find_owner(pdo.frame, guessed);
  const audit::Cycle* const sync = cycle(audit::CycleKind::sync, 0);
  const std::uint64_t step = sync_step(pdo);
  constexpr double share = 0.1;  // of the SYNC period, that the delay after SYNC may deviate
  if (sync != nullptr && step > 0 && pdo.after_sync.deviation() <= sync->distance.mean() * share) {
    guessed.transmission = Transmission::sync;
    guessed.every_sync = step;
  } else if (is_regular(pdo.distance)) {
    guessed.transmission = Transmission::timed;
    guessed.period_us = round_period(pdo.distance.mean());
  } else if (pdo.distance.count() >= min_distances) {
    guessed.transmission = Transmission::event;
  }
  return guessed;
}

/// The node whose communication parameters in the log have the COB-ID, else that of the pre-defined connection set.
void BusSurvey::find_owner(const canopen::Frame& frame, GuessedPdo& guessed) const {
  constexpr std::uint16_t pdos_of_direction = 0x200, first_rpdo = 0x1400, first_tpdo = 0x1800;
  const auto owns = [&](std::uint8_t node_id, std::uint16_t first) {
    for (std::uint16_t number = 1; number <= pdos_of_direction; ++number) {
      const auto cob_id = parameter(nodes_[node_id], static_cast<std::uint16_t>(first + number - 1), 1);
      const std::uint32_t identifier = canopen::CobId::invalid_bit | canopen::CobId::identifier;
      if (!cob_id || (*cob_id & identifier) != canopen::cob_id_of(frame)) continue;
      guessed.source = PdoSource::parameters;
      guessed.node_id = node_id;
      guessed.is_tpdo = first == first_tpdo;
      guessed.number = number;
      return true;
    }
    return false;
  };
  for (const std::uint16_t first : {first_tpdo, first_rpdo}) {
    for (std::uint8_t node_id = 1; node_id < node_ids; ++node_id) {
      if (!nodes_[node_id].parameters.empty() && owns(node_id, first)) return;
    }
  }
  const auto pdo = frame.extended ? std::nullopt : predefined_pdo(frame.id);
  if (!pdo || nodes_[pdo->node_id].frames == 0) return;
  guessed.source = PdoSource::default_cob_id;
  guessed.node_id = pdo->node_id;
  guessed.is_tpdo = pdo->transmit;
  guessed.number = pdo->number;
}

std::vector<FoundNode> BusSurvey::found_nodes() const {
  std::vector<FoundNode> found;
  constexpr std::uint32_t us_of_ms = 1000;
  for (std::uint8_t node_id = 1; node_id < node_ids; ++node_id) {
    const SurveyedNode& node = nodes_[node_id];
    if (node.frames == 0) continue;
    FoundNode one;
    one.node_id = node_id;
    one.answers_sdo = node.answers_sdo;
    one.state = node.state;
    for (const IdentityNumber& number : identity_numbers) {
      one.identity.*number.value = parameter(node, number.index, number.sub_index);
    }
    one.heartbeat_ms = parameter(node, 0x1017, 0);
    if (const auto period = heartbeat_period_us(node_id); period && !one.heartbeat_ms) {
      one.heartbeat_ms = static_cast<std::uint32_t>((*period + us_of_ms / 2) / us_of_ms);
    }
    one.name = node.name;
    found.push_back(std::move(one));
  }
  return found;
}

}  // namespace edsc::discover
