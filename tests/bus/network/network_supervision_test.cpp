/// `edsc network apply` at slaves with faults of hardware and firmware, in simulated time: nothing that is partly
/// configured is started, and the fault is reported. The slaves do not use the runtime.
#include <gtest/gtest.h>
#include <canopen_sim/virtual_bus.hpp>

#include <deque>
#include <filesystem>
#include <fstream>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "network/network.hpp"
#include "network/network_session.hpp"
#include "network/node_configuration.hpp"
#include "support/faulty_slave.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

using canopen::Duration;
using canopen::Frame;
using canopen::TimePoint;
using canopen::VirtualBus;
using faulty::Fault;

/// The bus of a command, in simulated time.
class VirtualPort final : public BusPort {
 public:
  explicit VirtualPort(VirtualBus& bus) : bus_{bus} {
    end_.on_frame = [this](const Frame& frame, TimePoint) { received_.push_back(frame); };
  }
  ~VirtualPort() override { end_.on_frame = nullptr; }  // the bus lives longer
  VirtualPort(const VirtualPort&) = delete;
  VirtualPort& operator=(const VirtualPort&) = delete;
  bool send(const Frame& frame) override { return end_.send(frame); }
  std::optional<Frame> receive(Duration timeout) override {
    bus_.run_until([this] { return !received_.empty(); }, timeout);
    if (received_.empty()) return std::nullopt;
    const Frame frame = received_.front();
    received_.pop_front();
    return frame;
  }
  TimePoint now() const override { return bus_.now(); }
  TimePoint received_at() const override { return bus_.now(); }

 private:
  VirtualBus& bus_;
  VirtualBus::Endpoint& end_ = bus_.attach();
  std::deque<Frame> received_;
};

class NetworkApply : public testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::path{testing::TempDir()} / "network_supervision";
    std::filesystem::create_directories(folder);
  }

  /// Reads a network of one slave, node 5, with three values that are not the default ones.
  void load(const std::string& members) {
    const std::string path = folder / "plant.json";
    std::ofstream{path} << R"({"bit_rate": 500, "nodes": {"master": {"node_id": 127, "master": true}, "axis": {)"
                        << R"("node_id": 5, "eds": ")" << EDSC_SOURCE_DIR << R"(/tests/generator/network/node.eds")"
                        << R"(, "set": {"2000h": 1500, "2001h": 7, "1015h": 20})" << members << "}}}";
    Diagnostics diagnostics;
    loaded = load_network(path, diagnostics);
    ASSERT_EQ(diagnostics.errors(), 0u) << (diagnostics.all().empty() ? "" : diagnostics.all().front().message);
    const Network& network = loaded->network;
    const NetworkNode& node = *network.find("axis");
    LiveNode live;
    live.node = &node;
    live.configuration = configuration_of(network, node, linked_pdos(network), diagnostics);
    live.sdo_timeout_ms = sdo_timeout_ms(network.description, *node.description);
    nodes.clear();
    nodes.push_back(std::move(live));
    values.clear();
    expected.clear();
    for (const Object& object : node.device().objects) {
      for (const Entry& entry : object.entries) {
        if (!entry.default_value) continue;
        const std::string bytes = bytes_of(*entry.default_value, *entry.type);
        values[std::uint32_t{entry.index} << 8 | entry.sub_index] = {bytes.begin(), bytes.end()};
      }
    }
    values[0x101801] = values[0x101801];
    for (const ConfigurationValue& value : nodes.front().configuration.values) {
      expected[std::uint32_t{value.entry.index} << 8 | value.entry.sub_index] = value.bytes;
    }
  }

  faulty::Slave& add(faulty::Settings settings) {
    VirtualBus::Endpoint& port = bus.attach();
    settings.values = values;
    // The device of the network has its configuration already.
    for (const auto& [entry, bytes] : expected) settings.values.insert_or_assign(entry, faulty::Bytes(bytes.size(), 0));
    faulty::Slave& slave =
        slaves.emplace_back(std::move(settings), [&port](const Frame& frame) { static_cast<void>(port.send(frame)); });
    slave.expected = expected;
    port.queue_limit = 1000;
    port.on_frame = [this, &slave](const Frame& frame, TimePoint) { slave.on_frame(frame, bus.elapsed()); };
    port.on_time = [this, &slave](TimePoint) { slave.on_time(bus.elapsed()); };
    port.next_deadline = [&slave]() -> std::optional<TimePoint> {
      const auto next = slave.next_deadline();
      return next ? std::optional{TimePoint{Duration{static_cast<std::uint32_t>(*next)}}} : std::nullopt;
    };
    slave.power_on(bus.elapsed());
    return slave;
  }

  /// Returns whether the nodes were started.
  bool apply(OnError on_error = OnError::abort) {
    LiveBus live{std::make_unique<VirtualPort>(bus)};
    live.listen(canopen::from_milliseconds(1000));
    NetworkSession session{live,
                           nodes,
                           {},
                           {[](const LiveNode&, std::string_view, std::size_t, std::size_t) {}, [](const LiveNode&) {},
                            [](const LiveNode&) {}}};
    ApplySettings settings;
    settings.start = true;
    settings.on_error = on_error;
    const bool started = session.identify(true) && session.compare() && session.apply(settings);
    live.listen(canopen::from_milliseconds(100));
    return started;
  }

  [[nodiscard]] std::string problems() const {
    std::string text;
    for (const NodeProblem& problem : nodes.front().problems) text += problem.text + "\n";
    for (const std::string& problem : nodes.front().run.problems) text += problem + "\n";
    for (const ConfigurationFailure& failure : nodes.front().run.result.failures) text += failure.what + "\n";
    return text;
  }

  std::filesystem::path folder;
  VirtualBus bus;
  std::unique_ptr<LoadedNetwork> loaded;
  std::vector<LiveNode> nodes;
  faulty::Values values, expected;
  std::list<faulty::Slave> slaves;
};

struct Row {
  const char* name;
  Fault fault;
  faulty::Entry entry;
  const char* text;  ///< of the problem; empty: the node is started
  std::uint32_t delay_us = 300;
};

constexpr Row rows[] = {
    {"good slave", Fault::none, 0, ""},
    {"answers twice", Fault::answers_twice, 0, "an SDO request got more than one response"},
    {"late abort", Fault::late_abort, 0x200100, "an SDO request got more than one response"},
    {"loses power", Fault::loses_power, 0x200000, "restarted"},
    {"ignores a value", Fault::ignores_write, 0x200000, "reads back as 0"},
    {"rejects a value", Fault::rejects_write, 0x200000, "0609 0030h"},
    {"aborts with code 0", Fault::aborts_with_zero, 0x200000, "0000 0000h, not an abort code of CiA 301"},
    {"twice as many heartbeats", Fault::heartbeat_fast, 0, "expected 100 ms, seen 50 ms"},
    {"half of the heartbeats", Fault::heartbeat_slow, 0, "does not send its heartbeats at the rate of 1017h"},
    {"heartbeats with two states", Fault::heartbeat_states, 0, "heartbeats with different states"},
};

TEST_F(NetworkApply, NeverStartsANodeWithoutItsConfiguration) {
  for (const Row& row : rows) {
    SCOPED_TRACE(row.name);
    load(R"(, "heartbeat_ms": 100)");
    faulty::Slave& slave = add({.fault = row.fault, .entry = row.entry, .delay_us = row.delay_us});
    const bool is_good = *row.text == 0;
    EXPECT_EQ(apply(), is_good) << problems();
    EXPECT_EQ(slave.operational(), is_good);
    EXPECT_EQ(slave.wrong_starts(), 0u);
    EXPECT_NE(problems().find(row.text), std::string::npos) << problems();
    slave.power_off();
  }
}

TEST_F(NetworkApply, TwoNodesWithOneNodeIdAreNotStarted) {
  for (const Fault fault : {Fault::none, Fault::rejects_write}) {
    load("");
    faulty::Slave& one = add({});
    faulty::Slave& other = add({.fault = fault, .entry = 0x200000, .delay_us = 900});
    EXPECT_FALSE(apply());
    EXPECT_NE(problems().find("two nodes may have node-ID 5"), std::string::npos) << problems();
    EXPECT_EQ(one.starts() + other.starts(), 0u);
    one.power_off();
    other.power_off();
  }
}

TEST_F(NetworkApply, ASlowNodeIsConfiguredWithTheTimeoutOfTheNetworkFile) {
  for (const bool has_timeout : {false, true}) {
    load(has_timeout ? R"(, "sdo_timeout_ms": 1000)" : "");
    faulty::Slave& slave = add({.delay_us = 700'000});
    EXPECT_EQ(apply(), has_timeout) << problems();
    EXPECT_EQ(slave.operational(), has_timeout);
    slave.power_off();
  }
}

}  // namespace
}  // namespace edsc
