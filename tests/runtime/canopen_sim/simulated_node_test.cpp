/// A device behind one interface: from power-on to power-off, with and without an application.
#include <gtest/gtest.h>
#include <canopen/node/handlers.hpp>
#include <canopen_sim/simulated_node.hpp>

#include <every_service/device.hpp>
#include <memory>
#include <string>
#include <tuple>

#include "support/bench.hpp"

namespace {

using canopen::AbortCode;
using canopen::ErrorRegister;
using canopen::NodeId;
using canopen::SimulatedMemory;
using canopen::SimulatedNode;
using canopen::TimePoint;
using namespace std::chrono_literals;
namespace od = every_service::od;

struct Bus : canopen::SimulatedBus {
  bool send(const canopen::Frame& frame) override { return log.send(frame); }
  bench::RecordingBus log;
};

/// A device with node-ID 5 that is switched on at time 0.
template <class Application = canopen::NoApplication>
struct Switched {
  explicit Switched(SimulatedMemory& memory)
      : node{canopen::make_simulated_node<every_service::Device, Application>(bus, memory)} {
    node->start(TimePoint{});
  }
  std::string ask(const std::string& request, TimePoint now = {}) {
    node->on_frame(bench::frame(request), now);
    return bus.log.take();
  }
  Bus bus;
  std::unique_ptr<SimulatedNode> node;
};

struct CountingApplication {
  void every(canopen::Milliseconds<1>, auto& node) { node.set(od::byte{}, static_cast<std::uint8_t>(++calls)); }
  int calls = 0;
};

struct CarefulApplication {
  void start(auto& node) { node.set(od::byte{}, 3); }
  canopen::Result<void> write(od::word, std::uint16_t value) {
    return value <= 1000 ? canopen::ok : AbortCode::value_too_high;
  }
};

struct ApplicationWithHandlers {
  void start(auto& node) { node.set(od::byte{}, 3); }
  auto handlers() {
    return std::tuple{canopen::application_at(*this),
                      canopen::on_write<od::word>([](std::uint16_t) { return AbortCode::device_state; }),
                      canopen::every<canopen::Milliseconds<5>>([](auto& node) { node.set(od::byte{}, 5); })};
  }
};

TEST(SimulatedNode, BootsAndAnswers) {
  SimulatedMemory memory{NodeId{5}};
  Switched device{memory};
  EXPECT_EQ(device.bus.log.take(), "705 00");
  EXPECT_EQ(device.ask("605 2F 00 20 00 07 00 00 00"), "585 60 00 20 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 40 00 20 00 00 00 00 00"), "585 4F 00 20 00 07 00 00 00");
}

TEST(SimulatedNode, IsDueWhenItsNodeIs) {
  SimulatedMemory memory{NodeId{5}};
  Switched device{memory};
  device.ask("605 2B 17 10 00 64 00 00 00");  // heartbeat: 100 ms
  device.node->on_time(TimePoint{});
  device.bus.log.take();
  EXPECT_EQ(device.node->next_deadline(), TimePoint{100ms});
  device.node->on_time(TimePoint{100ms});
  EXPECT_EQ(device.bus.log.take(), "705 7F");
}

TEST(SimulatedNode, IsDueAtThePeriodOfItsApplication) {
  SimulatedMemory memory{NodeId{5}};
  Switched<CountingApplication> device{memory};
  device.ask("605 2B 17 10 00 64 00 00 00");
  device.node->on_time(TimePoint{});
  EXPECT_EQ(device.node->next_deadline(), TimePoint{1ms}) << "before the heartbeat";
  device.node->on_time(TimePoint{999us});
  EXPECT_EQ(device.ask("605 40 00 20 00 00 00 00 00"), "585 4F 00 20 00 00 00 00 00");
  device.node->on_time(TimePoint{1ms});
  EXPECT_EQ(device.ask("605 40 00 20 00 00 00 00 00"), "585 4F 00 20 00 01 00 00 00");
  EXPECT_EQ(device.node->next_deadline(), TimePoint{2ms});
}

TEST(SimulatedNode, AsksTheFunctionsOfItsApplication) {
  SimulatedMemory memory{NodeId{5}};
  Switched<CarefulApplication> device{memory};
  device.bus.log.take();
  EXPECT_EQ(device.ask("605 40 00 20 00 00 00 00 00"), "585 4F 00 20 00 03 00 00 00");
  EXPECT_EQ(device.ask("605 2B 01 20 00 E9 03 00 00"), "585 80 01 20 00 31 00 09 06") << "0609 0031h: too high";
}

TEST(SimulatedNode, AsksTheHandlersOfItsApplication) {
  SimulatedMemory memory{NodeId{5}};
  Switched<ApplicationWithHandlers> device{memory};
  device.bus.log.take();
  EXPECT_EQ(device.ask("605 2B 01 20 00 E9 03 00 00"), "585 80 01 20 00 22 00 00 08") << "0800 0022h: device state";
  EXPECT_EQ(device.ask("605 40 00 20 00 00 00 00 00"), "585 4F 00 20 00 03 00 00 00") << "start of the class itself";
  device.node->on_time(TimePoint{});
  EXPECT_EQ(device.node->next_deadline(), TimePoint{5ms});
  device.node->on_time(TimePoint{5ms});
  EXPECT_EQ(device.ask("605 40 00 20 00 00 00 00 00"), "585 4F 00 20 00 05 00 00 00");
}

TEST(SimulatedNode, DoesWhatTheApplicationDoesByItself) {
  SimulatedMemory memory{NodeId{5}};
  Switched device{memory};
  device.bus.log.take();
  const std::uint8_t nine = 9;
  EXPECT_EQ(device.node->set(0x2000, 0, {&nine, 1}), canopen::ok);
  EXPECT_EQ(device.ask("605 40 00 20 00 00 00 00 00"), "585 4F 00 20 00 09 00 00 00");
  device.node->emergency(0x2310, ErrorRegister::current);
  device.node->on_time(TimePoint{});
  EXPECT_EQ(device.bus.log.take().substr(0, 12), "085 10 23 03") << "error register: generic and current";
  device.node->emergency_over(ErrorRegister::current);
  device.node->on_time(TimePoint{1s});
  EXPECT_EQ(device.bus.log.take().substr(0, 12), "085 00 00 00");
}

TEST(SimulatedNode, KeepsItsParametersWithoutPower) {
  SimulatedMemory memory{NodeId{5}};
  {
    Switched device{memory};
    device.ask("605 2B 17 10 00 64 00 00 00");
    EXPECT_EQ(device.ask("605 23 10 10 01 73 61 76 65"), "585 60 10 10 01 00 00 00 00");
    device.ask("605 2B 17 10 00 C8 00 00 00");
  }
  Switched device{memory};
  device.bus.log.take();
  EXPECT_EQ(device.ask("605 40 17 10 00 00 00 00 00"), "585 4B 17 10 00 64 00 00 00");
}

/// CiA 305: selects all nodes, sets the node-ID and stores it.
TEST(SimulatedNode, KeepsTheNodeIdThatLssHasStored) {
  SimulatedMemory memory{NodeId{5}};
  {
    Switched device{memory};
    device.ask("7E5 04 01 00 00 00 00 00 00");
    EXPECT_EQ(device.ask("7E5 11 06 00 00 00 00 00 00"), "7E4 11 00 00 00 00 00 00 00");
    EXPECT_EQ(device.ask("7E5 17 00 00 00 00 00 00 00"), "7E4 17 00 00 00 00 00 00 00");
  }
  EXPECT_EQ(memory.node_id(), NodeId{6});
  Switched device{memory};
  EXPECT_EQ(device.bus.log.take(), "706 00");
}

}  // namespace
