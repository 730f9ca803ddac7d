/// LSS master: finds slaves and configures their node-IDs and bit rate (CiA 305), one service at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "canopen/base/clock.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/lss/lss_protocol.hpp"

namespace canopen {

/// How long a master waits for responses. CiA 305 does not define it.
struct LssTimeouts {
  /// A slave responds from its memory; two frames on a loaded bus take most of this time. Identify services always wait
  /// for all of it, because several slaves may respond.
  Duration answer = from_milliseconds(100);
  /// Store configuration: a slave may have to erase a page of flash before it responds.
  Duration store = from_milliseconds(1000);
  /// Each step of Fastscan, at least. It is always waited for in full, because several slaves may respond to the same
  /// request, and becomes twice the longest response time that has been measured; the first step takes 200 ms at least.
  /// Long enough for both frames at 20 kbit/s and more; 10 kbit/s needs 30 ms.
  Duration fastscan_step = from_milliseconds(20);
};

/// Address range of identify remote slave: one product, and ranges that include their limits. A slave compares the
/// upper 16 bits of the revision number.
struct LssAddressRange {
  std::uint32_t vendor_id = 0;
  std::uint32_t product_code = 0;
  std::uint32_t revision_number_low = 0;
  std::uint32_t revision_number_high = 0xFFFF'FFFF;
  std::uint32_t serial_number_low = 0;
  std::uint32_t serial_number_high = 0xFFFF'FFFF;
};

enum class LssOutcome : std::uint8_t {
  done,       ///< successful response, or sent if the service has no response
  refused,    ///< the slave's response is an error: see `error()`
  no_answer,  ///< no slave has responded in time, or the bus had no room
};

/// Start a service, pass in frames and time until the master is no longer `busy()`, then check `outcome()`. A service
/// that is started while busy is not executed and returns false.
template <Bus BusType>
class LssMaster {
 public:
  constexpr explicit LssMaster(BusType& can_bus, LssTimeouts timeouts = {}) : bus_{can_bus}, timeouts_{timeouts} {}

  /// Switches all slaves to this state. No response.
  [[nodiscard]] bool switch_state_global(LssState state, TimePoint now) {
    return begin(lss::Command::switch_state_global, static_cast<std::uint32_t>(state), lss::Command::none, Duration{0},
                 now);
  }

  /// Switches the slave with this address to the configuration state.
  [[nodiscard]] bool switch_state_selective(const LssAddress& address, TimePoint now) {
    if (busy()) return false;
    words_ = {address.vendor_id, address.product_code, address.revision_number, address.serial_number};
    return begin_sequence(lss::Command::select_vendor_id, lss::Command::select_serial_number, lss::Command::selected,
                          now);
  }

  /// Configures the node-ID of the slave in configuration state: 1..127, or 255 to remove it.
  [[nodiscard]] bool configure_node_id(NodeId node_id, TimePoint now) {
    return begin(lss::Command::configure_node_id, node_id.value(), now);
  }

  /// Configures the bit rate of the slave in configuration state. It is used after `activate_bit_timing`, or after it
  /// has been stored and power has been switched off and on.
  [[nodiscard]] bool configure_bit_timing(LssBitTiming bit_timing, TimePoint now) {
    const std::uint32_t word = bit_timing.table | static_cast<std::uint32_t>(bit_timing.index) << 8;
    return begin(lss::Command::configure_bit_timing, word, now);
  }

  /// Activates the new bit rate of all slaves in configuration state. No response. They continue for one delay and
  /// are silent for another one, during which the master's own controller must switch over. Done when both delays
  /// have elapsed.
  [[nodiscard]] bool activate_bit_timing(std::chrono::duration<std::uint16_t, std::milli> switch_delay, TimePoint now) {
    return begin(lss::Command::activate_bit_timing, switch_delay.count(), lss::Command::none,
                 Duration{switch_delay.count() * 2000u}, now);
  }

  /// Makes the slave in configuration state store its node-ID and bit rate.
  [[nodiscard]] bool store_configuration(TimePoint now) {
    return begin(lss::Command::store_configuration, 0, lss::Command::store_configuration, timeouts_.store, now);
  }

  /// Inquires a value of the slave in configuration state; `value()` returns it.
  [[nodiscard]] bool inquire_vendor_id(TimePoint now) { return begin(lss::Command::inquire_vendor_id, 0, now); }
  [[nodiscard]] bool inquire_product_code(TimePoint now) { return begin(lss::Command::inquire_product_code, 0, now); }
  [[nodiscard]] bool inquire_revision_number(TimePoint now) {
    return begin(lss::Command::inquire_revision_number, 0, now);
  }
  [[nodiscard]] bool inquire_serial_number(TimePoint now) { return begin(lss::Command::inquire_serial_number, 0, now); }
  [[nodiscard]] bool inquire_node_id(TimePoint now) { return begin(lss::Command::inquire_node_id, 0, now); }

  /// Asks whether slaves with such an address exist, in any state. Done: at least one does.
  [[nodiscard]] bool identify_remote_slave(const LssAddressRange& range, TimePoint now) {
    if (busy()) return false;
    words_ = {range.vendor_id,         range.product_code,      range.revision_number_low, range.revision_number_high,
              range.serial_number_low, range.serial_number_high};
    return begin_sequence(lss::Command::identify_vendor_id, lss::Command::identify_serial_number_high,
                          lss::Command::identified, now);
  }

  /// Asks whether slaves without node-ID exist. Done: at least one does.
  [[nodiscard]] bool identify_non_configured_remote_slave(TimePoint now) {
    return begin(lss::Command::identify_non_configured, 0, lss::Command::identified_non_configured, answer_time(), now);
  }

  /// Finds one slave without node-ID and switches it to the configuration state; `address()` is its address. If there
  /// are several slaves, it finds the one with the lowest numbers. 133 steps. A step without a response is repeated
  /// once, because a frame may be lost or late. A number that no slave confirms was changed by late responses: the scan
  /// starts again with longer steps, up to four times. Inquire the address of the slave to be certain.
  [[nodiscard]] bool fastscan(TimePoint now) { return fastscan({}, 0, now); }

  /// The same for slaves whose first `known` numbers, 0..4, are those of `address`: 33 steps fewer for each, one more
  /// to check it.
  [[nodiscard]] bool fastscan(const LssAddress& address, std::uint8_t known, TimePoint now) {
    if (busy() || known > 4) return false;
    from_ = {address.vendor_id, address.product_code, address.revision_number, address.serial_number};
    known_ = known;
    is_above_ = false;
    restarts_ = 0;
    step_ = std::max(timeouts_.fastscan_step, std::min(slowest_ * 2u, longest_step));
    begin_scan();
    ask(now);
    return true;
  }

  /// Finds the slave without node-ID with the lowest address above this one, and switches it to the configuration
  /// state. With the address found last, it finds the next slave, as long as all slaves remain without node-ID; they
  /// must be in the waiting state. Up to 140 steps more than a Fastscan.
  [[nodiscard]] bool fastscan_above(const LssAddress& address, std::uint8_t known, TimePoint now) {
    if (!fastscan(address, known, now)) return false;
    is_above_ = true;
    branch_ = 4;
    climb();
    return true;
  }

  /// Accepts a response; other frames are ignored.
  void on_frame(const Frame& frame, TimePoint now) {
    if (!busy() || to_send_ <= last_ || !lss::is_lss(frame, lss::response_id)) return;
    if (answer_ == lss::Command::none || frame.data[0] != static_cast<std::uint8_t>(answer_)) return;
    if (!answered_) measure(now);
    answered_ = true;
    if (several_may_answer()) return;
    value_ = lss::word_of(frame);
    finish(reports_error() && frame.data[1] != 0 ? LssOutcome::refused : LssOutcome::done);
  }

  /// Sends what could not be sent yet, continues a Fastscan, and ends a service whose response has not been received.
  void on_time(TimePoint now) {
    flush(now);
    if (!busy() || now < deadline_) return;
    if (to_send_ <= last_) return finish(LssOutcome::no_answer);
    if (scanning()) return answered_ || is_repeated_ || confirming_ ? next_step(now) : repeat(now);
    finish(answered_ || answer_ == lss::Command::none ? LssOutcome::done : LssOutcome::no_answer);
  }

  /// Returns when `on_time` is next due.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    return busy() ? std::optional{deadline_} : std::nullopt;
  }

  [[nodiscard]] bool busy() const { return busy_; }

  /// Returns how the last service ended.
  [[nodiscard]] LssOutcome outcome() const { return outcome_; }

  /// Returns why the slave has rejected the service.
  [[nodiscard]] LssError error() const {
    return {static_cast<std::uint8_t>(value_ & 0xFF), static_cast<std::uint8_t>(value_ >> 8 & 0xFF)};
  }

  /// Returns the value of a successful inquiry.
  [[nodiscard]] std::uint32_t value() const { return value_; }

  /// Returns the address of the slave that a Fastscan has found.
  [[nodiscard]] LssAddress address() const { return {words_[0], words_[1], words_[2], words_[3]}; }

 private:
  [[nodiscard]] bool begin(lss::Command command, std::uint32_t word, TimePoint now) {
    return begin(command, word, command, answer_time(), now);
  }

  /// Returns the time for a response: longer if one took longer than half of `LssTimeouts::answer`.
  [[nodiscard]] Duration answer_time() const { return std::max(timeouts_.answer, slowest_ * 2u); }

  [[nodiscard]] bool begin(lss::Command command, std::uint32_t word, lss::Command answer, Duration wait,
                           TimePoint now) {
    if (busy()) return false;
    words_[0] = word;
    start(command, command, answer, wait, now);
    return true;
  }

  [[nodiscard]] bool begin_sequence(lss::Command first, lss::Command last, lss::Command answer, TimePoint now) {
    start(first, last, answer, answer_time(), now);
    return true;
  }

  /// Sends the commands `first`..`last`, each with its own word, then waits.
  void start(lss::Command first, lss::Command last, lss::Command answer, Duration wait, TimePoint now) {
    first_ = to_send_ = static_cast<std::uint8_t>(first);
    last_ = static_cast<std::uint8_t>(last);
    answer_ = answer;
    wait_ = wait;
    value_ = 0;
    answered_ = false;
    is_repeated_ = false;
    busy_ = true;
    deadline_ = now + (wait.count() != 0 ? wait : timeouts_.answer);
    flush(now);
  }

  /// Sends pending frames. The wait starts when the bus has accepted the last one.
  void flush(TimePoint now) {
    if (!busy() || to_send_ > last_) return;
    for (; to_send_ <= last_; ++to_send_) {
      if (!bus_.send(request())) return;
    }
    deadline_ = now + wait_;
    if (!is_repeated_) asked_at_ = now;
    sent_at_ = now;
    if (wait_.count() == 0) finish(LssOutcome::done);
  }

  [[nodiscard]] Frame request() const {
    const auto command = static_cast<lss::Command>(to_send_);
    if (!scanning()) return lss::make_frame(lss::request_id, command, words_[to_send_ - first_]);
    const bool beginning = bit_ == lss::fastscan_reset;
    const std::uint32_t word = branch_ != no_branch && !confirming_ ? asked_ : words_[number_];
    Frame frame = lss::make_frame(lss::request_id, command, beginning ? 0 : word);
    frame.data[5] = bit_;
    frame.data[6] = number_;
    frame.data[7] = confirming_ ? (number_ + 1) & 3 : number_;
    return frame;
  }

  void finish(LssOutcome outcome) {
    busy_ = false;
    confirming_ = false;
    branch_ = no_branch;
    outcome_ = outcome;
  }

  [[nodiscard]] bool reports_error() const {
    return answer_ == lss::Command::configure_node_id || answer_ == lss::Command::configure_bit_timing ||
           answer_ == lss::Command::store_configuration;
  }

  /// Whether to wait for the full time, so that a response to this request is not taken for one to the next.
  [[nodiscard]] bool several_may_answer() const {
    return answer_ == lss::Command::identified || answer_ == lss::Command::identified_non_configured;
  }

  /// Notes how long a slave needs to respond. In a Fastscan, a slave that needs longer than half a step may respond to
  /// the next step: the steps become longer from this one on.
  void measure(TimePoint now) {
    const Duration time = now - asked_at_;
    is_measured_ = true;
    slowest_ = std::max(slowest_, std::min(time, longest_step));
    if (!scanning()) return;
    step_ = std::max(step_, std::min(time * 2u, longest_step));
    deadline_ = std::max(deadline_, sent_at_ + step_);
  }

  // Fastscan: for each number its bits from the highest on, then the whole number once more. Above an address: the
  // address is followed up to a number in which each 0, from the lowest bit on, is requested as a 1; if a slave
  // responds, its lower bits and the other numbers are scanned as usual.

  [[nodiscard]] bool scanning() const { return last_ == static_cast<std::uint8_t>(lss::Command::fastscan); }

  /// Starts with the first number.
  void begin_scan() {
    for (std::size_t i = 0; i < from_.size(); ++i) words_[i] = from_[i];
    is_path_repeated_ = false;
    begin_path();
  }
  void begin_path() {
    number_ = 0;
    bit_ = lss::fastscan_reset;
    confirming_ = false;
  }

  /// Sends the present step. The response time of the slaves is not known in the first one, and was wrong if the scan
  /// starts again.
  void ask(TimePoint now) {
    const bool is_first = bit_ == lss::fastscan_reset && (!is_measured_ || restarts_ != 0);
    start(lss::Command::fastscan, lss::Command::fastscan, lss::Command::identified,
          is_first ? std::max(step_, first_step) : step_, now);
  }

  /// Sends the present step again: the request or the response may be lost or late.
  void repeat(TimePoint now) {
    to_send_ = first_;
    is_repeated_ = true;
    deadline_ = now + wait_;
    flush(now);
  }

  /// No slave has the number that has been found. Starts again with longer steps; a slave whose confirmation was lost
  /// may be in the configuration state.
  void scan_again(TimePoint now) {
    constexpr std::uint8_t max_restarts = 4;
    if (restarts_ == max_restarts) return finish(LssOutcome::no_answer);
    ++restarts_;
    step_ = std::min(step_ * 2u, longest_step);
    static_cast<void>(bus_.send(lss::make_frame(lss::request_id, lss::Command::switch_state_global,
                                                static_cast<std::uint32_t>(LssState::waiting))));
    begin_scan();
    branch_ = no_branch;
    if (is_above_) {
      branch_ = 4;
      climb();
    }
    if (busy_) ask(now);
  }

  void next_step(TimePoint now) {
    if (bit_ == lss::fastscan_reset) {
      if (!answered_) return finish(LssOutcome::no_answer);
      begin_number();
    } else if (confirming_) {
      if (!answered_ && branch_ == no_branch) return scan_again(now);
      if (number_ == 3) return finish(LssOutcome::done);
      if (answered_) {
        ++number_;
        begin_number();
      } else if (!std::exchange(is_path_repeated_, true)) {
        begin_path();
      } else {
        branch_ = number_ + 1;  // no slave has the number of the address, but one above it may exist
        climb();
      }
    } else if (branch_ != no_branch) {
      if (answered_) {
        branch_ = no_branch;
        words_[number_] = asked_;
        confirming_ = bit_ == 0;
        if (!confirming_) --bit_;
      } else {
        ++bit_;
        find_zero();
      }
    } else {
      if (!answered_) words_[number_] |= std::uint32_t{1} << bit_;
      if (bit_ == 0) {
        confirming_ = true;
      } else {
        --bit_;
      }
    }
    if (busy_) ask(now);
  }

  void begin_number() {
    confirming_ = number_ < (branch_ != no_branch ? branch_ : known_);
    bit_ = confirming_ || branch_ != no_branch ? 0 : 31;
    if (branch_ != no_branch) {
      if (!confirming_) find_zero();
    } else if (!confirming_) {
      words_[number_] = 0;
    }
  }

  /// Continues with the previous number, from its beginning.
  void climb() {
    if (branch_ <= known_) return finish(LssOutcome::no_answer);
    --branch_;
    is_path_repeated_ = false;
    begin_path();
  }

  /// Searches for a 0 from `bit_` on.
  void find_zero() {
    while (bit_ < 32 && (words_[number_] >> bit_ & 1) != 0) ++bit_;
    if (bit_ == 32) return climb();
    asked_ = (words_[number_] >> bit_ | 1) << bit_;
  }

  static constexpr std::uint8_t no_branch = 0xFF;
  static constexpr Duration longest_step = std::chrono::seconds{1};
  static constexpr Duration first_step = from_milliseconds(200);

  BusType& bus_;
  LssTimeouts timeouts_;
  std::array<std::uint32_t, 6> words_{};  ///< of the commands first_..last_; in a Fastscan the address
  std::array<std::uint32_t, 4> from_{};   ///< fastscan: the address with the known numbers
  std::uint32_t value_ = 0;
  TimePoint deadline_{};
  TimePoint asked_at_{};  ///< when the request was sent first
  TimePoint sent_at_{};   ///< when it was sent last
  Duration slowest_{0};   ///< longest response time
  Duration step_{0};
  Duration wait_{0};
  std::uint8_t first_ = 0;
  std::uint8_t to_send_ = 0;  ///< above last_: all frames have been sent
  std::uint8_t last_ = 0;
  lss::Command answer_ = lss::Command::none;
  LssOutcome outcome_ = LssOutcome::done;
  std::uint8_t known_ = 0;
  std::uint8_t number_ = 0;          ///< fastscan: LSSSub
  std::uint8_t bit_ = 0;             ///< fastscan: BitCheck
  std::uint8_t branch_ = no_branch;  ///< above an address: the number that differs from it
  std::uint32_t asked_ = 0;          ///< the number with the changed bit
  std::uint8_t restarts_ = 0;
  bool is_measured_ = false;       ///< `slowest_` is valid
  bool is_above_ = false;          ///< fastscan above an address
  bool is_path_repeated_ = false;  ///< above an address: its numbers are checked for the second time
  bool is_repeated_ = false;       ///< the step was sent for the second time
  bool confirming_ = false;
  bool answered_ = false;
  bool busy_ = false;
};

}  // namespace canopen
