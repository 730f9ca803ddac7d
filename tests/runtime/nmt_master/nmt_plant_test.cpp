/// A master and six slaves on a bus that loses, repeats and delays frames; slaves are switched off and on, and at times
/// the master cannot send. No late frame is mistaken for another one, and after the faults all slaves are booted,
/// configured and Operational.
#include <gtest/gtest.h>
#include <canopen/nmt_master/nmt_master.hpp>
#include <canopen_sim/bus_faults.hpp>
#include <canopen_sim/virtual_bus.hpp>

#include <array>
#include <list>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "support/bench.hpp"

namespace {

using canopen::AbortCode;
using canopen::BootResult;
using canopen::BootStatus;
using canopen::Frame;
using canopen::NmtMasterEvent;
using canopen::NmtSlave;
using canopen::NmtState;
using canopen::NodeId;
using canopen::SdoAnswer;
using canopen::SdoRequest;
using canopen::TimePoint;
using canopen::VirtualBus;
namespace od = sample::od;
namespace assignment = canopen::slave_assignment;
using namespace std::chrono_literals;

constexpr std::size_t slave_count = 6;
constexpr canopen::BusFaultRates faulty{.lost = 0.01, .repeated = 0.01, .delayed = 0.05, .longest_delay = 20ms};

/// The master's access to the bus, which is off or full at times.
struct Port {
  VirtualBus::Endpoint& end;
  std::mt19937& random;
  bool off = false;
  double full = 0;

  bool send(const Frame& frame) {
    if (off || std::uniform_real_distribution<>{}(random) < full) return false;
    return end.send(frame);
  }
};

class Slave {
 public:
  Slave(VirtualBus& bus, std::uint8_t node_id, std::uint32_t seed)
      : bus_{bus}, end_{bus.attach()}, node_{end_, NodeId{node_id}} {
    end_.queue_limit = 100;
    end_.on_frame = [this](const Frame& frame, TimePoint now) {
      if (on_) node_.on_frame(frame, now);
    };
    end_.on_time = [this](TimePoint now) {
      if (on_) node_.on_time(now);
    };
    end_.next_deadline = [this]() -> std::optional<TimePoint> { return on_ ? node_.next_deadline() : std::nullopt; };
    faults_.emplace(end_, faulty, seed);
  }

  void switch_on() {
    on_ = true;
    node_.start(bus_.now());
  }
  void switch_off() { on_ = false; }
  void end_faults() { faults_->rates = {}; }

  [[nodiscard]] bool on() const { return on_; }
  [[nodiscard]] const auto& node() const { return node_; }

 private:
  VirtualBus& bus_;
  VirtualBus::Endpoint& end_;
  bench::NodeOf<sample::Device, VirtualBus::Endpoint> node_;
  std::optional<canopen::BusFaults> faults_;
  bool on_ = false;
};

struct Plant;

struct Host {
  Plant* plant;
  void happened(NmtMasterEvent, NodeId, NmtState) {}
  void configure(NodeId node_id);
  void booted(NodeId node_id, const BootResult& result);
  void network_started() {}
  void boot_time_elapsed() {}
};

struct Plant {
  explicit Plant(std::uint32_t seed) : random{seed}, port{end, random} {
    end.queue_limit = 4;
    for (std::uint8_t i = 0; i < slave_count; ++i) {
      devices.emplace_back(bus, static_cast<std::uint8_t>(i + 1), seed * 100 + i);
      NmtSlave slave{NodeId{static_cast<std::uint8_t>(i + 1)},
                     assignment::listed | assignment::boot | assignment::mandatory,
                     0xF0191,
                     0x1234,
                     0x10001,
                     0x10002};
      slave.heartbeat_time = 100;
      slaves.push_back(slave);
      configurations[i].plant = this;
    }
    master.emplace(port, slaves, canopen::NmtStartUp{}, 50ms, Host{this});
    VirtualBus::connect(end, *master);
    faults.emplace(end, faulty, seed * 100 + 99);
  }

  /// Two transfers, one after the other; the second one is segmented.
  struct Configuration {
    Plant* plant = nullptr;
    int step = 0;
    int running = 0;
    std::array<std::uint8_t, 3> number{0x33, 0x00, 0x00};
    std::array<std::uint8_t, 16> text{'s', 'i', 'x', 't', 'e', 'e', 'n', ' ', 'l', 'e', 't', 't', 'e', 'r', 's', '.'};

    void begin(NodeId node_id) {
      SdoRequest request;
      request.download = true;
      request.index = step == 0 ? 0x2003 : 0x200C;
      request.bytes = step == 0 ? std::span<const std::uint8_t>{number} : std::span<const std::uint8_t>{text};
      request.context = this;
      request.done = [](void* context, NodeId node, const SdoAnswer& answer) {
        static_cast<Configuration*>(context)->done(node, answer);
      };
      ++running;
      if (const auto begun = plant->master->request(node_id, request, plant->bus.now()); !begun) {
        --running;
        plant->end_configuration(node_id, begun.abort_code());
      }
    }
    void done(NodeId node_id, const SdoAnswer& answer) {
      --running;
      if (answer.result == AbortCode::device_state) return;  // it has booted up: `configure` is called again
      if (answer.result != canopen::ok || step == 1) return plant->end_configuration(node_id, answer.result);
      step = 1;
      begin(node_id);
    }
  };

  void end_configuration(NodeId node_id, AbortCode code) { master->configured(node_id, code, bus.now()); }

  /// The faults of a tenth of a second.
  void disturb() {
    auto device = devices.begin();
    std::advance(device, random() % slave_count);
    if (random() % 4 == 0) device->switch_off();
    if (random() % 4 == 0) device->switch_on();  // also if it is on
    port.off = random() % 10 == 0;
    port.full = random() % 3 == 0 ? 0.3 : 0;
    if (random() % 40 == 0) master->start(bus.now());
    if (random() % 10 == 0) {  // another client sends a request
      other.send(Frame{
          .id = static_cast<std::uint32_t>(0x601 + random() % slave_count), .size = 8, .data = {0x40, 0x00, 0x10}});
    }
  }

  /// A slave that has failed is booted again by the application.
  void boot_failed() {
    for (const NodeId node_id : std::exchange(failed, {})) master->boot(node_id, bus.now());
  }

  /// NMT commands are not confirmed: the application starts a slave again if it has not received the command.
  void start_again() {
    for (const NmtSlave& slave : slaves) {
      const bool booted = master->status(slave.node_id) == BootStatus::booted;
      const bool is_waiting = master->state(slave.node_id) == NmtState::pre_operational;
      if (booted && is_waiting) (void)master->command(canopen::NmtCommand::start, slave.node_id);
    }
  }

  std::mt19937 random;
  VirtualBus bus{500'000};
  VirtualBus::Endpoint& end = bus.attach();
  VirtualBus::Endpoint& other = bus.attach();
  Port port;
  std::list<Slave> devices;
  std::vector<NmtSlave> slaves;
  std::array<Configuration, slave_count> configurations{};
  std::vector<NodeId> failed;
  std::string wrong_identities;
  int boots = 0;
  std::optional<canopen::NmtMaster<Port, slave_count, Host, 8, 3>> master;
  std::optional<canopen::BusFaults> faults;
};

void Host::configure(NodeId node_id) {
  Plant::Configuration& configuration = plant->configurations[node_id.value() - 1u];
  if (configuration.running != 0) return plant->end_configuration(node_id, AbortCode::no_resource);
  configuration.step = 0;
  configuration.begin(node_id);
}

void Host::booted(NodeId node_id, const BootResult& result) {
  switch (result.status) {
    case BootStatus::booted: ++plant->boots; return;
    case BootStatus::configuration:
    case BootStatus::no_heartbeat: plant->failed.push_back(node_id); return;
    case BootStatus::no_response: return;
    case BootStatus::restarted:
    case BootStatus::extra_response:
    case BootStatus::heartbeat_rate:
    case BootStatus::heartbeat_states: plant->failed.push_back(node_id); return;
    default: plant->wrong_identities += static_cast<char>(result.status);
  }
}

TEST(NmtPlant, BootsAllSlavesAfterWhateverHasGoneWrong) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    Plant plant{seed};
    for (Slave& device : plant.devices) device.switch_on();
    plant.master->start(plant.bus.now());
    for (int i = 0; i < 50; ++i) {
      plant.disturb();
      plant.bus.run_for(100ms);
      plant.boot_failed();
    }
    EXPECT_GT(plant.boots, 0);
    plant.port.off = false;
    plant.port.full = 0;
    plant.faults->rates = {};
    for (Slave& device : plant.devices) {
      device.end_faults();
      if (!device.on()) device.switch_on();
    }
    for (int i = 0; i < 60; ++i) {
      plant.bus.run_for(100ms);
      plant.boot_failed();
      plant.start_again();
    }
    EXPECT_EQ(plant.wrong_identities, "") << "a stale answer was taken for another";
    EXPECT_TRUE(plant.master->network_started());
    for (const Slave& device : plant.devices) {
      EXPECT_EQ(device.node().state(), NmtState::operational);
      EXPECT_EQ(device.node().template get<od::integer24_value>(), 0x33);
      EXPECT_EQ(device.node().template get<od::visible_string_value>().view(), "sixteen letters.");
    }
    for (const Plant::Configuration& configuration : plant.configurations) EXPECT_EQ(configuration.running, 0);
    if (testing::Test::HasFailure()) break;
  }
}

}  // namespace
