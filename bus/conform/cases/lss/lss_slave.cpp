#include "conform/cases/lss/lss_slave.hpp"

#include <fmt/format.h>

namespace edsc::conform {

using canopen::NmtState;

Slave::Slave(Dut& dut) : dut_{dut} {
  if (!dut.sheet().information.capabilities.lss_supported.value_or(false)) {
    dut.not_applicable("the device does not have LSS: LSS_Supported is not 1 in the EDS");
  }
  dut.need_part("lss");
  dut.enter(NmtState::pre_operational);
  for (std::uint8_t i = 0; i < 4; ++i) {
    dut.need(identity, static_cast<std::uint8_t>(i + 1));
    numbers_[i] = static_cast<std::uint32_t>(dut.read_number(identity, static_cast<std::uint8_t>(i + 1)));
  }
  // Older slaves support LSS in Stopped only.
  if (!try_select(numbers_)) dut.enter(NmtState::stopped);
  wait();
}

void Slave::send(Command command, std::uint32_t word) const {
  dut_.send(lss::make_frame(lss::request_id, command, word));
}

std::optional<Frame> Slave::answer(Command command, Dut::Mark since, Duration span) const {
  const auto found = dut_.wait_for(
      [command](const Frame& frame) {
        return lss::is_lss(frame, lss::response_id) && frame.data[0] == static_cast<std::uint8_t>(command);
      },
      span, since);
  return found ? std::optional{found->frame} : std::nullopt;
}

std::optional<Frame> Slave::ask(Command command, std::uint32_t word, Duration span) const {
  const Dut::Mark since = dut_.mark();
  send(command, word);
  return answer(command, since, span);
}

void Slave::expect_says(Command command, std::uint32_t expected, const std::string& what) const {
  const auto said = ask(command);
  dut_.expect(said.has_value(), "an answer with " + what, "none");
  dut_.expect_equal(lss::word_of(*said), expected, what);
}

void Slave::expect_error(Command command, std::uint32_t word, std::uint8_t expected, const std::string& what) const {
  const auto said = ask(command, word);
  dut_.expect(said.has_value(), "an answer to " + what, "none");
  dut_.expect_equal(said->data[1], expected, "the error code for " + what);
}

bool Slave::try_select(const std::array<std::uint32_t, 4>& numbers) const {
  return in_sequence(Command::select_vendor_id, numbers, Command::selected);
}

void Slave::select() const {
  dut_.expect(try_select(numbers_), "an answer (44h) to switch state selective with the numbers of 1018h", "none");
}

bool Slave::identifies(std::uint32_t product_code, std::pair<std::uint32_t, std::uint32_t> revision,
                       std::pair<std::uint32_t, std::uint32_t> serial) const {
  const std::uint32_t words[] = {numbers_[0],     product_code, revision.first,
                                 revision.second, serial.first, serial.second};
  return in_sequence(Command::identify_vendor_id, words, Command::identified);
}

void Slave::wait() const {
  send(Command::switch_state_global, static_cast<std::uint32_t>(LssState::waiting));
  dut_.pass_time(milliseconds{20});
}

void Slave::configure(NodeId node) const {
  expect_error(Command::configure_node_id, node.value(), 0, fmt::format("configure node-ID {}", node.value()));
}

bool Slave::in_sequence(Command first, std::span<const std::uint32_t> words, Command last) const {
  const Dut::Mark since = dut_.mark();
  auto command = static_cast<std::uint8_t>(first);
  for (const std::uint32_t word : words) send(static_cast<Command>(command++), word);
  return answer(last, since).has_value();
}

void need_silent_bus(Dut& dut) {
  if (hears_other_nodes(dut, milliseconds{1200})) {
    dut.inconclusive(Condition::alone,
                     "the service also addresses the other nodes on the bus; test the device alone on the bus");
  }
}

}  // namespace edsc::conform
