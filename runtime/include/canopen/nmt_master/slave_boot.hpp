/// Boot-up of one slave as a state machine: identity, software, configuration, heartbeat time (CiA 302-2, boot NMT
/// slave).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/nmt_master/boot_status.hpp"
#include "canopen/nmt_master/concise_dcf.hpp"
#include "canopen/nmt_master/heartbeat_rate.hpp"
#include "canopen/nmt_master/identity_check.hpp"
#include "canopen/nmt_master/network_list.hpp"
#include "canopen/sdo/sdo_queue.hpp"

namespace canopen {

/// What follows after a step of the boot-up.
enum class BootNext : std::uint8_t {
  request,        ///< the next request of the boot-up, or nothing
  finish,         ///< the boot-up has ended, with a result
  retry,          ///< the slave does not respond; the result says to what
  reset,          ///< the slave is reset: its default values have been restored
  configure,      ///< the application configures the slave
  watch,          ///< its heartbeat time has been written: error control is started with its next heartbeat
  error_control,  ///< error control is started
};

/// The master sends the requests, starts error control and knows the time. The entry of the slave in the network list
/// is passed to each call.
class SlaveBoot {
 public:
  enum class Step : std::uint8_t {
    idle,                    ///< not started, or ended
    waiting,                 ///< for a boot-up message, or for the next attempt without one
    identifying,             ///< reading the number `check_`, or about to read it
    checking_software,       ///< reading 1F56h:01
    checking_configuration,  ///< reading date or time of 1020h
    restoring,               ///< writing "load" to 1011h
    downloading,             ///< writing an entry of the concise DCF
    reading_back,            ///< an entry of the concise DCF
    configuring,             ///< by the application
    reading_heartbeat_time,  ///< of 1017h
    writing_heartbeat_time,
    starting_error_control,  ///< waiting for the first heartbeat or guarding response
  };

  [[nodiscard]] Step step() const { return step_; }
  void enter(Step next) { step_ = next; }
  void end() {
    step_ = Step::idle;
    restored_ = false;
  }

  /// Whether the slave is booting: each response must have its request, and another boot-up message is a restart.
  [[nodiscard]] bool is_supervised() const { return step_ >= Step::identifying; }

  /// Whether the slave is in a step before error control.
  [[nodiscard]] bool is_before_error_control() const {
    return step_ >= Step::identifying && step_ < Step::starting_error_control;
  }

  /// Returns when waiting for the slave ends, in `waiting` and `starting_error_control`.
  [[nodiscard]] TimePoint deadline() const { return deadline_; }
  void set_deadline(TimePoint time) { deadline_ = time; }
  [[nodiscard]] bool has_deadline() const { return step_ == Step::waiting || step_ == Step::starting_error_control; }

  /// Starts again from the beginning. The response to a request that is still in the queue will be ignored.
  void restart() {
    const bool asked = asked_;
    *this = SlaveBoot{};
    asked_ = dropped_ = asked;
  }

  /// Waits for the boot-up message, or for the next attempt.
  void wait(TimePoint until) {
    step_ = Step::waiting;
    answered_ = false;
    ignore_response();
    deadline_ = until;
  }

  /// Starts with the first number of the identity.
  void identify() {
    step_ = Step::identifying;
    answered_ = false;
    ignore_response();
    check_ = 0;
  }

  /// Ignores the response to a request that is in the queue.
  void ignore_response() { dropped_ = asked_; }

  // What is known of the slave

  /// Its boot-up message has been received: it is served before slaves that do not respond.
  void report_boot_up() {
    booted_up_ = true;
    silent_ = false;
    boot_up_expected_ = false;
  }
  /// The master has reset it.
  void expect_boot_up() { boot_up_expected_ = true; }
  [[nodiscard]] bool expects_boot_up() const { return boot_up_expected_; }
  /// Whether a boot-up message is that of a restart: the slave has already responded in this boot-up.
  [[nodiscard]] bool is_restart() const { return is_supervised() && answered_ && !boot_up_expected_; }

  /// Counts a boot-up that a fault has ended. Returns false if the slave is not to be booted again because of it.
  [[nodiscard]] bool may_boot_again() { return disturbed_ < max_disturbed && ++disturbed_ < max_disturbed; }
  /// The boot-up has succeeded.
  void report_complete(TimePoint now) { since_ = now; }
  /// Whether it did so more than ten seconds ago.
  [[nodiscard]] bool has_run_long(TimePoint now) const { return now - since_ > std::chrono::seconds{10}; }
  /// The faults of earlier boot-ups no longer count.
  void forget_faults() { disturbed_ = 0; }
  void report_reset() {
    was_reset_ = true;
    booted_up_ = false;
    restored_ = false;
  }
  /// It is being reset after its default values have been restored, and configured afterwards.
  void report_restored() { restored_ = true; }
  void report_silence() {
    booted_up_ = false;
    silent_ = true;
  }

  [[nodiscard]] bool booted_up() const { return booted_up_; }
  [[nodiscard]] bool was_reset() const { return was_reset_; }
  void set_reset(bool reset) { was_reset_ = reset; }

  /// Whether the slave has not responded, so that it may be in Stopped and gets a command. One that may have been
  /// Operational since before the start of the master does not get any.
  [[nodiscard]] bool may_be_stopped(const NmtSlave& slave) const {
    return silent_ && !(slave.has(slave_assignment::keep_alive) && !was_reset_);
  }

  /// Whether the slave may have been Operational since before the master's start; checked before anything is changed.
  [[nodiscard]] bool may_be_kept_alive(const NmtSlave& slave) const {
    return slave.has(slave_assignment::keep_alive) && !was_reset_ && !booted_up_;
  }

  /// Whether 1020h had the expected date and time at this boot-up, so that the configuration was not written.
  [[nodiscard]] bool configuration_is_current() const { return is_current_; }

  // SDO

  /// Whether the boot-up continues with a request, which is not in the queue yet.
  [[nodiscard]] bool wants_sdo() const {
    switch (step_) {
      case Step::identifying:
      case Step::checking_software:
      case Step::checking_configuration:
      case Step::restoring:
      case Step::downloading:
      case Step::reading_back:
      case Step::reading_heartbeat_time:
      case Step::writing_heartbeat_time: return !asked_;
      case Step::idle:
      case Step::waiting:
      case Step::configuring:
      case Step::starting_error_control: return false;
    }
    return false;
  }

  /// Returns the present request, without the function that receives its response.
  [[nodiscard]] SdoRequest request(const NmtSlave& slave) {
    SdoRequest request;
    std::tie(request.index, request.sub_index) = entry(slave);
    request.download = step_ == Step::restoring || step_ == Step::downloading || step_ == Step::writing_heartbeat_time;
    if (step_ == Step::downloading) {
      request.bytes = *dcf_.data(slave.concise_dcf);
    } else if (step_ == Step::restoring) {
      request.bytes = load_signature;
    } else if (request.download) {
      request.bytes = std::span{number_}.first(2);
    } else if (step_ == Step::reading_back) {
      read_back_ = *dcf_.data(slave.concise_dcf);
      number_ = {};
      is_equal_ = true;
      if (read_back_.size() > number_.size()) {
        request.sink = {compare, this};
      } else {
        request.memory = number_;
      }
    } else {
      request.memory = number_;
    }
    return request;
  }
  void set_asked(bool queued) { asked_ = queued; }

  /// Processes the response to the present request. `result` is set if the boot-up ends or is tried again.
  [[nodiscard]] BootNext on_answer(const NmtSlave& slave, const SdoAnswer& answer, BootResult& result) {
    asked_ = false;
    if (std::exchange(dropped_, false)) return BootNext::request;
    if (answer.result == AbortCode::timeout) return no_response(slave, answer, result);
    answered_ = true;
    switch (step_) {
      case Step::identifying: return identity_read(slave, answer, result);
      case Step::checking_software: return software_read(slave, answer, result);
      case Step::checking_configuration: return configuration_read(slave, answer, result);
      case Step::restoring:
        if (answer.result != ok) return failure(slave, BootStatus::configuration, answer, result);
        return BootNext::reset;
      case Step::downloading:
        if (answer.result != ok) return failure(slave, BootStatus::configuration, answer, result);
        dcf_.advance(slave.concise_dcf);
        return download(slave, result);
      case Step::reading_back: return value_read_back(slave, answer, result);
      case Step::reading_heartbeat_time: return heartbeat_time_read(slave, answer);
      case Step::writing_heartbeat_time: return heartbeat_time_written(slave, answer, result);
      case Step::idle:
      case Step::waiting:
      case Step::configuring:
      case Step::starting_error_control: break;
    }
    return BootNext::request;
  }

  /// Continues after the configuration by the application.
  [[nodiscard]] BootNext on_configured(const NmtSlave& slave) {
    if (!slave.beats()) return BootNext::error_control;
    step_ = Step::reading_heartbeat_time;
    return BootNext::request;
  }

  // Error control

  /// Waits for the first heartbeat or guarding response until then.
  void start_error_control(TimePoint now, TimePoint until) {
    step_ = Step::starting_error_control;
    deadline_ = until;
    since_ = now;
    rate_.begin(rate_.producer_time());
  }

  /// The slave has got a command.
  void report_command() { rate_.expect_state_change(); }

  /// Processes a heartbeat while error control is started. The first one begins the measurement of their rate.
  void report_heartbeat(NmtState state, TimePoint now) {
    const bool is_first = !rate_.begun();
    rate_.report(state, now);
    if (is_first && rate_.is_measured()) deadline_ = rate_.end();
  }

  /// Checks whether error control is complete, after the slave has been heard, or if it is not monitored. Returns how
  /// the boot-up ends; empty if it goes on.
  [[nodiscard]] std::optional<BootResult> check_error_control(const NmtSlave& slave, TimePoint now) {
    if (!slave.beats() || !rate_.is_measured()) {
      deadline_ = since_ + settling_time;
      if (now < deadline_) return std::nullopt;
    } else if (!rate_.begun()) {
      return now < deadline_ ? std::nullopt : std::optional{BootResult{BootStatus::no_heartbeat}};
    }
    switch (rate_.verdict(now)) {
      case HeartbeatRate::Verdict::open: return std::nullopt;
      case HeartbeatRate::Verdict::right: return BootResult{};
      case HeartbeatRate::Verdict::states: return BootResult{BootStatus::heartbeat_states};
      case HeartbeatRate::Verdict::wrong: break;
    }
    const std::uint32_t seen = rate_.measured_time(now);
    if (rate_.repeat()) {
      deadline_ = rate_.begun() ? rate_.end() : now + from_milliseconds(rate_.producer_time()) * 2u;
      return std::nullopt;
    }
    return BootResult{BootStatus::heartbeat_rate, ok, 0x1017, 0, rate_.producer_time(), seen};
  }

 private:
  /// Time between the last response of a slave and its start, in which a late response is a fault.
  static constexpr Duration settling_time = from_milliseconds(20);
  static constexpr std::uint8_t max_disturbed = 3;  ///< boot-ups that a fault ends, in a row

  static constexpr std::size_t checks = std::size(identity_checks);
  static constexpr std::array<std::uint8_t, 4> load_signature{'l', 'o', 'a', 'd'};

  /// Returns the index and sub-index of the present request.
  [[nodiscard]] std::pair<std::uint16_t, std::uint8_t> entry(const NmtSlave& slave) const {
    switch (step_) {
      case Step::identifying: return {identity_checks[check_].index, identity_checks[check_].sub_index};
      case Step::checking_software: return {std::uint16_t{0x1F56}, std::uint8_t{1}};
      case Step::checking_configuration: return {std::uint16_t{0x1020}, configuration_checks[check_].sub_index};
      case Step::restoring: return {std::uint16_t{0x1011}, slave.restored_parameters};
      case Step::downloading:
      case Step::reading_back: return {dcf_.index(slave.concise_dcf), dcf_.sub_index(slave.concise_dcf)};
      case Step::reading_heartbeat_time:
      case Step::writing_heartbeat_time:
      case Step::idle:
      case Step::waiting:
      case Step::configuring:
      case Step::starting_error_control: break;
    }
    return {std::uint16_t{0x1017}, std::uint8_t{0}};
  }

  /// The boot-up ends because of a failed transfer.
  [[nodiscard]] BootNext failure(const NmtSlave& slave, BootStatus status, const SdoAnswer& answer,
                                 BootResult& result) const {
    const auto [index, sub_index] = entry(slave);
    result = {status, answer.result, index, sub_index};
    return BootNext::finish;
  }

  /// The boot-up ends because a number is not the expected one, or could not be read.
  [[nodiscard]] BootNext difference(const NmtSlave& slave, BootStatus status, const SdoAnswer& answer,
                                    std::uint32_t expected, BootResult& result) const {
    const BootNext next = failure(slave, status, answer, result);
    result.expected = expected;
    result.seen = little_endian_number(answer.data);
    return next;
  }

  [[nodiscard]] BootNext no_response(const NmtSlave& slave, const SdoAnswer& answer, BootResult& result) const {
    (void)failure(slave, BootStatus::no_response, answer, result);
    return BootNext::retry;
  }

  // Identity: 1000h, then the numbers of 1018h that the network list has

  [[nodiscard]] BootNext identity_read(const NmtSlave& slave, const SdoAnswer& answer, BootResult& result) {
    const IdentityCheck& check = identity_checks[check_];
    const bool answered = answer.result == ok;
    if (check_ == 0 && !answered) return no_response(slave, answer, result);
    const std::uint32_t expected = slave.*check.expected;
    if (expected != 0 && (!answered || little_endian_number(answer.data) != expected)) {
      return difference(slave, check.failure, answer, expected, result);
    }
    do {
      ++check_;
    } while (check_ < checks && slave.*identity_checks[check_].expected == 0);
    if (check_ < checks) return BootNext::request;
    silent_ = false;
    if (may_be_kept_alive(slave)) return BootNext::error_control;
    return check_software(slave, result);
  }

  // Software version

  [[nodiscard]] BootNext check_software(const NmtSlave& slave, BootResult& result) {
    if (!slave.has(slave_assignment::software_version)) return check_configuration(slave, result);
    if (slave.software == 0) {
      result = {BootStatus::software_unknown};
      return BootNext::finish;
    }
    step_ = Step::checking_software;
    return BootNext::request;
  }

  /// A slave to be kept alive is not updated.
  [[nodiscard]] BootNext software_read(const NmtSlave& slave, const SdoAnswer& answer, BootResult& result) {
    if (answer.result != ok) return failure(slave, BootStatus::software_unknown, answer, result);
    if (little_endian_number(answer.data) == slave.software) return check_configuration(slave, result);
    const bool may_update = slave.has(slave_assignment::software_update) && !slave.has(slave_assignment::keep_alive);
    const BootStatus status = may_update ? BootStatus::software_update : BootStatus::software_not_allowed;
    return difference(slave, status, answer, slave.software, result);
  }

  // Configuration: 1020h, the default values, then the concise DCF

  [[nodiscard]] BootNext check_configuration(const NmtSlave& slave, BootResult& result) {
    is_current_ = false;
    check_ = 0;
    const bool is_dated = slave.configuration_date != 0 && slave.configuration_time != 0;
    if (restored_ || !is_dated) return restore(slave, result);
    step_ = Step::checking_configuration;
    return BootNext::request;
  }

  /// A slave without 1020h is configured.
  [[nodiscard]] BootNext configuration_read(const NmtSlave& slave, const SdoAnswer& answer, BootResult& result) {
    const std::uint32_t expected = slave.*configuration_checks[check_].expected;
    if (answer.result != ok || little_endian_number(answer.data) != expected) return restore(slave, result);
    if (++check_ < std::size(configuration_checks)) return BootNext::request;
    is_current_ = true;
    dcf_.begin(slave.concise_dcf);
    return read_back(slave, result);
  }

  /// Restores the default values once, before the configuration is written.
  [[nodiscard]] BootNext restore(const NmtSlave& slave, BootResult& result) {
    const bool wanted = slave.has(slave_assignment::restore) && slave.restored_parameters != 0;
    if (wanted && !std::exchange(restored_, false)) {
      step_ = Step::restoring;
      return BootNext::request;
    }
    dcf_.begin(slave.concise_dcf);
    return download(slave, result);
  }

  /// Continues with the present entry of the concise DCF, or after the last one.
  [[nodiscard]] BootNext download(const NmtSlave& slave, BootResult& result) {
    if (dcf_.at_end()) {
      dcf_.begin(slave.concise_dcf);
      return read_back(slave, result);
    }
    step_ = Step::downloading;
    if (dcf_.data(slave.concise_dcf)) return BootNext::request;
    result = {BootStatus::configuration, AbortCode::length_mismatch};
    return BootNext::finish;
  }

  // The values of the concise DCF are read back

  /// Continues with the present entry of the concise DCF, or after the last one. Entries that are written twice, such
  /// as the number of mapped objects, have the last value.
  [[nodiscard]] BootNext read_back(const NmtSlave& slave, BootResult& result) {
    const ConciseDcfPlace::Dcf dcf = slave.concise_dcf;
    while (slave.read_back && !dcf_.at_end()) {
      if (!dcf_.data(dcf)) {
        result = {BootStatus::configuration, AbortCode::length_mismatch};
        return BootNext::finish;
      }
      if (!is_command(dcf_.index(dcf)) && !dcf_.is_written_again(dcf)) {
        step_ = Step::reading_back;
        return BootNext::request;
      }
      dcf_.advance(dcf);
    }
    return BootNext::configure;
  }

  /// Whether a write to the object is a command, so that a read does not return the value.
  [[nodiscard]] static constexpr bool is_command(std::uint16_t index) {
    return index == 0x1003 || index == 0x1010 || index == 0x1011 || (index >= 0x1023 && index <= 0x1026) ||
           index == 0x1F25 || (index >= 0x1F50 && index <= 0x1F5A) || index == 0x1F82 || index == 0x1F83;
  }

  /// A slave that has its configuration according to 1020h, but not the values, is configured. A write-only entry
  /// cannot be compared.
  [[nodiscard]] BootNext value_read_back(const NmtSlave& slave, const SdoAnswer& answer, BootResult& result) {
    const bool is_write_only = answer.result == AbortCode::write_only || answer.result == AbortCode::unsupported_access;
    if (is_write_only || has_value(answer)) {
      dcf_.advance(slave.concise_dcf);
      return read_back(slave, result);
    }
    if (std::exchange(is_current_, false)) return restore(slave, result);
    const BootNext next = failure(slave, BootStatus::not_as_written, answer, result);
    result.expected = little_endian_number(read_back_.first(std::min(read_back_.size(), number_.size())));
    result.seen = little_endian_number(number_);
    return next;
  }

  /// Whether the response to a read has the bytes of the concise DCF. The slave may not state the size of a number.
  [[nodiscard]] bool has_value(const SdoAnswer& answer) const {
    if (answer.result != ok || !is_equal_) return false;
    if (read_back_.size() > number_.size()) return true;
    const bool has_size = answer.data.size() == read_back_.size() || !answer.size_known;
    return has_size && std::ranges::equal(std::span{number_}.first(read_back_.size()), read_back_);
  }

  /// Compares a value that is longer than `number_` piece by piece, and keeps its first bytes. A text may be padded
  /// with 00h.
  [[nodiscard]] static AbortCode compare(void* context, std::uint32_t offset, std::span<const std::uint8_t> bytes,
                                         bool last) {
    SlaveBoot& self = *static_cast<SlaveBoot*>(context);
    std::size_t at = offset;
    for (const std::uint8_t byte : bytes) {
      if (byte != (at < self.read_back_.size() ? self.read_back_[at] : 0)) self.is_equal_ = false;
      if (at < self.number_.size()) self.number_[at] = byte;
      ++at;
    }
    if (last && at < self.read_back_.size()) self.is_equal_ = false;
    return ok;
  }

  // Heartbeat time

  /// Two heartbeats within the consumer time tolerate one that is late or lost.
  [[nodiscard]] BootNext heartbeat_time_read(const NmtSlave& slave, const SdoAnswer& answer) {
    const std::uint32_t consumer = slave.heartbeat_time;
    const std::uint32_t producer =
        little_endian_number(answer.data.first(std::min<std::size_t>(answer.data.size(), 2)));
    const bool is_short_enough = producer != 0 && 3 * producer <= 2 * consumer;
    rate_.begin(answer.result == ok ? static_cast<std::uint16_t>(producer) : std::uint16_t{0});
    if (answer.result == ok && is_short_enough) return BootNext::error_control;
    beats_in_time_ = answer.result == ok && producer != 0 && producer < consumer;
    const std::uint32_t wanted = std::max<std::uint32_t>(consumer / 2, 1);
    number_ = {static_cast<std::uint8_t>(wanted), static_cast<std::uint8_t>(wanted >> 8)};
    step_ = Step::writing_heartbeat_time;
    return BootNext::request;
  }

  /// The slave restarts its period. One that rejects the write may keep its own time if that is short enough.
  [[nodiscard]] BootNext heartbeat_time_written(const NmtSlave& slave, const SdoAnswer& answer, BootResult& result) {
    if (answer.result == ok) {
      rate_.begin(static_cast<std::uint16_t>(little_endian_number(std::span{number_}.first(2))));
      return BootNext::watch;
    }
    if (!beats_in_time_) return failure(slave, BootStatus::no_heartbeat, answer, result);
    return BootNext::error_control;
  }

  TimePoint deadline_{};
  TimePoint since_{};  ///< start of error control, or the end of the boot-up
  HeartbeatRate rate_{};
  std::array<std::uint8_t, 4> number_{};  ///< read or written value
  std::span<const std::uint8_t> read_back_{};
  ConciseDcfPlace dcf_{};
  Step step_ = Step::idle;
  std::uint8_t check_ = 0;
  bool asked_ = false;      ///< a request is in the queue
  bool dropped_ = false;    ///< its response will be ignored
  bool booted_up_ = false;  ///< its boot-up message has been received
  bool silent_ = false;     ///< it has not responded
  bool was_reset_ = false;
  bool restored_ = false;       ///< its default values have been restored: it is configured next
  bool is_current_ = false;     ///< 1020h has the expected date and time
  bool beats_in_time_ = false;  ///< 1017h is shorter than the consumer's time
  bool is_equal_ = false;       ///< the value read back is that of the concise DCF so far
  bool answered_ = false;       ///< it has responded since the boot-up has begun
  bool boot_up_expected_ = false;
  std::uint8_t disturbed_ = 0;  ///< boot-ups that a fault has ended, in a row
};

}  // namespace canopen
