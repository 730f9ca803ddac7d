/// Loss of the communication of a drive: which events count, until 6007h has been applied (CiA 402-2).
#pragma once

#include <cstdint>
#include <utility>

#include "canopen/emcy/emcy_producer.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/profile/cia402_objects.hpp"
#include "canopen/profile/cia402_parameters.hpp"

namespace canopen::cia402 {

enum class Loss : std::uint8_t {
  none,
  reported,  ///< by a service, with its EMCY
  stopped,   ///< NMT Stopped, which is not reported by a service
};

template <class DriveParameters>
class Connection {
 public:
  /// Handler for the errors that the node reports: writes them to 603Fh. A heartbeat or life guarding event and bus-off
  /// are a loss of communication.
  struct ErrorTaker {
    Connection* connection;
    void operator()(auto& node, std::uint16_t code) const {
      DriveParameters::template set<object::ErrorCode>(node, code);
      if (code == emergency_code::error_control || code == emergency_code::bus_off) connection->loss_ = Loss::reported;
    }
  };

  /// Forgets a loss.
  void restart() { loss_ = Loss::none; }

  /// Whether there is a loss that `take` has not returned yet.
  [[nodiscard]] bool lost() const { return loss_ != Loss::none; }

  /// Returns a new loss once.
  [[nodiscard]] Loss take(NmtState state) {
    const bool stopped = state == NmtState::stopped;
    if (stopped && !stopped_ && loss_ == Loss::none) loss_ = Loss::stopped;
    stopped_ = stopped;
    return std::exchange(loss_, Loss::none);
  }

 private:
  Loss loss_ = Loss::none;
  bool stopped_ = false;  ///< whether the NMT state was Stopped at the last check
};

}  // namespace canopen::cia402
