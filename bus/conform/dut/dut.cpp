#include "conform/dut/dut.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <canopen/nmt/error_control.hpp>
#include <canopen/nmt_master/nmt_master.hpp>
#include <canopen/sdo/sdo_client.hpp>

#include "configure/configuration_plan.hpp"
#include "configure/configure_node.hpp"
#include "configure/read_configuration.hpp"
#include "conform/dut/sdo_transfers.hpp"
#include "conform/named_entries.hpp"
#include "online/interruption.hpp"
#include "values/little_endian.hpp"

namespace edsc::conform {

namespace sdo = canopen::sdo;

namespace {

using canopen::NmtCommand;
using canopen::NmtState;

/// The sub-indices of 1020h. They are written last: the device sets them to 0 when another parameter changes.
constexpr std::uint8_t verified[] = {1, 2};

constexpr std::uint64_t watched_heartbeat_ms = 100;

/// The SDO timeout of transfers that have no verdict, such as those that restore values.
constexpr unsigned restore_timeout_ms = 3000;

/// The time that a device may need to follow an NMT command. CiA 301 does not specify a limit.
constexpr Duration to_follow = milliseconds{50};
/// The time that a device may need to start.
constexpr Duration to_start = milliseconds{5000};

/// The state that an NMT command leads to. A reset leads to one that 1F80h may select.
std::optional<NmtState> state_after(NmtCommand command) {
  switch (command) {
    case NmtCommand::start: return NmtState::operational;
    case NmtCommand::stop: return NmtState::stopped;
    case NmtCommand::enter_pre_operational: return NmtState::pre_operational;
    case NmtCommand::reset_node:
    case NmtCommand::reset_communication: break;
  }
  return std::nullopt;
}

std::uint32_t seed_of(std::uint32_t seed, std::string_view id) {
  for (const char letter : id) seed = seed * 31 + static_cast<unsigned char>(letter);
  return seed;
}

/// Whether a response ends the transfer to which the request belongs.
bool ends_transfer(const sdo::Data& request, const sdo::Data& response) {
  constexpr std::uint8_t command = 0xE0;
  if (response[0] == sdo::abort_command) return true;
  switch (request[0] & command) {
    case 0x40: return (response[0] & command) == 0x40 && (response[0] & sdo::expedited) != 0;
    case 0x20: return (response[0] & command) == 0x60 && (request[0] & sdo::expedited) != 0;
    case 0x60: return (response[0] & command) == 0x00 && (response[0] & sdo::last_segment) != 0;
    case 0x00: return (response[0] & command) == 0x20 && (request[0] & sdo::last_segment) != 0;
    default:
      return (request[0] & sdo::block_end_mask) == sdo::block_download_end &&
             response[0] == sdo::block_download_end_answer;
  }
}

}  // namespace

std::string label(std::uint16_t index, std::uint8_t sub_index) { return entry_label(index, sub_index); }

std::string outcome_text(const SdoOutcome& outcome) {
  if (outcome.done()) return outcome.bytes.empty() ? "done" : "the value " + hex_bytes(outcome.bytes);
  return outcome.end == SdoEnd::refused ? abort_text(outcome.code) : failure_text(outcome);
}

std::string milliseconds_text(std::uint64_t time_us) {
  return fmt::format("{}.{:03} ms", time_us / 1000, time_us % 1000);
}

Dut::Dut(LiveBus& bus, const Device& sheet, Stimuli& stimuli, const DutSettings& settings)
    : CaseFrames{bus, settings.clock},
      sheet_{sheet},
      stimuli_{stimuli},
      settings_{settings},
      sdo_{bus, settings.node, settings.sdo},
      found_values_{sdo_, sheet},
      random_{settings.seed} {
  const auto sdo_server = canopen::default_sdo(settings.node);
  measure_responses(sdo_server.request.can_id(), sdo_server.response.can_id());
}

// ---- the EDS ----

const Entry* Dut::entry(std::uint16_t index, std::uint8_t sub_index) const { return sheet_.find(index, sub_index); }

bool Dut::has(std::uint16_t index, std::uint8_t sub_index) const { return entry(index, sub_index) != nullptr; }

bool Dut::is_readable(std::uint16_t index, std::uint8_t sub_index) const {
  const Entry* const found = entry(index, sub_index);
  return found != nullptr && canopen::readable(found->access);
}

bool Dut::is_writable(std::uint16_t index, std::uint8_t sub_index) const {
  const Entry* const found = entry(index, sub_index);
  return found != nullptr && canopen::writable(found->access);
}

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
  return bits & low_bits(found->type->bits);
}

std::vector<LiveEntry> Dut::entries() const {
  std::vector<LiveEntry> all;
  for (const Object& object : sheet_.objects) {
    for (const Entry& found : object.entries) all.push_back(live_entry(sheet_, object, found));
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
  found_values_.remember(index, sub_index);
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
  transfer_open_ = data[0] != sdo::block_upload_end_answer;
  last_request_ = data;
  requested_at_ = mark();
  send(canopen::default_sdo(node()).request.can_id(), data);
}

std::optional<sdo::Data> Dut::answer() {
  const auto is_answer = [this](const canopen::Frame& frame) {
    return frame.size == 8 && with_id(canopen::default_sdo(node()).response.can_id())(frame);
  };
  const auto found = wait_for(is_answer, milliseconds{settings_.sdo.timeout_ms}, next_answer_);
  if (!found) return std::nullopt;
  next_answer_ = static_cast<Mark>(last_match()) + 1;
  return found->frame.data;
}

std::optional<sdo::Data> Dut::exchange(const sdo::Data& data) {
  next_answer_ = mark();
  request(data);
  return answer();
}

bool Dut::is_answered_to_end() const {
  const auto answers = received_since(requested_at_, with_id(canopen::default_sdo(node()).response.can_id()));
  return !answers.empty() && ends_transfer(last_request_, answers.front().frame.data);
}

void Dut::end_transfer(std::uint16_t index, std::uint8_t sub_index) {
  if (is_answered_to_end()) {
    transfer_open_ = false;
    return;
  }
  sdo::Data abort{sdo::abort_command};
  sdo::put_multiplexer(abort, index, sub_index);
  sdo::put_word(abort, static_cast<std::uint32_t>(canopen::AbortCode::general));
  send(canopen::default_sdo(node()).request.can_id(), abort);
  pass_time(milliseconds{5});
  transfer_open_ = false;
}

// ---- all values at once ----

ConfigurationResult Dut::write_in_order(const std::vector<ConfigurationValue>& values) {
  for (const ConfigurationValue& value : values) found_values_.remember(value.entry.index, value.entry.sub_index);
  const ConfigurationHooks hooks{[](std::size_t, std::size_t) {}, [] { return false; }};
  return configure_node(sdo_, plan_configuration(values, &sheet_), hooks);
}

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
  for (std::string& left : found_values_.restore(parameters, true)) warn(std::move(left));
  for (const std::uint8_t sub_index : verified) {
    const auto found = wanted.find({verify_configuration, sub_index});
    if (found == wanted.end() || upload(verify_configuration, sub_index).bytes == found->second) continue;
    if (!command(verify_configuration, sub_index, found->second).done()) {
      warn(label(verify_configuration, sub_index) + " could not be restored");
    }
  }
}

// ---- NMT ----

Dut::Match Dut::error_control() const { return with_id(0x700U + node().value()); }

Dut::Match Dut::boot_up() const {
  return [id = 0x700U + node().value()](const canopen::Frame& frame) {
    return with_id(id)(frame) && frame.size == 1 && frame.data[0] == 0;
  };
}

Dut::Match Dut::heartbeat() const {
  return [id = 0x700U + node().value()](const canopen::Frame& frame) {
    return with_id(id)(frame) && frame.size == 1 && frame.data[0] != 0;
  };
}

void Dut::nmt(NmtCommand command) {
  const bool resets = command == NmtCommand::reset_node || command == NmtCommand::reset_communication;
  if (resets) found_values_.remember_before_reset();
  state_changed_ = true;
  commanded_ = state_after(command);
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
  if (is_readable(producer_heartbeat)) {
    const std::uint64_t period = read_number(producer_heartbeat);
    if (period == 0 || period > watched_heartbeat_ms) {
      if (!is_writable(producer_heartbeat)) return period != 0;
      write(producer_heartbeat, 0, watched_heartbeat_ms);
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

void Dut::name_frames(std::span<const SeenFrame> seen) {
  for (const SeenFrame& one : seen) {
    const auto found = std::ranges::find_if(frames(), [&](const SeenFrame& other) {
      return other.at == one.at && other.sent == one.sent && other.frame == one.frame;
    });
    if (found != frames().end()) failed_frames_.push_back(static_cast<Mark>(found - frames().begin()));
  }
}

void Dut::name_transfer(std::uint16_t index, std::uint8_t sub_index) {
  const std::vector<std::size_t> found = last_transfer(frames(), node(), index, sub_index);
  failed_frames_.insert(failed_frames_.end(), found.begin(), found.end());
}

void Dut::fail(std::string expected, std::string got, std::vector<EntryAddress> failed_entries) {
  failed_ = mark();
  throw CaseEnd{Verdict::failed, {}, std::move(expected), std::move(got), {}, std::move(failed_entries)};
}
void Dut::fail_by_sheet(AnyRule rule, std::string expected, std::string got) {
  failed_ = mark();
  throw CaseEnd{Verdict::failed, {}, std::move(expected), std::move(got), rule};
}
void Dut::not_applicable(std::string reason) { throw CaseEnd{Verdict::not_applicable, std::move(reason), {}, {}}; }
void Dut::inconclusive(std::string reason) { inconclusive(Condition::none, std::move(reason)); }
void Dut::inconclusive(Condition condition, std::string reason) {
  if (condition == Condition::stimulus && stimuli_.command_failed()) reason += "; the command of --stimulus failed";
  throw CaseEnd{Verdict::inconclusive, std::move(reason), {}, {}, {}, {}, condition};
}

void Dut::need_part(std::string_view name) {
  if (std::ranges::find(settings_.omitted, name) == settings_.omitted.end()) return;
  not_applicable(fmt::format("the composition of the program omits it: canopen::without<canopen::part::{}>", name));
}

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
    outcome.code = canopen::abort_code_from(sdo::word_of(*data));
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

bool Dut::is_within(std::uint64_t measured, std::uint64_t low, std::uint64_t high) const {
  const std::uint64_t wider = tolerance().count();
  return measured + wider >= low && measured <= high + wider;
}

void Dut::expect_times(std::span<const std::uint64_t> measured, std::uint64_t low, std::uint64_t high,
                       const std::string& what) {
  const auto missed = static_cast<std::size_t>(
      std::ranges::count_if(measured, [&](std::uint64_t time) { return !is_within(time, low, high); }));
  if (!simulated() && missed != 0 && missed * 2 < measured.size()) {
    inconclusive(Condition::punctual,
                 fmt::format("{}: {} of {} are not {} to {}: the computer of the device may have been busy", what,
                             missed, measured.size(), milliseconds_text(low), milliseconds_text(high)));
  }
  for (const std::uint64_t time : measured) expect_time(time, low, high, what);
}

void Dut::expect_time(std::uint64_t measured, std::uint64_t low, std::uint64_t high, const std::string& what) {
  const std::uint64_t wider = tolerance().count();
  if (is_within(measured, low, high)) return;
  const std::uint64_t misses = measured < low ? low - measured : measured - high;
  const auto is_explained = [&] { return misses <= lag() + device_lag() + wider; };
  if (!is_explained()) measure_device_lag();
  if (is_explained()) {
    inconclusive(Condition::punctual,
                 fmt::format("{}: measured {}, but the test was late by {}, the device by {}", what,
                             milliseconds_text(measured), milliseconds_text(lag()), milliseconds_text(device_lag())));
  }
  fail(fmt::format("{}: {} to {}", what, milliseconds_text(low), milliseconds_text(high)), milliseconds_text(measured));
}

Duration Dut::tolerance() const { return settings_.tolerance; }

// ---- for the runner ----

void Dut::begin_case(const CaseRow& row) {
  clear_frames();
  warnings_.clear();
  next_answer_ = 0;
  failed_.reset();
  failed_frames_.clear();
  commanded_.reset();
  case_began_ = now();
  random_.seed(seed_of(settings_.seed, row.id));
  stimuli_.begin_case(row.id);
}

std::optional<std::string> Dut::unmet_error_free() {
  if (!is_readable(error_register)) return std::nullopt;
  const SdoOutcome outcome = upload(error_register);
  if (!outcome.done() || number_of(outcome.bytes) == 0) return std::nullopt;
  return fmt::format("1001h:00 is {:02X}h: the device has an error, which may change its NMT state (1029h)",
                     number_of(outcome.bytes));
}

std::optional<std::string> Dut::unmet_state() {
  if (!commanded_) return std::nullopt;
  std::optional<NmtState> found;
  try {
    if (commanded_ == NmtState::stopped || watch_state()) found = state();
  } catch (const CaseEnd&) {
    return std::nullopt;  // 1017h cannot be used as the EDS says: a case reports it
  }
  if (!found || found == commanded_) return std::nullopt;
  std::string reason = fmt::format("the device is {}, not {} after the NMT command", canopen::to_text(*found),
                                   canopen::to_text(*commanded_));
  if (const auto error = unmet_error_free()) reason += "; " + *error;
  return reason;
}

/// No case proves anything while responses come at the end of the SDO timeout or after it.
std::optional<std::string> Dut::too_late_for_sdo() const {
  const std::uint64_t timeout = std::uint64_t{settings_.sdo.timeout_ms} * 1000;
  const std::uint64_t longest = std::max(lag(), slowest_response_of_case());
  if (longest <= timeout / 2) return std::nullopt;
  return fmt::format("a response was received after {}, the timeout is {}: give a longer --timeout",
                     milliseconds_text(longest), milliseconds_text(timeout));
}

std::optional<std::string> Dut::late() const {
  constexpr std::uint64_t may_be_late = 20'000;
  if (lag() + device_lag() <= may_be_late) return std::nullopt;
  return fmt::format("the computer of the test or of the device is too slow or too busy: more than {} late",
                     milliseconds_text(may_be_late));
}

/// Reads 1000h:00 several times. The time of each response is measured.
void Dut::measure_device_lag() {
  if (commanded_ == NmtState::stopped) return;
  constexpr unsigned requests = 20;
  for (unsigned i = 0; i < requests; ++i) {
    if (!upload(device_type).done()) return;
    pass_time(milliseconds{5});
  }
}

/// Requests the state by node guarding. The toggle bit of two answers differs, that of two heartbeats does not.
bool Dut::answers_guarding() {
  constexpr Duration to_answer = milliseconds{50};
  std::uint8_t toggled = 0;
  for (unsigned i = 0; i < 2; ++i) {
    const Mark since = mark();
    send_remote(0x700U + node().value(), 1);
    const auto seen = wait_for(error_control(), to_answer, since);
    if (!seen || seen->frame.size != 1) return false;
    toggled = static_cast<std::uint8_t>(toggled ^ seen->frame.data[0]);
  }
  constexpr std::uint8_t toggle_bit = 0x80;
  return (toggled & toggle_bit) != 0;
}

/// Finds out once, by node guarding, whether the bus carries remote frames. A device may answer only while life
/// guarding is configured.
void Dut::probe_remote_frames() {
  if (remote_frames_probed_ || settings_.level == Level::read || !has(guard_time)) return;
  remote_frames_probed_ = true;
  constexpr std::uint64_t time_ms = 2000, factor = 10;
  if (is_writable(producer_heartbeat) && !download(producer_heartbeat, 0, std::uint64_t{0}).done()) return;
  remote_frames_carried_ = answers_guarding();
  if (remote_frames_carried_ || !is_writable(guard_time) || !is_writable(life_time_factor)) return;
  if (!download(guard_time, 0, time_ms).done() || !download(life_time_factor, 0, factor).done()) return;
  remote_frames_carried_ = answers_guarding();
}

std::optional<Unmet> Dut::unmet_remote_frames(const CaseRow& row) {
  if (!includes(row.relies_on, Condition::remote_frames) || settings_.simulated) return std::nullopt;
  if (!remote_frames_carried_) probe_remote_frames();
  if (remote_frames_carried_) return std::nullopt;
  return Unmet{Condition::remote_frames,
               "no remote frame was answered in this run: the bus may not carry remote frames"};
}

std::optional<Unmet> Dut::unmet_condition(const CaseRow& row) {
  const auto unmet = [&](Condition condition, std::optional<std::string> reason) -> std::optional<Unmet> {
    if (!reason) return std::nullopt;
    return Unmet{condition, std::move(*reason)};
  };
  if (auto found = unmet(Condition::punctual, too_late_for_sdo())) return found;
  if (auto found = unmet_remote_frames(row)) return found;
  if (includes(row.relies_on, Condition::state)) {
    if (auto found = unmet(Condition::state, unmet_state())) return found;
  }
  if (includes(row.relies_on, Condition::error_free)) {
    if (auto found = unmet(Condition::error_free, unmet_error_free())) return found;
  }
  if (includes(row.relies_on, Condition::punctual)) {
    if (!late()) measure_device_lag();
    if (auto found = unmet(Condition::punctual, late())) return found;
  }
  return std::nullopt;
}

bool Dut::responds() {
  sdo_.set_timeout(std::max(settings_.sdo.timeout_ms, restore_timeout_ms));
  const SdoOutcome outcome = sdo_.upload(device_type, 0);
  sdo_.set_timeout(settings_.sdo.timeout_ms);
  return outcome.end != SdoEnd::no_answer;
}

bool Dut::has_sent_response() const {
  return !received_since(0, with_id(canopen::default_sdo(node()).response.can_id())).empty();
}

bool Dut::has_twin() {
  constexpr unsigned tries = 3;
  const Match response = with_id(canopen::default_sdo(node()).response.can_id());
  for (unsigned i = 0; i < tries; ++i) {
    for (const std::uint16_t index : {device_type, error_register}) {
      sdo::Data initiate{0x40};
      sdo::put_multiplexer(initiate, index, 0);
      request(initiate);
      const std::size_t responses = collect(response, milliseconds{50}).size();
      end_transfer(index, 0);
      if (responses < 2) return false;
    }
  }
  return true;
}

std::optional<canopen::NodeId> Dut::other_boot_up() const {
  for (const SeenFrame& seen : frames()) {
    const std::uint32_t id = seen.frame.id & 0x7FU;
    const bool is_boot_up =
        !seen.sent && id != 0 && with_id(0x700U + id)(seen.frame) && seen.frame.size == 1 && seen.frame.data[0] == 0;
    if (is_boot_up && id != node().value()) return canopen::NodeId{static_cast<std::uint8_t>(id)};
  }
  return std::nullopt;
}

void Dut::start_again() {
  if (settings_.level == Level::read) return;
  // A reset node also resets the application. Without the permission to write it, it could not be restored.
  nmt(allowed(Permission::application) ? NmtCommand::reset_node : NmtCommand::reset_communication);
  const Mark since = mark();
  (void)wait_for(boot_up(), milliseconds{2000}, since);
  pass_time(to_follow);
}

/// Call it before frames are received that do not belong to the case.
void Dut::set_failed_frames(CaseResult& result) {
  if (!failed_) return;
  const std::span<const SeenFrame> until_failure = std::span{frames()}.first(*failed_);
  if (failed_frames_.empty()) {
    for (const EntryAddress& entry : entries_in(result.expected + ' ' + result.got)) {
      const std::vector<std::size_t> found =
          last_transfer(until_failure, node(), entry.index, entry.sub_index.value_or(0));
      failed_frames_.insert(failed_frames_.end(), found.begin(), found.end());
    }
  }
  std::ranges::sort(failed_frames_);
  failed_frames_.erase(std::unique(failed_frames_.begin(), failed_frames_.end()), failed_frames_.end());
  result.failed_frames = failed_frames_;
  result.refused_writes = refused_writes(until_failure, node(), failed_frames_);
}

void Dut::end_case(CaseResult& result) {
  if (transfer_open_) end_transfer();
  result.began = case_began_;
  result.took = now() - case_began_;
  result.lag = lag();
  result.warnings = std::move(warnings_);
  result.frames = frames();
  result.until_failure = failed_;
  set_failed_frames(result);
  result.not_restored = restore_changed();
}

std::vector<std::string> Dut::find_state() {
  if (settings_.level == Level::read) return {};
  try {
    if (watch_state()) found_state_ = state();
  } catch (const CaseEnd&) {
    // 1017h cannot be used as the EDS says: a case will report it.
  }
  return restore_changed();
}

std::vector<std::string> Dut::restore_changed() {
  const Uninterrupted uninterrupted;
  sdo_.set_timeout(std::max(settings_.sdo.timeout_ms, restore_timeout_ms));
  if (transfer_open_) end_transfer();
  if (state_changed_) enter(canopen::NmtState::pre_operational);
  std::vector<std::string> left = found_values_.restore_changed(allowed(Permission::application));
  if (state_changed_ && found_state_ && *found_state_ != canopen::NmtState::pre_operational) enter(*found_state_);
  state_changed_ = false;
  sdo_.set_timeout(settings_.sdo.timeout_ms);
  return left;
}

}  // namespace edsc::conform
