/// What a node does by its device profile, with a simulated motor or sensor: a drive of CiA 402, an encoder of CiA 406.
#pragma once

#include <canopen/base/abort_code.hpp>
#include <canopen/base/clock.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "device/behaviour.hpp"

namespace edsc {

class ProfileBehaviour {
 public:
  virtual ~ProfileBehaviour() = default;

  /// Power-on, or an NMT reset: the objects have their default values.
  virtual void restart() = 0;
  /// Before a value that was received by SDO or PDO is stored; another code than `ok` rejects it.
  [[nodiscard]] virtual canopen::AbortCode before_write(std::uint32_t, std::span<const std::uint8_t>) {
    return canopen::ok;
  }
  virtual void after_write(std::uint32_t) {}
  virtual void on_sync() {}
  /// The node reports an error by EMCY.
  virtual void on_error(std::uint16_t) {}
  /// Call it after each event and at `next_deadline`.
  virtual void on_time(canopen::TimePoint now) = 0;
  [[nodiscard]] virtual std::optional<canopen::TimePoint> next_deadline() const = 0;
};

/// Whether `make_profile_behaviour` has one for this device profile.
[[nodiscard]] bool has_profile_behaviour(std::uint16_t profile);

/// Makes the behaviour of a device profile, the low word of 1000h; null if there is none. The target must outlive it.
[[nodiscard]] std::unique_ptr<ProfileBehaviour> make_profile_behaviour(std::uint16_t profile, BehaviourTarget& target);

}  // namespace edsc
