#include <gtest/gtest.h>
#include <canopen/host/blocking_sdo.hpp>
#include <canopen/host/host_bus.hpp>

#include <stdexcept>
#include <string>
#include <system_error>

namespace {

static_assert(canopen::Bus<canopen::HostBus> && canopen::BlockingBus<canopen::HostBus>);

std::string refusal(const std::string& address) {
  try {
    const canopen::HostBus bus{address};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "taken";
}

TEST(HostBus, RefusesWhatIsNoAddressWithASentence) {
  for (const char* address : {"", "vcan0", "socketcan", "socketcan:", "usb:1", ":vcan0"}) {
    EXPECT_EQ(refusal(address).find("\"" + std::string{address} + "\" is not a bus address: "), 0u) << refusal(address);
  }
}

TEST(HostBus, TellsWhatCannotBeOpened) { EXPECT_THROW(canopen::HostBus{"socketcan:no-such-can"}, std::system_error); }

}  // namespace
