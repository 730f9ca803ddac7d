#include "conform/dut.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/nmt/error_control.hpp>
#include <canopen/nmt_master/nmt_master.hpp>
#include <canopen/sdo/sdo_client.hpp>
#include <cstring>

#include "configure/configuration_plan.hpp"
#include "configure/configure_node.hpp"
#include "configure/read_configuration.hpp"
#include "online/interruption.hpp"

namespace edsc::conform {
namespace {

using canopen::Frame;
using canopen::NmtCommand;
using canopen::NmtState;
using canopen::TimePoint;
namespace sdo = canopen::sdo;

constexpr std::uint16_t heartbeat_time = 0x1017, guard_time = 0x100C, verify_configuration = 0x1020;
/// The sub-indices of 1020h. They are written last: the device sets them to 0 when another parameter changes.
constexpr std::uint8_t verified[] = {1, 2};
constexpr std::uint64_t watched_heartbeat_ms = 100;

/// The time that a device may need to follow an NMT command. CiA 301 does not specify a limit.
constexpr Duration to_follow = milliseconds{50};
/// The time that a device may need to start.
constexpr Duration to_start = milliseconds{5000};

bool is_pdo_parameter(std::uint16_t index) { return index >= 0x1400 && index < 0x1C00; }

/// Returns 1600h for 1400h, and the reverse.
std::uint16_t other_parameter(std::uint16_t index) { return static_cast<std::uint16_t>(index ^ 0x0200U); }

std::uint32_t seed_of(std::uint32_t seed, std::string_view id) {
  for (const char letter : id) seed = seed * 31 + static_cast<unsigned char>(letter);
  return seed;
}

Bytes little_endian(std::uint64_t number, std::size_t size) {
  Bytes bytes(size);
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(number & 0xFF);
    number >>= 8;
  }
  return bytes;
}

std::string milliseconds_text(std::uint64_t microseconds) {
  return fmt::format("{}.{:03} ms", microseconds / 1000, microseconds % 1000);
}

}  // namespace

std::string label(std::uint16_t index, std::uint8_t sub_index) { return entry_label(index, sub_index); }

std::uint64_t number_of(std::span<const std::uint8_t> bytes) {
  std::uint64_t number = 0;
  for (std::size_t i = std::min<std::size_t>(bytes.size(), 8); i-- > 0;) number = number << 8 | bytes[i];
  return number;
}

std::string outcome_text(const SdoOutcome& outcome) {
  if (outcome.done()) return outcome.bytes.empty() ? "done" : "the value " + hex_bytes(outcome.bytes);
  return outcome.end == SdoEnd::refused ? abort_text(outcome.code) : failure_text(outcome);
}

Dut::Dut(LiveBus& bus, const Device& sheet, Stimuli& stimuli, const DutSettings& settings)
    : bus_{bus},
      sheet_{sheet},
      stimuli_{stimuli},
      settings_{settings},
      sdo_{bus, settings.node, settings.sdo},
      random_{settings.seed},
      last_time_{bus.now()} {
  bus_.on_frame = [this](const Frame& frame, TimePoint) { record(frame, bus_.received_at(), false); };
  bus_.on_sent = [this](const Frame& frame, TimePoint at) { record(frame, at, true); };
}

Dut::~Dut() {
  bus_.on_frame = nullptr;
  bus_.on_sent = nullptr;
}

// ---- the EDS ----

const Entry* Dut::entry(std::uint16_t index, std::uint8_t sub_index) const { return sheet_.find(index, sub_index); }

bool Dut::has(std::uint16_t index, std::uint8_t sub_index) const { return entry(index, sub_index) != nullptr; }

const Entry& Dut::need(std::uint16_t index, std::uint8_t sub_index) {
  const Entry* const found = entry(index, sub_index);
  if (found == nullptr) not_applicable(label(index, sub_index) + " does not exist in the EDS");
  return *found;
}

const Entry& Dut::need_writable(std::uint16_t index, std::uint8_t sub_index) {
  const Entry& found = need(index, sub_index);
  if (!canopen::writable(found.access)) {
    not_applicable(fmt::format("{} is {} in the EDS", label(index, sub_index), canopen::row_of(found.access).name));
  }
  return found;
}

std::optional<std::uint64_t> Dut::default_of(std::uint16_t index, std::uint8_t sub_index) const {
  const Entry* const found = entry(index, sub_index);
  if (found == nullptr || !found->default_value || found->type == nullptr || found->type->bits == 0)
    return std::nullopt;
  const std::uint64_t bits = found->default_value->bits + (found->default_value->plus_node_id ? node().value() : 0U);
  const unsigned size = found->type->bits;
  return size >= 64 ? bits : bits & ((std::uint64_t{1} << size) - 1);
}

std::vector<LiveEntry> Dut::entries() const {
  std::vector<LiveEntry> all;
  for (const Object& object : sheet_.objects) {
    for (const Entry& found : object.entries) all.push_back(live_entry(object, found));
  }
  return all;
}

std::vector<const Pdo*> Dut::pdos(PdoDirection direction) const {
  std::vector<const Pdo*> found;
  for (const Pdo& pdo : sheet_.pdos) {
    if (pdo.direction == direction && pdo.communication != nullptr) found.push_back(&pdo);
  }
  return found;
}

// ---- SDO ----

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
  return little_endian(number, bits == 0 ? 4 : (bits + 7) / 8);
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
  const auto is_answer = [this](const Frame& frame) {
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

Bytes Dut::upload_segmented(std::uint16_t index, std::uint8_t sub_index) {
  sdo::Data data{0x40};
  sdo::put_multiplexer(data, index, sub_index);
  const auto begun = exchange(data);
  expect(begun && (*begun)[0] != sdo::abort_command, "an upload of " + label(index, sub_index), answer_text(begun));
  if (((*begun)[0] & sdo::expedited) != 0) {
    const bool sized = ((*begun)[0] & sdo::size_indicated) != 0;
    return Bytes(begun->begin() + 4, begun->end() - (sized ? ((*begun)[0] >> 2 & 3) : 0));
  }
  Bytes value;
  for (std::uint8_t toggle = 0;; toggle ^= sdo::toggle) {
    const auto segment = exchange({static_cast<std::uint8_t>(0x60 | toggle)});
    const bool right = segment && ((*segment)[0] & 0xF0) == toggle;
    expect(right, fmt::format("a segment with toggle bit {}", toggle == 0 ? 0 : 1), answer_text(segment));
    value.insert(value.end(), segment->begin() + 1, segment->end() - ((*segment)[0] >> 1 & 7));
    if (((*segment)[0] & sdo::last_segment) != 0) break;
  }
  transfer_open_ = false;
  return value;
}

SdoOutcome Dut::download_segmented(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value) {
  const auto outcome_of = [](const std::optional<sdo::Data>& data, std::uint8_t command) {
    SdoOutcome outcome;
    if (data && (*data)[0] == command) return outcome;
    outcome.end = !data ? SdoEnd::no_answer : SdoEnd::broken;
    if (data && (*data)[0] == sdo::abort_command) {
      outcome.end = SdoEnd::refused;
      outcome.code = static_cast<canopen::AbortCode>(sdo::word_of(*data));
    }
    return outcome;
  };
  remember(index, sub_index);
  sdo::Data data{0x21};
  sdo::put_multiplexer(data, index, sub_index);
  sdo::put_word(data, static_cast<std::uint32_t>(value.size()));
  SdoOutcome outcome = outcome_of(exchange(data), 0x60);
  std::uint8_t toggle = 0;
  for (std::size_t at = 0; outcome.done() && (at < value.size() || at == 0); at += sdo::segment_bytes) {
    const std::size_t size = std::min<std::size_t>(sdo::segment_bytes, value.size() - at);
    const bool last = at + size == value.size();
    data = {static_cast<std::uint8_t>(toggle | (sdo::segment_bytes - size) << 1 | (last ? 1 : 0))};
    std::copy_n(value.begin() + static_cast<std::ptrdiff_t>(at), size, data.begin() + 1);
    outcome = outcome_of(exchange(data), static_cast<std::uint8_t>(0x20 | toggle));
    toggle ^= sdo::toggle;
  }
  if (outcome.done() || outcome.end == SdoEnd::refused) transfer_open_ = false;
  return outcome;
}

// ---- all values at once ----

Dut::Values Dut::values() {
  Values found;
  NodeConfiguration configuration = read_configuration(sdo_, sheet_, configuration_entries(sheet_), [](std::size_t) {});
  for (ReadValue& value : configuration.values) {
    found[{value.entry.index, value.entry.sub_index}] = std::move(value.bytes);
  }
  for (const std::uint8_t sub_index : verified) {
    if (!has(verify_configuration, sub_index)) continue;
    const SdoOutcome outcome = upload(verify_configuration, sub_index);
    if (outcome.done()) found[{verify_configuration, sub_index}] = outcome.bytes;
  }
  return found;
}

void Dut::restore(const Values& wanted) {
  Values parameters = wanted;
  for (const std::uint8_t sub_index : verified) parameters.erase({verify_configuration, sub_index});
  for (std::string& left : restore_values(parameters, true)) warn(std::move(left));
  for (const std::uint8_t sub_index : verified) {
    const auto found = wanted.find({verify_configuration, sub_index});
    if (found == wanted.end() || upload(verify_configuration, sub_index).bytes == found->second) continue;
    if (!command(verify_configuration, sub_index, found->second).done()) {
      warn(label(verify_configuration, sub_index) + " could not be restored");
    }
  }
}

// ---- frames ----

void Dut::send(const Frame& frame) { bus_.send_all(frame); }

void Dut::send(std::uint32_t can_id, std::span<const std::uint8_t> data) {
  Frame frame;
  frame.id = can_id;
  frame.extended = can_id > 0x7FF;
  frame.size = static_cast<std::uint8_t>(std::min<std::size_t>(data.size(), frame.data.size()));
  std::copy_n(data.begin(), frame.size, frame.data.begin());
  send(frame);
}

void Dut::send_remote(std::uint32_t can_id, std::uint8_t size) {
  Frame frame;
  frame.id = can_id;
  frame.extended = can_id > 0x7FF;
  frame.remote = true;
  frame.size = size;
  send(frame);
}

void Dut::take_frame(Duration longest) {
  const TimePoint end = bus_.now() + longest;
  const bool came = bus_.receive(longest).has_value();
  const TimePoint present = bus_.now();
  if (Interruption::noted()) throw Interrupted{};
  const TimePoint due = came ? bus_.received_at() : end;
  if (present > due) lag_ = std::max<std::uint64_t>(lag_, (present - due).count());
}

std::optional<SeenFrame> Dut::wait_for(const Match& match, Duration span, Mark since) {
  const TimePoint end = bus_.now() + span;
  for (;;) {
    for (; since < frames_.size(); ++since) {
      if (frames_[since].sent || !match(frames_[since].frame)) continue;
      last_match_ = since;
      return frames_[since];
    }
    const TimePoint present = bus_.now();
    if (present >= end) return std::nullopt;
    take_frame(end - present);
  }
}

std::vector<SeenFrame> Dut::collect(const Match& match, Duration span) {
  const Mark since = mark();
  const TimePoint end = bus_.now() + span;
  for (TimePoint present = bus_.now(); present < end; present = bus_.now()) take_frame(end - present);
  return received_since(since, match);
}

std::vector<SeenFrame> Dut::received_since(Mark since, const Match& match) const {
  std::vector<SeenFrame> found;
  for (; since < frames_.size(); ++since) {
    if (!frames_[since].sent && match(frames_[since].frame)) found.push_back(frames_[since]);
  }
  return found;
}

std::uint64_t Dut::now() const {
  const TimePoint present = bus_.now();
  return present > last_time_ ? elapsed_ + (present - last_time_).count() : elapsed_;
}

void Dut::record(const Frame& frame, TimePoint at, bool sent) {
  if (at > last_time_) {
    elapsed_ += (at - last_time_).count();
    last_time_ = at;
  }
  frames_.push_back({frame, elapsed_, sent});
}

Dut::Match Dut::with_id(std::uint32_t can_id) {
  return [can_id](const Frame& frame) { return frame.id == can_id && !frame.extended && !frame.remote; };
}

Dut::Match Dut::with_cob_id(std::uint32_t cob_id) {
  const canopen::CobId id{cob_id};
  return
      [id](const Frame& frame) { return frame.id == id.can_id() && frame.extended == id.extended() && !frame.remote; };
}

Dut::Match Dut::error_control() const { return with_id(0x700U + node().value()); }

Dut::Match Dut::boot_up() const {
  return [id = 0x700U + node().value()](const Frame& frame) {
    return with_id(id)(frame) && frame.size == 1 && frame.data[0] == 0;
  };
}

Dut::Match Dut::heartbeat() const {
  return [id = 0x700U + node().value()](const Frame& frame) {
    return with_id(id)(frame) && frame.size == 1 && frame.data[0] != 0;
  };
}

// ---- NMT ----

void Dut::nmt(NmtCommand command) {
  const bool resets = command == NmtCommand::reset_node || command == NmtCommand::reset_communication;
  if (resets) {
    remember_configuration();
    was_reset_ = true;
  }
  state_changed_ = true;
  send(canopen::nmt_frame(command, node()));
}

void Dut::reset(NmtCommand command) {
  nmt(command);
  const auto started = wait_for(boot_up(), to_start);
  expect(started.has_value(), "a boot-up message within " + milliseconds_text(to_start.count()), "none");
  pass_time(to_follow);
}

void Dut::enter(NmtState state) {
  switch (state) {
    case NmtState::operational: nmt(NmtCommand::start); break;
    case NmtState::stopped: nmt(NmtCommand::stop); break;
    case NmtState::pre_operational: nmt(NmtCommand::enter_pre_operational); break;
    case NmtState::initialisation: return reset(NmtCommand::reset_node);
  }
  pass_time(to_follow);
}

bool Dut::watch_state() {
  const Entry* const heartbeat_entry = entry(heartbeat_time);
  if (heartbeat_entry != nullptr && canopen::readable(heartbeat_entry->access)) {
    const std::uint64_t period = read_number(heartbeat_time);
    if (period == 0 || period > watched_heartbeat_ms) {
      if (!canopen::writable(heartbeat_entry->access)) return period != 0;
      write(heartbeat_time, 0, watched_heartbeat_ms);
    }
    guarded_ = false;
    return true;
  }
  guarded_ = has(guard_time);
  return guarded_;
}

std::optional<NmtState> Dut::state() {
  constexpr Duration several_heartbeats = milliseconds{5 * watched_heartbeat_ms};
  const Mark since = mark();
  if (guarded_) send_remote(0x700U + node().value(), 1);
  const auto seen = wait_for(heartbeat(), std::max(several_heartbeats, tolerance()), since);
  if (!seen) return std::nullopt;
  const auto message = canopen::error_control_message(seen->frame);
  if (!message) return std::nullopt;
  return message->state;
}

void Dut::expect_state(NmtState expected) {
  const auto found = state();
  expect(found == expected, fmt::format("an error control message with the state {}", canopen::to_text(expected)),
         found ? std::string{canopen::to_text(*found)} : "none");
}

// ---- verdicts ----

void Dut::fail(std::string expected, std::string got) {
  failed_ = mark();
  throw CaseEnd{Verdict::failed, {}, std::move(expected), std::move(got)};
}
void Dut::fail_by_sheet(std::string_view rule, std::string expected, std::string got) {
  failed_ = mark();
  throw CaseEnd{Verdict::failed, {}, std::move(expected), std::move(got), std::string{rule}};
}
void Dut::not_applicable(std::string reason) { throw CaseEnd{Verdict::not_applicable, std::move(reason), {}, {}}; }
void Dut::inconclusive(std::string reason) { throw CaseEnd{Verdict::inconclusive, std::move(reason), {}, {}}; }

void Dut::need_permission(Permission permission) {
  for (const PermissionRow& row : permission_options) {
    if (includes(permission, row.permission) && !allowed(row.permission)) {
      inconclusive(fmt::format("needs {}", row.option));
    }
  }
}

void Dut::expect_abort(const SdoOutcome& outcome, const AbortRule& rule, const std::string& what) {
  const std::string where = what.empty() ? "" : what + ": ";
  const std::string expected = where + "an abort with " + abort_text(rule.standard.front());
  if (outcome.end != SdoEnd::refused || !rule.is_accepted(outcome.code)) fail(expected, where + outcome_text(outcome));
  if (!rule.is_standard(outcome.code)) {
    warn(fmt::format("{}{}; CiA 301 has {}", where, abort_text(outcome.code), abort_text(rule.standard.front())));
  }
}

void Dut::expect_abort(const std::optional<sdo::Data>& data, const AbortRule& rule, const std::string& what) {
  SdoOutcome outcome;
  outcome.end = !data ? SdoEnd::no_answer : SdoEnd::done;
  if (data && (*data)[0] == sdo::abort_command) {
    transfer_open_ = false;
    outcome.end = SdoEnd::refused;
    outcome.code = static_cast<canopen::AbortCode>(sdo::word_of(*data));
  } else if (data) {
    outcome.bytes.assign(data->begin(), data->end());
  }
  expect_abort(outcome, rule, what);
}

void Dut::expect_done(const SdoOutcome& outcome, const std::string& what) {
  expect(outcome.done(), what, outcome_text(outcome));
}

void Dut::expect_equal(std::uint64_t got, std::uint64_t expected, const std::string& what) {
  expect(got == expected, fmt::format("{}: {} ({:X}h)", what, expected, expected), fmt::format("{} ({:X}h)", got, got));
}

void Dut::expect_time(std::uint64_t measured, std::uint64_t low, std::uint64_t high, const std::string& what) {
  const std::uint64_t wider = tolerance().count();
  if (measured + wider >= low && measured <= high + wider) return;
  const std::uint64_t misses = measured < low ? low - measured : measured - high;
  if (misses <= lag_ + settings_.tolerance.count()) {
    inconclusive(fmt::format("{}: measured {}, but the test itself was late by {}", what, milliseconds_text(measured),
                             milliseconds_text(lag_)));
  }
  fail(fmt::format("{}: {} to {}", what, milliseconds_text(low), milliseconds_text(high)), milliseconds_text(measured));
}

Duration Dut::tolerance() const { return settings_.tolerance; }

// ---- for the runner ----

void Dut::begin_case(const CaseRow& row) {
  frames_.clear();
  warnings_.clear();
  lag_ = 0;
  next_answer_ = 0;
  failed_.reset();
  case_began_ = now();
  random_.seed(seed_of(settings_.seed, row.id));
  stimuli_.begin_case(row.id);
}

void Dut::end_case(CaseResult& result) {
  if (transfer_open_) end_transfer();
  result.began = case_began_;
  result.took = now() - case_began_;
  result.lag = lag_;
  result.warnings = std::move(warnings_);
  result.frames = frames_;
  result.until_failure = failed_;
  result.not_put_back = put_back();
}

void Dut::remember(std::uint16_t index, std::uint8_t sub_index) {
  if (changed_.contains({index, sub_index})) return;
  if (!is_pdo_parameter(index)) return remember_entry(live(index, sub_index));
  for (const std::uint16_t parameter : {index, other_parameter(index)}) {
    const Object* const object = sheet_.find(parameter);
    if (object == nullptr) continue;
    for (const Entry& found : object->entries) {
      if (canopen::writable(found.access)) remember_entry(live_entry(*object, found));
    }
  }
}

void Dut::remember_entry(const LiveEntry& wanted) {
  const Key key{wanted.index, wanted.sub_index};
  if (changed_.contains(key) || unreadable_.contains(key) || is_left_out(wanted)) return;
  const SdoOutcome outcome = edsc::upload(sdo_, wanted);
  if (outcome.done()) {
    changed_.emplace(key, outcome.bytes);
  } else if (outcome.end == SdoEnd::refused) {
    unreadable_.insert(key);
  }
}

/// Called before the first reset, which discards what is not stored.
void Dut::remember_configuration() {
  if (configuration_known_) return;
  configuration_known_ = true;
  NodeConfiguration found = read_configuration(sdo_, sheet_, configuration_entries(sheet_), [](std::size_t) {});
  for (ReadValue& value : found.values) {
    const bool process_data = value.entry.index >= 0x2000 && value.entry.entry->pdo_mapping;
    if (!process_data) configuration_[{value.entry.index, value.entry.sub_index}] = std::move(value.bytes);
  }
  for (const auto& [key, bytes] : changed_) configuration_[key] = bytes;
}

namespace {

/// The first ones, and the number of the others.
std::string titles_of(const std::vector<ConfigurationValue>& values) {
  constexpr std::size_t max_named = 8;
  std::string text;
  for (std::size_t i = 0; i < values.size() && i < max_named; ++i) {
    text += (i == 0 ? "" : ", ") + title(values[i].entry);
  }
  if (values.size() > max_named) text += fmt::format(" and {} more", values.size() - max_named);
  return text;
}

}  // namespace

std::vector<std::string> Dut::restore_values(const Values& wanted, bool application) {
  std::vector<ConfigurationValue> values;
  for (const auto& [key, bytes] : wanted) values.push_back({live(key.first, key.second), bytes, {}});
  const ConfigurationHooks hooks{[](std::size_t, std::size_t) {}, [] { return false; }};
  const Comparison comparison = compare_configuration(sdo_, values, hooks);
  if (comparison.lost) return {titles_of(values) + ": the device does not answer"};
  std::vector<bool> differs;
  std::vector<std::string> left;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool kept = values[i].entry.index >= 0x2000 && !application;
    const ComparedValue& compared = comparison.values[i];
    const bool changed = compared.differs && compared.known();
    if (compared.differs && !compared.known()) {
      left.push_back(fmt::format("{} was {} and can no longer be read: {}", title(values[i].entry),
                                 value_of(values[i].entry, values[i].bytes), outcome_text(compared.found)));
    }
    differs.push_back(changed && !kept);
    if (changed && kept) {
      left.push_back(fmt::format("{} was {} and is lost by a reset; it is not written without --application",
                                 title(values[i].entry), value_of(values[i].entry, values[i].bytes)));
    }
  }
  if (std::ranges::find(differs, true) == differs.end()) return left;
  const std::vector<ConfigurationValue> to_write = values_to_write(values, differs);
  const ConfigurationResult result = configure_node(sdo_, plan_configuration(to_write, &sheet_), hooks);
  for (const ConfigurationFailure& failure : result.failures) {
    left.push_back(fmt::format("{}: {}", title(failure.entry), failure.what));
  }
  if (result.lost && left.empty()) left.push_back("the device no longer answers");
  return left;
}

std::vector<std::string> Dut::put_back() {
  const Uninterrupted uninterrupted;
  std::vector<std::string> left;
  if (transfer_open_) end_transfer();
  if (state_changed_) enter(NmtState::pre_operational);
  std::map<Key, Bytes> wanted = changed_;
  if (was_reset_) {
    for (const auto& [key, bytes] : configuration_) wanted[key] = bytes;
  }
  if (!wanted.empty()) left = restore_values(wanted, allowed(Permission::application));
  if (state_changed_ && found_state_ && *found_state_ != NmtState::pre_operational) enter(*found_state_);
  changed_.clear();
  was_reset_ = state_changed_ = false;
  return left;
}

std::vector<std::string> Dut::find_state() {
  if (settings_.level == Level::read) return {};
  try {
    if (watch_state()) found_state_ = state();
  } catch (const CaseEnd&) {
    // 1017h cannot be used as the EDS says: a case will report it.
  }
  return put_back();
}

std::string answer_text(const std::optional<sdo::Data>& data) {
  if (!data) return "no answer";
  if ((*data)[0] == sdo::abort_command) return abort_text(static_cast<canopen::AbortCode>(sdo::word_of(*data)));
  return "the answer " + hex_bytes(*data);
}

}  // namespace edsc::conform
