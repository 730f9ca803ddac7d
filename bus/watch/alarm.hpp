/// An alarm that a guard raises, and the limit of their rate.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>

#include "watch/alarms.hpp"

namespace edsc::watch {

/// Members that do not apply are 0 or empty.
struct Alarm {
  RuleId id = {};
  std::int64_t us = 0;  ///< time of the log, or since 1970 on a live bus
  std::uint8_t node_id = 0;
  std::string node = {};  ///< its name in the network file
  std::uint32_t cob_id = 0;
  bool has_can_id = false;
  std::string text = {};         ///< what was received, and what is expected
  std::uint64_t suppressed = 0;  ///< alarms of this kind since the last one that was passed on
  std::uint32_t detail = 0;      ///< object or NMT command, by which alarms of one kind differ
};

/// Passes on each alarm once in a time; alarms about the same thing within this time are counted.
class AlarmLimit {
 public:
  explicit AlarmLimit(std::int64_t quiet_us) : quiet_us_{quiet_us} {}

  /// Whether the alarm is passed on; it then has the number of those that were not.
  [[nodiscard]] bool passes(Alarm& alarm) {
    // An attacker can choose CAN-IDs and objects: the memory stays limited.
    if (last_.size() >= max_kept) last_.clear();
    const auto [at, is_new] = last_.try_emplace({alarm.id, alarm.node_id, alarm.cob_id, alarm.detail}, Last{alarm.us});
    Last& last = at->second;
    if (!is_new && alarm.us - last.us < quiet_us_) {
      ++last.suppressed;
      return false;
    }
    alarm.suppressed = last.suppressed;
    last = {alarm.us};
    return true;
  }

 private:
  static constexpr std::size_t max_kept = 4096;
  struct Last {
    std::int64_t us = 0;
    std::uint64_t suppressed = 0;
  };
  std::int64_t quiet_us_;
  std::map<std::tuple<RuleId, std::uint8_t, std::uint32_t, std::uint32_t>, Last> last_;
};

}  // namespace edsc::watch
