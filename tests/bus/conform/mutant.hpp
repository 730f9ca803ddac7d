/// A wrong device: a good one, with a wire to the test that changes frames.
#pragma once

#include <canopen/base/clock.hpp>
#include <canopen/can/frame.hpp>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edsc::conform {

/// What a mutant may do with a frame in addition to changing its bytes.
class Wire {
 public:
  static constexpr std::uint8_t node_id = 5;  ///< of the device

  canopen::TimePoint now;  ///< in simulated time

  /// The frame is lost.
  void drop() { keep = false; }
  /// The frame is received later; frames after it keep their time.
  void delay(canopen::Duration span) { later = span; }
  /// The device also sends this frame, after the present one.
  void send(const canopen::Frame& frame) { from_device.push_back(frame); }
  /// The test also sends this frame, before the present one.
  void request(const canopen::Frame& frame) { to_device.push_back(frame); }

  // For one frame; read by the port.
  bool keep = true;
  canopen::Duration later{0};
  std::vector<canopen::Frame> from_device, to_device;
};

/// Called for each frame on the wire. A lambda with state starts anew with each run.
using Change = std::function<void(Wire& wire, canopen::Frame& frame)>;

struct Mutant {
  std::string_view name;                           ///< `abort-code-of-missing-sub-index`
  Change of_answers;                               ///< frames of the device; empty: unchanged
  Change of_requests;                              ///< frames of the test
  std::function<void(std::string& eds)> of_eds{};  ///< the text of the EDS, before the test reads it
};

// One table for each file of mutants.
[[nodiscard]] std::vector<Mutant> sdo_mutants();
[[nodiscard]] std::vector<Mutant> pdo_mutants();
[[nodiscard]] std::vector<Mutant> control_mutants();
[[nodiscard]] std::vector<Mutant> network_mutants();
[[nodiscard]] std::vector<Mutant> new_case_mutants();
[[nodiscard]] std::vector<Mutant> hostile_mutants();
[[nodiscard]] std::vector<Mutant> answer_mutants();
[[nodiscard]] std::vector<Mutant> timing_mutants();

}  // namespace edsc::conform
