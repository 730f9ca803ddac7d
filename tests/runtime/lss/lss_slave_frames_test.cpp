/// An LSS slave with invalid and with random frames.
#include <gtest/gtest.h>

#include <canopen/lss/lss_slave.hpp>
#include <random>
#include <string>

#include "lss_bench.hpp"

namespace {

using bench::LssDevice;
using canopen::LssState;
using canopen::NmtState;
using canopen::NodeId;
using canopen::unconfigured_node_id;
using namespace std::chrono_literals;

TEST(LssSlave, IgnoresFramesThatAreNoLssRequests) {
  LssDevice device;
  for (const char* frame : {"7E5 04 01", "7E5", "7E5 04 01 00 00 00 00 00", "7E4 04 01 00 00 00 00 00 00",
                            "000007E5 04 01 00 00 00 00 00 00", "7E5 R 8", "7E5 00 01 00 00 00 00 00 00",
                            "7E5 05 01 00 00 00 00 00 00", "7E5 FF 01 00 00 00 00 00 00"}) {
    EXPECT_EQ(device.ask(frame), "") << frame;
    EXPECT_EQ(device.slave.state(), LssState::waiting) << frame;
  }
}

constexpr std::uint8_t commands[] = {0x04, 0x11, 0x13, 0x15, 0x17, 0x40, 0x41, 0x42, 0x43, 0x46, 0x47, 0x48,
                                     0x49, 0x4A, 0x4B, 0x4C, 0x51, 0x5A, 0x5B, 0x5C, 0x5D, 0x5E, 0x04, 0x51};

/// The command of the response that a slave may send to a request with this command; 0: no response.
std::uint8_t answer_to(std::uint8_t command) {
  switch (command) {
    case 0x11:
    case 0x13:
    case 0x17:
    case 0x5A:
    case 0x5B:
    case 0x5C:
    case 0x5D:
    case 0x5E: return command;
    case 0x43: return 0x44;
    case 0x4B:
    case 0x51: return 0x4F;
    case 0x4C: return 0x50;
    default: return 0;
  }
}

TEST(LssSlave, AnswersWellFormedFramesToWhateverComes) {
  std::mt19937 random{305};
  LssDevice device{unconfigured_node_id, {1, 2, 0x0001'0003, 4}};
  std::size_t answers = 0;
  for (int i = 0; i < 100'000; ++i) {
    canopen::Frame request{};
    request.id = random() % 16 == 0 ? random() % 0x800 : 0x7E5;
    request.size = random() % 16 == 0 ? static_cast<std::uint8_t>(random() % 9) : std::uint8_t{8};
    request.extended = random() % 64 == 0;
    request.remote = random() % 64 == 0;
    for (std::uint8_t& byte : request.data) byte = static_cast<std::uint8_t>(random() % 4 == 0 ? random() : 0);
    request.data[0] = commands[random() % std::size(commands)];
    if (random() % 8 == 0) request.data[0] = static_cast<std::uint8_t>(random());
    if (random() % 2 == 0) request.data[1] = static_cast<std::uint8_t>(random() % 5);
    const bool ours = request.id == 0x7E5 && request.size == 8 && !request.extended && !request.remote;
    const bool silent = device.slave.silent();
    const std::string answer = device.ask(request);
    if (!answer.empty()) {
      ++answers;
      ASSERT_TRUE(ours && !silent) << bench::text(request);
      const canopen::Frame frame = bench::frame(answer);
      ASSERT_EQ(frame.id, 0x7E4u);
      ASSERT_EQ(frame.size, 8);
      ASSERT_EQ(frame.data[0], answer_to(request.data[0])) << bench::text(request);
      for (const unsigned reserved : {5U, 6U, 7U}) ASSERT_EQ(frame.data[reserved], 0) << answer;
    }
    ASSERT_TRUE(device.slave.state() == LssState::waiting || device.slave.state() == LssState::configuration);
    for (const NodeId node_id : {device.slave.node_id(), device.slave.pending_node_id(), device.stored_node_id}) {
      ASSERT_TRUE(node_id.valid() || node_id == unconfigured_node_id) << int{node_id.value()};
    }
    ASSERT_EQ(device.state == NmtState::initialisation, device.slave.node_id() == unconfigured_node_id);
    ASSERT_EQ(device.slave.persistent_node_id(), device.stored_node_id);
    const auto deadline = device.slave.next_deadline();
    ASSERT_TRUE(!deadline || *deadline - device.now <= 65'535ms);
    if (random() % 512 == 0) device.reset_communication();
    device.pass(std::chrono::milliseconds{random() % 8192});
  }
  EXPECT_GT(answers, 3'000u);
}

}  // namespace
