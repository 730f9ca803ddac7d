/// A device that is a program in simulated time (runtime/include/canopen/port/simulation_codec.hpp has the protocol).
#pragma once

#include <sys/types.h>

#include <canopen/abort_code.hpp>
#include <canopen/error_register.hpp>
#include <canopen/port/descriptor.hpp>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "online/live_bus.hpp"

namespace edsc {

/// Starts the program, with nothing between it and its only participant. Time passes in `receive` alone, as fast as the
/// program runs. What the program writes to standard error stays there.
class SimulatedPort final : public BusPort {
 public:
  /// Whether an address begins with `simulated:`.
  [[nodiscard]] static bool is_address(std::string_view text);

  /// `simulated:PROGRAM@NODE-ID[,NAME]`: PROGRAM is a path, NODE-ID 1..127 or 255 for a device that LSS gives one, NAME one
  /// of the devices of the program. Throws std::invalid_argument for a malformed address, std::runtime_error for a program
  /// that cannot be started or is not such a simulation.
  explicit SimulatedPort(const std::string& address);
  /// The program ends with its input; one that does not is killed.
  ~SimulatedPort() override;

  // Functions that talk to the program throw BusLost when it ends or answers what is not an answer, and Interrupted when it
  // does not answer for a second after Ctrl-C.

  [[nodiscard]] bool send(const canopen::Frame& frame) override;
  [[nodiscard]] std::optional<canopen::Frame> receive(canopen::Duration timeout) override;
  /// The simulated time, from 0 on.
  [[nodiscard]] canopen::TimePoint now() const override;
  [[nodiscard]] canopen::TimePoint received_at() const override { return received_at_; }
  /// Of the connection to the program. Not readable between two calls.
  [[nodiscard]] int file_descriptor() const override { return connection_.number(); }
  /// Seconds of simulated time take the program less than a millisecond.
  [[nodiscard]] canopen::Duration longest_at_once() const override { return canopen::from_milliseconds(10'000); }

  // What the bus does not do. No time passes: frames that wait are on their way with the next `receive`. Nothing or false:
  // the program cannot do it.

  /// The application sets an object to these bytes, as SDO sends them. The abort code with which the device refuses them.
  [[nodiscard]] std::optional<canopen::AbortCode> set(std::uint16_t index, std::uint8_t sub_index,
                                                      std::span<const std::uint8_t> bytes);
  /// The application reports an error, which sets these bits of 1001h.
  [[nodiscard]] bool emergency(std::uint16_t code, canopen::ErrorRegister bits);
  /// The error has gone.
  [[nodiscard]] bool emergency_over(canopen::ErrorRegister bits);
  /// Switches the device off and on. It keeps what it has stored.
  [[nodiscard]] bool power_cycle();

 private:
  void start(const std::string& program);
  /// Why the program cannot be talked to any more.
  [[noreturn]] void lost();
  [[noreturn]] void lost(const std::string& answer);
  /// How the program has ended; it is killed if it has not.
  [[nodiscard]] std::string end_of_program();
  void flush();
  [[nodiscard]] std::string read_line();
  /// The answer to a request that lets no time pass.
  [[nodiscard]] std::optional<canopen::AbortCode> ask(const std::string& request);

  std::string program_;
  pid_t process_ = -1;
  canopen::Descriptor connection_;
  std::string requests_;  ///< not written yet
  std::string answers_;   ///< not looked at yet
  std::uint64_t now_us_ = 0;
  canopen::TimePoint received_at_{};
};

}  // namespace edsc
