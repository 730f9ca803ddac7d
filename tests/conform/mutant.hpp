/// A wrong device: a good one, and between it and the test a wire that changes frames.
#pragma once

#include <canopen/frame.hpp>
#include <canopen/time.hpp>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edsc::conform {

/// What a mutant may do with a frame besides changing its bytes.
class Wire {
 public:
  static constexpr std::uint8_t node_id = 5;  ///< of the device

  canopen::TimePoint now;  ///< in simulated time

  /// The frame does not arrive.
  void drop() { keep = false; }
  /// It arrives later, and those behind it keep their time.
  void delay(canopen::Duration span) { later = span; }
  /// The device sends this frame as well, behind the present one.
  void send(const canopen::Frame& frame) { from_device.push_back(frame); }
  /// The test sends this frame as well, before the present one.
  void request(const canopen::Frame& frame) { to_device.push_back(frame); }

  // Of one frame, for the port.
  bool keep = true;
  canopen::Duration later{0};
  std::vector<canopen::Frame> from_device, to_device;
};

/// Called with each frame on its way. A lambda that keeps state begins anew with each run.
using Change = std::function<void(Wire& wire, canopen::Frame& frame)>;

struct Mutant {
  std::string_view name;  ///< `abort-code-of-missing-sub-index`
  Change of_answers;      ///< frames of the device; empty: none changes
  Change of_requests;     ///< frames of the test
  std::function<void(std::string& eds)> of_eds{};  ///< the text of the EDS, before the test reads it
};

// One table for each file of cases.
[[nodiscard]] std::vector<Mutant> sdo_mutants();
[[nodiscard]] std::vector<Mutant> pdo_mutants();
[[nodiscard]] std::vector<Mutant> control_mutants();

}  // namespace edsc::conform
