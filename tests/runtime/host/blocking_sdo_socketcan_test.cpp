#include <gtest/gtest.h>
#include <canopen/host/blocking_sdo.hpp>
#include <canopen/host/socketcan.hpp>

#include <sample/device.hpp>
#include <system_error>

namespace {

static_assert(canopen::BlockingBus<canopen::SocketCan>);

canopen::Result<std::uint16_t> read_statusword(canopen::SocketCan& bus) {
  canopen::BlockingSdo master{bus};
  return master.remote<sample::Device>(canopen::NodeId{5}).read<sample::od::statusword>();
}

TEST(BlockingSdoOnSocketCan, ThrowsWhereThereIsNoInterface) {
  EXPECT_THROW(
      {
        canopen::SocketCan bus{"no-such-can"};
        (void)read_statusword(bus);
      },
      std::system_error);
}

}  // namespace
