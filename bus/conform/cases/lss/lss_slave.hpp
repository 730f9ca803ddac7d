/// The LSS slave of the device, as the cases of CiA 305 see it.
#pragma once

#include <array>
#include <canopen/lss/lss_protocol.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "conform/cases/shared/setup.hpp"

namespace edsc::conform {

using canopen::Frame;
using canopen::LssState;
using canopen::NodeId;
namespace lss = canopen::lss;
using lss::Command;

/// The LSS slave of the device. The constructor leaves it in the waiting state.
class Slave {
 public:
  /// The time that a slave may need to answer. CiA 305 does not specify a limit.
  static constexpr Duration to_answer = milliseconds{200};

  explicit Slave(Dut& dut);

  [[nodiscard]] const std::array<std::uint32_t, 4>& numbers() const { return numbers_; }

  void send(Command command, std::uint32_t word = 0) const;
  /// Waits for the next message of a slave with this command.
  [[nodiscard]] std::optional<Frame> answer(Command command, Dut::Mark since, Duration span = to_answer) const;
  /// Sends a request whose answer has the same command.
  [[nodiscard]] std::optional<Frame> ask(Command command, std::uint32_t word = 0, Duration span = to_answer) const;

  /// Expects a value as the answer to an inquire service.
  void expect_says(Command command, std::uint32_t expected, const std::string& what) const;
  /// Expects an error code as the answer to a configure service.
  void expect_error(Command command, std::uint32_t word, std::uint8_t expected, const std::string& what) const;

  [[nodiscard]] bool try_select(const std::array<std::uint32_t, 4>& numbers) const;
  void select() const;

  /// Identify remote slave: `low` and `high` of revision and serial number.
  [[nodiscard]] bool identifies(std::uint32_t product_code, std::pair<std::uint32_t, std::uint32_t> revision,
                                std::pair<std::uint32_t, std::uint32_t> serial) const;

  /// Sets all slaves to the waiting state.
  void wait() const;

  void configure(NodeId node) const;

 private:
  bool in_sequence(Command first, std::span<const std::uint32_t> words, Command last) const;

  Dut& dut_;
  std::array<std::uint32_t, 4> numbers_{};
};

/// Runs a case with the slave in the configuration state, then sets it to the waiting state.
template <class Check>
void with_slave(Dut& dut, Check check) {
  const Slave slave{dut};
  const auto selected = [&] {
    slave.select();
    check(slave);
  };
  and_undo(selected, [&] { slave.wait(); });
}

/// Inconclusive if other nodes are on the bus, which a service to all slaves would change.
void need_silent_bus(Dut& dut);

}  // namespace edsc::conform
