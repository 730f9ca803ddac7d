#include <gtest/gtest.h>
#include <canopen/nmt/error_control.hpp>

#include "support/bench.hpp"

namespace {

using bench::frame;
using canopen::error_control_message;
using canopen::NmtState;
using canopen::NodeId;

TEST(ErrorControl, ReadsNodeIdStateAndToggleBit) {
  struct Row {
    const char* frame;
    std::uint8_t node_id;
    NmtState state;
    bool toggle;
  };
  constexpr Row rows[] = {
      {"701 00", 1, NmtState::initialisation, false}, {"77F 04", 127, NmtState::stopped, false},
      {"705 05", 5, NmtState::operational, false},    {"705 7F", 5, NmtState::pre_operational, false},
      {"704 85", 4, NmtState::operational, true},     {"704 FF", 4, NmtState::pre_operational, true},
      {"704 84", 4, NmtState::stopped, true},
  };
  for (const Row& row : rows) {
    const auto message = error_control_message(frame(row.frame));
    ASSERT_TRUE(message) << row.frame;
    EXPECT_EQ(message->node_id, NodeId{row.node_id}) << row.frame;
    EXPECT_EQ(message->state, row.state) << row.frame;
    EXPECT_EQ(message->toggle, row.toggle) << row.frame;
  }
}

TEST(ErrorControl, IgnoresOtherFramesLengthsAndStates) {
  for (const char* text :
       {"700 05", "780 05", "6FF 05", "705", "705 05 00", "705 R 1", "00000705 05", "705 01", "705 06", "705 82"}) {
    EXPECT_FALSE(error_control_message(frame(text))) << text;
  }
}

}  // namespace
