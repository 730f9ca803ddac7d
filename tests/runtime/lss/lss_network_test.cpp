/// An LSS master and up to twenty slaves on one bus.
#include <gtest/gtest.h>

#include <algorithm>
#include <canopen/lss/lss_master.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <deque>
#include <random>
#include <tuple>
#include <vector>

#include "lss_bench.hpp"

namespace {

using canopen::LssAddress;
using canopen::LssAddressRange;
using canopen::LssMaster;
using canopen::LssOutcome;
using canopen::LssState;
using canopen::NmtState;
using canopen::NodeId;
using canopen::TimePoint;
using canopen::unconfigured_node_id;
using canopen::VirtualBus;
using namespace std::chrono_literals;

/// A device on a virtual bus. `answers_always`: in configuration state it responds to every Fastscan frame, as a common
/// stack does.
struct BusDevice {
  BusDevice(VirtualBus& bus, NodeId persistent, const LssAddress& address, bool answers_always = false)
      : device{persistent, address}, endpoint{bus.attach()} {
    endpoint.on_frame = [this, answers_always](const canopen::Frame& frame, TimePoint now) {
      if (answers_always && frame.id == 0x7E5 && frame.data[0] == 0x51 &&
          device.slave.state() == LssState::configuration) {
        endpoint.send(bench::frame("7E4 4F 00 00 00 00 00 00 00"));
        return;
      }
      device.slave.on_frame(frame, bench::LssDevice<>::Hooks{device}, now);
      EXPECT_TRUE(device.slave.serve(endpoint));
    };
    endpoint.on_time = [this](TimePoint now) { device.slave.on_time(bench::LssDevice<>::Hooks{device}, now); };
    endpoint.next_deadline = [this] { return device.slave.next_deadline(); };
  }

  bench::LssDevice<> device;
  VirtualBus::Endpoint& endpoint;
};

/// A master and devices on one bus of 500 kbit/s.
struct Network {
  Network() {
    VirtualBus::connect(endpoint, master);
    bus.listen([this](const canopen::Frame& frame, TimePoint) { requests += frame.id == 0x7E5 ? 1 : 0; });
  }

  /// Runs the service to its end.
  LssOutcome finish(bool begun) {
    EXPECT_TRUE(begun);
    while (master.busy()) bus.run_for(1ms);
    return master.outcome();
  }

  VirtualBus bus{500'000};
  VirtualBus::Endpoint& endpoint = bus.attach();
  LssMaster<VirtualBus::Endpoint> master{endpoint};
  std::deque<BusDevice> devices;
  int requests = 0;
};

/// Random addresses; about half of them differ from an earlier one in a single bit.
std::vector<LssAddress> random_addresses(std::size_t count, unsigned seed) {
  std::mt19937 random{seed};
  const auto number = [&random] { return static_cast<std::uint32_t>(random()); };
  std::vector<LssAddress> addresses;
  while (addresses.size() < count) {
    LssAddress address{number(), number(), number(), number()};
    if (!addresses.empty() && random() % 2 == 0) {
      address = addresses[random() % addresses.size()];
      std::uint32_t* const numbers[] = {&address.vendor_id, &address.product_code, &address.revision_number,
                                        &address.serial_number};
      *numbers[random() % 4] ^= std::uint32_t{1} << random() % 32;
    }
    if (std::ranges::find(addresses, address) == addresses.end()) addresses.push_back(address);
  }
  return addresses;
}

/// Assigns a node-ID to every device; each one must be found exactly once.
void commission(std::size_t count, unsigned seed) {
  Network network;
  const std::vector<LssAddress> addresses = random_addresses(count, seed);
  for (const LssAddress& address : addresses) {
    network.devices.emplace_back(network.bus, unconfigured_node_id, address);
  }
  std::vector<LssAddress> found;
  for (std::uint8_t node_id = 1; node_id <= count; ++node_id) {
    network.requests = 0;
    ASSERT_EQ(network.finish(network.master.fastscan(network.bus.now())), LssOutcome::done) << int{node_id};
    EXPECT_GE(network.requests, 133);
    EXPECT_LE(network.requests, 133 + 128) << "steps without a response are repeated";
    found.push_back(network.master.address());
    ASSERT_EQ(network.finish(network.master.inquire_serial_number(network.bus.now())), LssOutcome::done);
    EXPECT_EQ(network.master.value(), found.back().serial_number);
    ASSERT_EQ(network.finish(network.master.configure_node_id(NodeId{node_id}, network.bus.now())), LssOutcome::done);
    ASSERT_EQ(network.finish(network.master.store_configuration(network.bus.now())), LssOutcome::done);
    network.finish(network.master.switch_state_global(LssState::waiting, network.bus.now()));
    network.bus.settle();
  }
  EXPECT_EQ(network.finish(network.master.fastscan(network.bus.now())), LssOutcome::no_answer);
  EXPECT_EQ(network.finish(network.master.identify_non_configured_remote_slave(network.bus.now())),
            LssOutcome::no_answer);
  ASSERT_EQ(found.size(), addresses.size());
  for (const BusDevice& one : network.devices) {
    EXPECT_EQ(std::ranges::count(found, one.device.address), 1);
    EXPECT_EQ(one.device.state, NmtState::pre_operational);
    ASSERT_TRUE(one.device.slave.node_id().valid());
    EXPECT_EQ(found[one.device.slave.node_id().value() - 1u], one.device.address);
    EXPECT_EQ(one.device.stored_node_id, one.device.slave.node_id());
  }
}

TEST(LssNetwork, FastscanFindsOneSlave) {
  for (unsigned seed = 0; seed < 20; ++seed) commission(1, seed);
}

TEST(LssNetwork, FastscanFindsEachOfTwoSlavesOnce) {
  for (unsigned seed = 0; seed < 20; ++seed) commission(2, seed);
}

TEST(LssNetwork, FastscanFindsEachOfTwentySlavesOnce) {
  for (unsigned seed = 0; seed < 3; ++seed) commission(20, seed);
}

/// Finds all devices, each of which confirms its address; no node-ID is assigned.
void find_all(std::size_t count, unsigned seed, bool answers_always) {
  Network network;
  std::vector<LssAddress> addresses = random_addresses(count, seed);
  for (const LssAddress& address : addresses) {
    network.devices.emplace_back(network.bus, unconfigured_node_id, address, answers_always);
  }
  std::vector<LssAddress> found;
  LssOutcome outcome = network.finish(network.master.fastscan(network.bus.now()));
  while (outcome == LssOutcome::done && found.size() <= count) {
    found.push_back(network.master.address());
    ASSERT_EQ(network.finish(network.master.inquire_serial_number(network.bus.now())), LssOutcome::done);
    EXPECT_EQ(network.master.value(), found.back().serial_number);
    network.finish(network.master.switch_state_global(LssState::waiting, network.bus.now()));
    network.bus.settle();
    outcome = network.finish(network.master.fastscan_above(found.back(), 0, network.bus.now()));
  }
  const auto ascending = [](const LssAddress& a, const LssAddress& b) {
    return std::tie(a.vendor_id, a.product_code, a.revision_number, a.serial_number) <
           std::tie(b.vendor_id, b.product_code, b.revision_number, b.serial_number);
  };
  std::ranges::sort(addresses, ascending);
  EXPECT_EQ(found, addresses);
  for (const BusDevice& one : network.devices) EXPECT_EQ(one.device.slave.node_id(), unconfigured_node_id);
}

TEST(LssNetwork, FindsAllSlavesOneAboveTheOther) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    find_all(1, seed, false);
    find_all(3, seed, false);
  }
  find_all(20, 305, false);
}

TEST(LssNetwork, FindsAllSlavesThatAnswerEveryFastscanFrameInConfigurationState) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    find_all(1, seed, true);
    find_all(2, seed, true);
  }
}

TEST(LssNetwork, FindsAboveAnAddressAmongTheKnownNumbers) {
  Network network;
  for (const std::uint32_t serial : {4u, 9u}) {
    network.devices.emplace_back(network.bus, unconfigured_node_id, LssAddress{1, 2, 3, serial});
  }
  network.devices.emplace_back(network.bus, unconfigured_node_id, LssAddress{1, 2, 4, 0});
  EXPECT_EQ(network.finish(network.master.fastscan_above({1, 2, 3, 4}, 3, network.bus.now())), LssOutcome::done);
  EXPECT_EQ(network.master.address(), (LssAddress{1, 2, 3, 9}));
  network.finish(network.master.switch_state_global(LssState::waiting, network.bus.now()));
  network.bus.settle();
  EXPECT_EQ(network.finish(network.master.fastscan_above({1, 2, 3, 9}, 3, network.bus.now())), LssOutcome::no_answer);
  EXPECT_EQ(network.finish(network.master.fastscan_above({1, 2, 3, 9}, 2, network.bus.now())), LssOutcome::done);
  EXPECT_EQ(network.master.address(), (LssAddress{1, 2, 4, 0}));
}

TEST(LssNetwork, FastscanFindsAddressesOfZerosAndOfOnes) {
  Network network;
  network.devices.emplace_back(network.bus, unconfigured_node_id, LssAddress{~0u, ~0u, ~0u, ~0u});
  EXPECT_EQ(network.finish(network.master.fastscan(network.bus.now())), LssOutcome::done);
  EXPECT_EQ(network.master.address(), (LssAddress{~0u, ~0u, ~0u, ~0u}));
  network.devices.emplace_back(network.bus, unconfigured_node_id, LssAddress{});
  EXPECT_EQ(network.finish(network.master.fastscan(network.bus.now())), LssOutcome::done);
  EXPECT_EQ(network.master.address(), LssAddress{});
}

TEST(LssNetwork, FastscanLooksAmongTheKnownProducts) {
  Network network;
  network.devices.emplace_back(network.bus, unconfigured_node_id, LssAddress{1, 2, 3, 4});
  network.devices.emplace_back(network.bus, unconfigured_node_id, bench::rk5c_address);
  network.requests = 0;
  EXPECT_EQ(network.finish(network.master.fastscan({0x93, 0x4335'4B52, 0, 0}, 2, network.bus.now())), LssOutcome::done);
  EXPECT_EQ(network.master.address(), bench::rk5c_address);
  EXPECT_GE(network.requests, 1 + 2 + 2 * 33);
  EXPECT_LE(network.requests, 1 + 2 + 2 * 65);
  EXPECT_EQ(network.finish(network.master.fastscan({0x94, 0, 0, 0}, 1, network.bus.now())), LssOutcome::no_answer);
}

TEST(LssNetwork, ConfiguredSlavesTakeNoPartInAFastscan) {
  Network network;
  network.devices.emplace_back(network.bus, NodeId{5}, bench::rk5c_address);
  EXPECT_EQ(network.finish(network.master.fastscan(network.bus.now())), LssOutcome::no_answer);
}

TEST(LssNetwork, OneOfManyIsSelectedAndAnswersAlone) {
  Network network;
  const std::vector<LssAddress> addresses = random_addresses(20, 305);
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    network.devices.emplace_back(network.bus, NodeId{static_cast<std::uint8_t>(i + 1)}, addresses[i]);
  }
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    ASSERT_EQ(network.finish(network.master.switch_state_selective(addresses[i], network.bus.now())), LssOutcome::done);
    ASSERT_EQ(network.finish(network.master.inquire_node_id(network.bus.now())), LssOutcome::done);
    EXPECT_EQ(network.master.value(), i + 1);
    network.finish(network.master.switch_state_global(LssState::waiting, network.bus.now()));
    network.bus.settle();
  }
}

TEST(LssNetwork, ARangeOfSerialNumbersIsHalvedDownToOneSlave) {
  Network network;
  network.devices.emplace_back(network.bus, NodeId{5}, bench::rk5c_address);
  LssAddressRange range{.vendor_id = 0x93, .product_code = 0x4335'4B52};
  while (range.serial_number_low < range.serial_number_high) {
    const std::uint32_t middle = range.serial_number_low + (range.serial_number_high - range.serial_number_low) / 2;
    LssAddressRange lower = range;
    lower.serial_number_high = middle;
    if (network.finish(network.master.identify_remote_slave(lower, network.bus.now())) == LssOutcome::done) {
      range = lower;
    } else {
      range.serial_number_low = middle + 1;
    }
  }
  EXPECT_EQ(range.serial_number_low, bench::rk5c_address.serial_number);
}

TEST(LssNetwork, AllSlavesSwitchTheBitRateTogether) {
  Network network;
  for (std::uint8_t i = 1; i <= 3; ++i) network.devices.emplace_back(network.bus, NodeId{i}, LssAddress{1, 2, 3, i});
  network.finish(network.master.switch_state_global(LssState::configuration, network.bus.now()));
  ASSERT_EQ(network.finish(network.master.configure_bit_timing({0, 3}, network.bus.now())), LssOutcome::done);
  network.bus.settle();
  const auto begin = network.bus.now();
  ASSERT_EQ(network.finish(network.master.activate_bit_timing(100ms, network.bus.now())), LssOutcome::done);
  EXPECT_GE(network.bus.now() - begin, 200ms);
  network.bus.run_for(1ms);
  for (const BusDevice& one : network.devices) {
    ASSERT_EQ(one.device.events.size(), 2u);
    EXPECT_FALSE(one.device.slave.silent());
  }
}

}  // namespace
