/// A device that is a program in simulated time (runtime/include/canopen_sim/simulation_codec.hpp has the protocol).
#pragma once

#include <sys/types.h>

#include <canopen/base/abort_code.hpp>
#include <canopen/emcy/error_register.hpp>
#include <canopen/host/descriptor.hpp>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "online/live_bus.hpp"

namespace edsc {

/// Which parts the program of a simulated device has (runtime/include/canopen/node/composition.hpp).
struct SimulatedComposition {
  bool made_by_edsc = false;         ///< without an application, with all parts that the EDS promises
  std::vector<std::string> omitted;  ///< `lss`, `storage`, or a DOMAIN: `2030:00`
};

/// Starts the program and is its only other participant on the bus. Time passes in `receive` only, as fast as the
/// program runs. Standard error of the program is not redirected.
class SimulatedPort final : public BusPort {
 public:
  /// Whether an address begins with `simulated:`.
  [[nodiscard]] static bool is_address(std::string_view text);

  /// `simulated:PROGRAM@NODE-ID[,NAME]`: PROGRAM is a path; NODE-ID is 1..127, or 255 for a device without node-ID, for
  /// LSS; NAME is a device of the program. Throws std::invalid_argument for a malformed address, std::runtime_error for
  /// a program that cannot be started or is not such a simulation.
  explicit SimulatedPort(const std::string& address);
  /// Closes the input of the program, which ends it; otherwise kills it.
  ~SimulatedPort() override;

  [[nodiscard]] const SimulatedComposition& composition() const { return composition_; }

  // Functions that communicate with the program throw BusLost if it ends or sends an invalid response, and Interrupted
  // if it does not answer for a second after Ctrl-C.

  [[nodiscard]] bool send(const canopen::Frame& frame) override;
  [[nodiscard]] std::optional<canopen::Frame> receive(canopen::Duration timeout) override;
  /// The simulated time, from 0.
  [[nodiscard]] canopen::TimePoint now() const override;
  [[nodiscard]] canopen::TimePoint received_at() const override { return received_at_; }
  /// The program simulates seconds in less than a millisecond.
  [[nodiscard]] canopen::Duration longest_at_once() const override { return canopen::from_milliseconds(10'000); }

  // Inputs of the device other than the bus. No time passes; pending frames are sent by the next `receive`. Nothing or
  // false: the program does not support it.

  /// The application sets an object to these bytes, in SDO format. Returns the abort code of the device.
  [[nodiscard]] std::optional<canopen::AbortCode> set(std::uint16_t index, std::uint8_t sub_index,
                                                      std::span<const std::uint8_t> bytes);
  /// The application reports an error, which sets these bits of 1001h.
  [[nodiscard]] bool emergency(std::uint16_t code, canopen::ErrorRegister bits);
  /// The error is over.
  [[nodiscard]] bool emergency_over(canopen::ErrorRegister bits);
  /// Switches the device off and on. It keeps its stored values.
  [[nodiscard]] bool power_cycle();

 private:
  void start(const std::string& program);
  /// Makes the device. Returns false if the program does not have one of this name.
  [[nodiscard]] bool make_node(unsigned node_id, std::string_view name);
  /// Why the program no longer communicates.
  [[noreturn]] void lost();
  [[noreturn]] void lost(const std::string& answer);
  /// How the program has ended; it is killed if it has not.
  [[nodiscard]] std::string end_of_program();
  void flush();
  [[nodiscard]] std::string read_line();
  /// The response to a request without simulated time.
  [[nodiscard]] std::optional<canopen::AbortCode> ask(const std::string& request);

  pid_t process_ = -1;
  SimulatedComposition composition_;
  canopen::Descriptor connection_;
  std::string requests_;  ///< not written yet
  std::string answers_;   ///< not read yet
  std::uint64_t now_us_ = 0;
  canopen::TimePoint received_at_{};
};

}  // namespace edsc
