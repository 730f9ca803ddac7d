/// The four I/O modules, wired to each other: the worked example of manual 003 with the runnable nodes.
#include "plant/plant.hpp"

#include <gtest/gtest.h>

#include <array>
#include <canopen_sim/virtual_bus.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "node_bench.hpp"
#include "shared/run_node.hpp"
#include "traces/player.hpp"
#include "traces/station.hpp"
#include "traces/trace.hpp"
#include "traces/trace_files.hpp"

namespace {

using namespace std::chrono_literals;

// The worked example, with the trace player

/// A runnable module as a station of a trace.
template <template <class Bus> class Module>
class ModuleStation final : public trace::Station {
 public:
  explicit ModuleStation(canopen::NodeId node_id) : around_{node_id} { module.emplace(*this, around_); }

  void power_on(canopen::TimePoint now) override {
    const bench::InApplication here;
    module->start(now);
  }
  void power_off() override { FAIL() << "the modules of a plant stay on"; }
  void on_frame(const canopen::Frame& frame, canopen::TimePoint now) override {
    const bench::InApplication here;
    module->on_frame(frame, now);
  }
  void on_time(canopen::TimePoint now) override {
    const bench::InApplication here;
    module->on_time(now);
  }
  [[nodiscard]] std::optional<canopen::TimePoint> next_deadline() const override { return module->next_deadline(); }

  /// Sets what an input measures, independent of its wire.
  [[nodiscard]] canopen::AbortCode set(std::uint16_t index, std::uint8_t sub_index,
                                       const trace::Value& value) override {
    const auto channel = static_cast<std::uint8_t>(sub_index - 1);
    if (index != 0x6401) return canopen::AbortCode::no_object;
    module->set_analogue(channel, static_cast<std::int16_t>(value.number));
    return canopen::ok;
  }
  void emergency(const trace::Emergency& error) override {
    module->node().emergency(error.code, error.bits, error.info);
  }
  void emergency_over(canopen::ErrorRegister bits) override { module->node().emergency_over(bits); }
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> value(std::uint16_t index, std::uint8_t sub_index) override {
    const canopen::entry::Word word = module->node().entries().dictionary().find(index, sub_index);
    if (word <= canopen::Dictionary::no_sub_index) return std::nullopt;
    std::array<std::uint8_t, 8> scratch{};
    const std::span<const std::uint8_t> bytes = module->node().entries().read(word, scratch);
    return std::vector<std::uint8_t>{bytes.begin(), bytes.end()};
  }

  std::optional<Module<trace::Station>> module;

 private:
  nodes::Surroundings around_;
};

class PlantTraces : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(PlantTraces, AreWhatTheModulesDo) {
  const trace::Trace trace = trace::read(GetParam());
  const std::vector<std::string> expected = {"can-2057c 1", "can-2053c 2", "can-2024c 3", "can-2017c 4"};
  std::vector<std::string> named;
  for (const trace::NodeOfTrace& node : trace.nodes) {
    named.push_back(node.device + " " + std::to_string(node.node_id.value()));
  }
  ASSERT_EQ(named, expected);
  auto digital_out = std::make_unique<ModuleStation<Can2057c>>(canopen::NodeId{1});
  auto digital_in = std::make_unique<ModuleStation<Can2053c>>(canopen::NodeId{2});
  auto analogue_out = std::make_unique<ModuleStation<Can2024c>>(canopen::NodeId{3});
  auto analogue_in = std::make_unique<ModuleStation<Can2017c>>(canopen::NodeId{4});
  wire(*digital_out->module, *digital_in->module, *analogue_out->module, *analogue_in->module);
  std::vector<std::unique_ptr<trace::Station>> stations;
  stations.push_back(std::move(digital_out));
  stations.push_back(std::move(digital_in));
  stations.push_back(std::move(analogue_out));
  stations.push_back(std::move(analogue_in));
  for (const trace::Failure& failure : trace::play(trace, stations)) {
    ADD_FAILURE_AT(trace.file.c_str(), static_cast<int>(failure.line)) << "  " << failure.message;
  }
}

INSTANTIATE_TEST_SUITE_P(Manual003, PlantTraces, testing::ValuesIn(trace::files_in(EDSC_PLANT_TRACES_DIR)),
                         trace::test_name);

// In one process on one bus

/// The plant and the frames on its bus.
struct PlantOnABus : testing::Test {
  PlantOnABus() {
    canopen::VirtualBus::connect(port, plant);
    bus.listen([this](const canopen::Frame& frame, canopen::TimePoint) {
      log += (log.empty() ? "" : " | ") + bench::text(frame);
    });
    plant.start(bus.now());
    bus.settle();
  }
  std::string take() {
    bus.settle();
    return std::exchange(log, {});
  }
  std::string send(const std::string& frame) {
    master.send(bench::frame(frame));
    return take();
  }
  std::string input(const char* line) {
    EXPECT_TRUE(plant.input(nodes::InputLine{line}, bus.now())) << line;
    return take();
  }
  std::string log;
  canopen::VirtualBus bus;
  canopen::VirtualBus::Endpoint& port = bus.attach();
  canopen::VirtualBus::Endpoint& master = bus.attach();
  nodes::Surroundings around;
  Plant<canopen::VirtualBus::Endpoint> plant{port, around};
};

TEST_F(PlantOnABus, BringsOutputsToInputs) {
  EXPECT_EQ(take(), "701 00 | 702 00 | 703 00 | 704 00");
  EXPECT_EQ(send("000 01 00"), "000 01 00 | 182 00 00 | 284 00 00 00 00 00 00 00 00 | 384 00 00 00 00 00 00 00 00");
  EXPECT_EQ(send("201 34 12"), "201 34 12 | 182 34 12");
  EXPECT_EQ(send("303 FF 3F 00 80 00 00 01 00"), "303 FF 3F 00 80 00 00 01 00");  // analogue inputs do not send changes
  EXPECT_EQ(send("284 R 8"), "284 R 8 | 284 FF 3F 00 80 00 00 01 00");
  EXPECT_EQ(send("384 R 8"), "384 R 8 | 384 00 00 01 00 00 00 00 00");
}

TEST_F(PlantOnABus, TakesLinesForEachModule) {
  send("000 01 00");
  EXPECT_EQ(input("node 2 digital 1 0xF0"), "182 F0 00");
  EXPECT_EQ(input("node 4 analogue 7 -10"), "");
  EXPECT_EQ(send("384 R 8"), "384 R 8 | 384 00 00 00 00 00 80 00 00");
  EXPECT_EQ(input("node 1 fault eeprom"), "081 00 50 81 02 00 00 00 00");
  EXPECT_EQ(input("node 1 fault over"), "081 00 00 00 00 00 00 00 00");
  EXPECT_FALSE(plant.input(nodes::InputLine{"node 5 fault eeprom"}, bus.now()));
  EXPECT_FALSE(plant.input(nodes::InputLine{"node 1 digital 1 0"}, bus.now()));  // node 1 does not have digital inputs
}

TEST_F(PlantOnABus, SetsItsOutputsToTheirErrorValuesInStopped) {
  send("000 01 00");
  send("201 FF FF");
  EXPECT_EQ(send("000 02 01"), "000 02 01 | 182 00 00");
}

// A module on its own

// shows 003.1
TEST(ModuleNode, HasANodeIdOfTwoRotarySwitches1To99) {
  const auto parse = [](const std::string& node_id) {
    const char* const arguments[] = {"can_2057c", "bus", "--node-id", node_id.c_str()};
    return nodes::parse_arguments(4, arguments, Can2057c<bench::RecordingBus>::description.highest_node_id);
  };
  for (unsigned number = 1; number <= 99; ++number) {
    bench::NodeBench<Can2057c> module{parse(std::to_string(number)).node_id};
    EXPECT_EQ(module.boot_up, bench::text({.id = 0x700 + number, .size = 1}));
  }
  EXPECT_THROW(static_cast<void>(parse("0")), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(parse("100")), std::invalid_argument);
}

TEST(InputLine, TakesNumbersAsPeopleWriteThem) {
  const nodes::InputLine line{"fault 8976 0x2310 2310h 2310H -5 2310 0x 2310hh h"};
  EXPECT_EQ(line.number<std::uint16_t>(1), 0x2310);
  EXPECT_EQ(line.number<std::uint16_t>(2), 0x2310);
  EXPECT_EQ(line.number<std::uint16_t>(3), 0x2310);
  EXPECT_EQ(line.number<std::uint16_t>(4), 0x2310);
  EXPECT_EQ(line.number<std::int16_t>(5), -5);
  EXPECT_EQ(line.number<std::uint16_t>(6), 2310);
  for (const std::size_t word : {7u, 8u, 9u}) EXPECT_FALSE(line.number<std::uint16_t>(word)) << word;
}

// shows 003.65
TEST(ModuleNode, ScalesItsAnalogueChannels) {
  EXPECT_EQ(nodes::raw_from_volts(5), 0x3FFF);
  EXPECT_EQ(nodes::raw_from_volts(0), 0);
  EXPECT_EQ(nodes::raw_from_volts(-10), -32768);
  EXPECT_EQ(nodes::raw_from_volts(10), 32767);
  EXPECT_EQ(nodes::raw_from_volts(11), 32767);
  EXPECT_NEAR(nodes::volts_from_raw(0x4006), 5.002, 0.0005);
  bench::NodeBench<Can2017c> inputs;
  inputs.input("analogue 1 5.0");
  EXPECT_EQ(inputs.ask("605 40 01 64 01 00 00 00 00"), "585 4B 01 64 01 FF 3F 00 00");
  bench::NodeBench<Can2024c> outputs;
  outputs.ask("605 2B 11 64 01 06 40 00 00");
  EXPECT_TRUE(outputs.logged("analogue 1 5.002 V"));
}

// shows 003.183
TEST(ModuleNode, ShowsItsStateAndItsErrorsWithItsIndicators) {
  bench::NodeBench<Can2057c> module;
  EXPECT_TRUE(module.logged("RUN blinking"));
  module.ask(bench::start);
  EXPECT_TRUE(module.logged("RUN on"));
  module.app->on_bus_status({canopen::BusState::passive}, module.now);
  EXPECT_TRUE(module.logged("ERR single flash"));
  module.app->on_bus_status({canopen::BusState::off}, module.now);
  EXPECT_TRUE(module.logged("ERR on"));
  module.app->on_bus_status({}, module.now);
  EXPECT_TRUE(module.logged("ERR off"));
  module.ask("605 2B 0C 10 00 64 00 00 00");
  module.ask("605 2F 0D 10 00 01 00 00 00");
  module.ask("705 R 1");
  module.pass(100ms);
  EXPECT_TRUE(module.logged("ERR double flash"));
  module.ask("705 R 1");
  EXPECT_TRUE(module.logged("ERR off"));
  module.ask(bench::stop);
  EXPECT_TRUE(module.logged("RUN single flash"));
}

struct ModuleError {
  const char* line;  ///< input of the node
  const char* emcy;  ///< the row of table 5.3.2
  std::uint16_t register_1001h;
};

constexpr ModuleError module_errors[] = {
    {"fault can-controller", "085 00 10 81 01 00 00 00 00", 0x81},
    {"fault eeprom", "085 00 50 81 02 00 00 00 00", 0x81},
    {"fault rx-buffer", "085 10 81 11 04 00 00 00 00", 0x11},
    {"fault tx-buffer", "085 10 81 11 05 00 00 00 00", 0x11},
    {"can overrun", "085 10 81 11 06 00 00 00 00", 0x11},
    {"can off", "085 40 81 11 08 00 00 00 00", 0x11},
};

template <template <class Bus> class Module>
void expect_module_errors() {
  for (const ModuleError& row : module_errors) {
    SCOPED_TRACE(row.line);
    bench::NodeBench<Module> module;
    module.ask(bench::start);
    const nodes::InputLine line{row.line};
    if (const auto status = nodes::bus_status_of(line)) {
      module.app->on_bus_status(*status, module.now);
      EXPECT_EQ(module.bus.take(), row.emcy);
    } else {
      EXPECT_EQ(module.input(row.line), row.emcy);
    }
    EXPECT_EQ(module.ask("605 40 01 10 00 00 00 00 00"),
              row.register_1001h == 0x81 ? "585 4F 01 10 00 81 00 00 00" : "585 4F 01 10 00 11 00 00 00");
  }
}

// shows 003.71..003.75, 003.77
TEST(ModuleNode, ReportsTheErrorsOfTheTableInEveryModule) {
  expect_module_errors<Can2017c>();
  expect_module_errors<Can2024c>();
  expect_module_errors<Can2053c>();
  expect_module_errors<Can2057c>();
}

// Manual 003, 3.2: block protocols for larger data in both directions; the frames are those of CiA 301, 7.2.4.3.
TEST(ModuleNode, ServesSdoBlockTransfers) {
  bench::NodeBench<Can2053c> module;
  EXPECT_EQ(module.ask("605 A4 08 10 00 7F 00 00 00"), "585 C6 08 10 00 09 00 00 00");  // "CAN-2053" and 00h
  EXPECT_EQ(module.ask("605 A3 00 00 00 00 00 00 00"), "585 01 43 41 4E 2D 32 30 35 | 585 82 33 00 00 00 00 00 00");
  EXPECT_EQ(module.ask("605 A2 02 7F 00 00 00 00 00"), "585 D5 A6 4D 00 00 00 00 00");  // 5 unused bytes; CRC 4DA6h
  EXPECT_EQ(module.ask("605 A1 00 00 00 00 00 00 00"), "");
  EXPECT_EQ(module.ask("605 C6 17 10 00 02 00 00 00"), "585 A4 17 10 00 7F 00 00 00");  // 1017h = 500
  EXPECT_EQ(module.ask("605 81 F4 01 00 00 00 00 00"), "585 A2 01 7F 00 00 00 00 00");
  EXPECT_EQ(module.ask("605 D5 24 CF 00 00 00 00 00").substr(0, 27), "585 A1 00 00 00 00 00 00 00");
  EXPECT_EQ(module.ask("605 40 17 10 00 00 00 00 00"), "585 4B 17 10 00 F4 01 00 00");
  bench::NodeBench<Can2057c> other;
  EXPECT_EQ(other.ask("605 A4 08 10 00 7F 00 00 00"), "585 80 08 10 00 01 00 04 05");
}

TEST(ModuleNode, KeepsItsParametersBeyondPowerOffWhenTheyAreSaved) {
  bench::NodeBench<Can2057c> module;
  module.ask("605 2F 07 62 01 A5 00 00 00");
  EXPECT_EQ(module.ask("605 23 10 10 01 73 61 76 65"), "585 60 10 10 01 00 00 00 00");
  module.ask("605 2F 07 62 01 00 00 00 00");
  EXPECT_EQ(module.power_cycle(), "705 00");
  EXPECT_EQ(module.ask("605 40 07 62 01 00 00 00 00"), "585 4F 07 62 01 A5 00 00 00");
}

TEST(ModuleNode, ReadsItsInputsAgainAfterAReset) {
  bench::NodeBench<Can2053c> module;
  module.input("digital 1 0x55");
  module.ask(bench::reset_node);
  EXPECT_EQ(module.ask("605 40 00 60 01 00 00 00 00"), "585 4F 00 60 01 55 00 00 00");
  EXPECT_EQ(module.input("digital 3 0"), "?");
}

}  // namespace
