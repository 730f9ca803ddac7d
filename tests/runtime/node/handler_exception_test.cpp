/// Handlers on a host may throw: the exception leaves the node, which then works as before.
#include <gtest/gtest.h>

#include <stdexcept>

#include "support/bench.hpp"

namespace {

namespace od = sample::od;

TEST(Handlers, ACommandAfterAnExceptionIsNotDeferred) {
  bool fails = true;
  auto device = bench::with(canopen::on_write<od::controlword>([&](std::uint16_t) {
    if (fails) throw std::runtime_error{"output stage"};
    return canopen::ok;
  }));
  EXPECT_THROW(device.ask("605 2B 40 60 00 0F 00 00 00"), std::runtime_error);
  device.node.request(canopen::NmtCommand::start, device.now);
  EXPECT_EQ(device.node.state(), canopen::NmtState::operational);
  fails = false;
  EXPECT_NE(device.ask("605 2B 40 60 00 0F 00 00 00").find("585 60 40 60 00 00 00 00 00"), std::string::npos);
  EXPECT_EQ(device.node.get<od::controlword>(), 0x0F);
}

}  // namespace
