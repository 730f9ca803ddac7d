/// The behaviour of a simulated node beyond the protocol: values that change, and rules.
#pragma once

#include <canopen/base/abort_code.hpp>
#include <canopen/emcy/error_register.hpp>
#include <canopen/nmt/nmt.hpp>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/generators.hpp"
#include "device/node_faults.hpp"

namespace edsc {

/// The node of a behaviour.
class BehaviourTarget {
 public:
  /// Sets a value as the application of a device does, whatever the access type of the object.
  [[nodiscard]] virtual canopen::AbortCode set(std::uint16_t index, std::uint8_t sub_index,
                                               std::span<const std::uint8_t> bytes) = 0;
  [[nodiscard]] virtual std::optional<std::vector<std::uint8_t>> get(std::uint16_t index, std::uint8_t sub_index) = 0;
  virtual void emergency(std::uint16_t code, canopen::ErrorRegister bits) = 0;
  virtual void emergency_over(canopen::ErrorRegister bits) = 0;
  /// Sets bits of 1001h for an error that the node has reported: Node::hold_error.
  virtual void hold_error(canopen::ErrorRegister bits) = 0;
  [[nodiscard]] virtual canopen::NmtState nmt_state() const = 0;
  virtual void request(canopen::NmtCommand command) = 0;
  virtual void power_cycle() = 0;
  /// Connects the node to the bus, or disconnects it: bus-off.
  virtual void set_connected(bool connected) = 0;
  virtual void start_fault(const NodeFault& fault) = 0;
  virtual void clear_faults() = 0;
  /// The NMT state, and what is unusual: faults, not connected.
  [[nodiscard]] virtual std::string state_text() const = 0;

 protected:
  ~BehaviourTarget() = default;
};

class Behaviour;

/// The answer to a command; `text` is the value that it asks for, or what is wrong.
struct CommandAnswer {
  bool ok = true;
  std::string text;
};
using BehaviourAction = std::function<CommandAnswer(Behaviour&)>;

struct Generator {
  const GeneratorKind* kind = nullptr;
  const Entry* entry = nullptr;
  GeneratorSettings settings;
  std::uint64_t interval_us = default_interval_us;
};

/// Sets `to` to each new value of `from`, after a time.
struct ValueCopy {
  const Entry* from = nullptr;
  const Entry* to = nullptr;
  std::uint64_t after_us = 0;
};

/// A condition for a number; without members each number fits.
struct NumberCondition {
  std::optional<double> equals;
  std::optional<double> above;
  std::optional<double> below;
  std::optional<std::uint64_t> mask;  ///< `equals` compares these bits; without it, one of them must be set

  [[nodiscard]] bool holds(double number) const;
};

enum class BehaviourEvent : std::uint8_t { power_on, time, every, sync, state, written, read, changes };

struct BehaviourRule {
  std::string name;
  BehaviourEvent event = BehaviourEvent::power_on;
  const Entry* entry = nullptr;             ///< of written, read, changes
  std::uint64_t time_us = 0;                ///< of time, every
  unsigned number = 1;                      ///< of sync: each SYNC with a multiple of this number
  canopen::NmtState state{};                ///< of state
  NumberCondition condition;                ///< of the value of `entry`
  bool changed = false;                     ///< of written: only if the value differs from the one before
  std::uint64_t after_us = 0;               ///< from the event to the actions
  std::optional<unsigned> times;            ///< how often at most
  canopen::AbortCode refuse = canopen::ok;  ///< of written and read: the response
  std::vector<BehaviourAction> actions;
};

struct BehaviourScript {
  struct Value {
    const Entry* entry;
    std::vector<std::uint8_t> bytes;
  };
  std::vector<Value> values;  ///< from power-on, and after each reset
  std::vector<Generator> generators;
  std::vector<ValueCopy> copies;
  std::vector<BehaviourRule> rules;
};

/// Times are microseconds since the first power-on. The same times, frames and seed give the same values.
class Behaviour {
 public:
  /// The target must outlive it, and so must the entries of scripts and commands.
  Behaviour(BehaviourTarget& target, std::uint64_t seed);

  /// Adds a script. Its times begin at the next power-on, or now if the node is on.
  void add(const BehaviourScript& script);

  // For commands. The text is what is wrong.
  [[nodiscard]] CommandAnswer set(const Entry& entry, std::span<const std::uint8_t> bytes);
  void start(Generator generator);
  /// Begins a copy, with the present value.
  void follow(const ValueCopy& copy);
  /// Ends the generator and the copies to an entry.
  [[nodiscard]] CommandAnswer stop(const Entry& entry);
  /// Executes the actions of a rule.
  [[nodiscard]] CommandAnswer fire(std::string_view rule);
  [[nodiscard]] BehaviourTarget& target() { return target_; }

  // Events of the node. Actions follow in `on_time`, which is due at once.
  void on_power_on(std::uint64_t now_us);
  [[nodiscard]] canopen::AbortCode before_write(std::uint16_t index, std::uint8_t sub_index,
                                                std::span<const std::uint8_t> bytes);
  void after_write(std::uint16_t index, std::uint8_t sub_index);
  [[nodiscard]] canopen::AbortCode before_read(std::uint16_t index, std::uint8_t sub_index);
  void on_state(canopen::NmtState state);
  void on_sync();

  /// Sets the present time. Does not execute anything.
  void advance(std::uint64_t now_us) { now_us_ = now_us; }
  /// Executes what is due.
  void on_time(std::uint64_t now_us);
  /// When `on_time` is due; nothing if only an event can cause anything.
  [[nodiscard]] std::optional<std::uint64_t> next_us() const;

  /// Gets what an action of a script could not do.
  std::function<void(const std::string& problem)> report;

 private:
  struct RunningGenerator {
    Generator generator;
    std::uint64_t start_us;
    std::uint64_t next_step = 0;

    [[nodiscard]] std::uint64_t next_us() const { return start_us + next_step * generator.interval_us; }
  };
  struct RunningCopy {
    ValueCopy copy;
    std::optional<double> last;
  };
  struct RunningRule {
    BehaviourRule rule;
    unsigned count = 0;                    ///< of events that fit
    std::optional<std::uint64_t> next_us;  ///< of time, every
    std::uint64_t syncs = 0;
    std::optional<double> last;  ///< of changes
  };
  using Work = std::function<void()>;

  void begin(RunningRule& rule);
  void begin_generators(const BehaviourScript& script);
  void set_values(const BehaviourScript& script);
  [[nodiscard]] std::optional<double> number_of(const Entry& entry);
  void run_generators();
  void run_timed_rules();
  void look_for_changes();
  /// An event that fits the rule.
  void happen(RunningRule& rule);
  void execute(const BehaviourRule& rule);
  void execute_later(std::uint64_t after_us, Work work);
  void set_number(const Entry& entry, double number, OutOfRange out_of_range);

  BehaviourTarget& target_;
  std::uint64_t seed_;
  std::uint64_t now_us_ = 0;
  bool is_on_ = false;
  bool has_event_ = false;  ///< values may have changed
  std::vector<BehaviourScript> scripts_;
  std::map<std::uint32_t, RunningGenerator> generators_;  ///< by key
  std::vector<RunningCopy> copies_;
  std::deque<RunningRule> rules_;
  std::multimap<std::uint64_t, Work> pending_;  ///< by time
  std::optional<double> before_;                ///< the value before it is written
};

}  // namespace edsc
