/// Manual 003, the runnable CAN-2000C modules as node 5: I/O channels, node-ID, stored settings, indicators, and the
/// contradictions of the manual.
#include <gtest/gtest.h>

#include <canopen/can/bus_status.hpp>

#include "can_2017c/can_2017c.hpp"
#include "can_2024c/can_2024c.hpp"
#include "can_2053c/can_2053c.hpp"
#include "can_2057c/can_2057c.hpp"
#include "manual_bench.hpp"
#include "node_bench.hpp"

namespace {

using manual::refused;
using manual::sdo;
using manual::taken;
using manual::write;
using namespace std::chrono_literals;

using AnalogInputs = bench::NodeBench<Can2017c>;
using AnalogOutputs = bench::NodeBench<Can2024c>;
using DigitalInputs = bench::NodeBench<Can2053c>;
using DigitalOutputs = bench::NodeBench<Can2057c>;

template <class Module>
struct EveryRunnableModule : testing::Test {
  Module module;
};
using RunnableModules = testing::Types<AnalogInputs, AnalogOutputs, DigitalInputs, DigitalOutputs>;
TYPED_TEST_SUITE(EveryRunnableModule, RunnableModules);

constexpr std::uint32_t not_mappable = 0x0604'0041;
constexpr std::uint32_t pdo_too_long = 0x0604'0042;
constexpr std::uint32_t no_object = 0x0602'0000;
constexpr std::uint32_t no_sub_index = 0x0609'0011;
constexpr std::uint32_t invalid_value = 0x0609'0030;
constexpr auto save = "605 23 10 10 01 73 61 76 65";
constexpr auto load = "605 23 11 10 01 6C 6F 61 64";

template <class Module>
std::string read(Module& module, std::uint16_t index, std::uint8_t sub_index) {
  return module.ask(sdo("605", 0x40, index, sub_index, 0));
}
std::string value_of(std::uint16_t index, std::uint8_t sub_index, unsigned bytes, std::uint32_t value) {
  return sdo("585", 0x43 | manual::unused(bytes), index, sub_index, value);
}

// What the module is

// shows 003.101, 003.102, 003.103, 003.122, 003.126, 003.143
TYPED_TEST(EveryRunnableModule, IsASlaveAServerAndAProducerOnly) {
  struct Row {
    std::uint16_t index;
    std::uint8_t sub_index;
    std::uint32_t code;
  };
  constexpr Row missing[] = {
      {0x1012, 0, no_object},     // consumes no time stamp
      {0x1016, 0, no_object},     // consumes no heartbeats
      {0x1028, 0, no_object},     // consumes no EMCY
      {0x1201, 0, no_object},     // no second SDO server
      {0x1280, 0, no_object},     // no SDO client
      {0x1F80, 0, no_object},     // no NMT master
      {0x1400, 5, no_sub_index},  // no event timer of an RPDO
  };
  for (const auto& [index, sub_index, code] : missing) {
    EXPECT_EQ(read(this->module, index, sub_index), refused(index, sub_index, code));
  }
  EXPECT_EQ(this->module.pass(1h), "");
}

struct Channels {
  std::uint16_t index;
  std::uint8_t count;
  unsigned bytes;
};
constexpr Channels digital_inputs{0x6000, 2, 1};
constexpr Channels digital_outputs{0x6200, 2, 1};
constexpr Channels analog_inputs{0x6401, 8, 2};
constexpr Channels analog_outputs{0x6411, 4, 2};

/// The module has these channels and none of the others.
template <class Module>
void expect_channels(const Channels& own) {
  Module module;
  for (const Channels& kind : {digital_inputs, digital_outputs, analog_inputs, analog_outputs}) {
    if (kind.index != own.index) {
      EXPECT_EQ(read(module, kind.index, 0), refused(kind.index, 0, no_object));
      continue;
    }
    EXPECT_EQ(read(module, kind.index, 0), value_of(kind.index, 0, 1, kind.count));
    for (std::uint8_t channel = 1; channel <= kind.count; ++channel) {
      EXPECT_EQ(read(module, kind.index, channel), value_of(kind.index, channel, kind.bytes, 0));
    }
    const auto beyond = static_cast<std::uint8_t>(kind.count + 1);
    EXPECT_EQ(read(module, kind.index, beyond), refused(kind.index, beyond, no_sub_index));
  }
}

// shows 003.113, 003.133, 003.155
TEST(Manual003Modules, HaveTheChannelsOfTheTable) {
  expect_channels<DigitalOutputs>(digital_outputs);
  expect_channels<AnalogOutputs>(analog_outputs);
  expect_channels<DigitalInputs>(digital_inputs);
  expect_channels<AnalogInputs>(analog_inputs);
}

// shows 003.98, 003.114, 003.150
TYPED_TEST(EveryRunnableModule, HasObjectsOfTheCommunicationAndTheDeviceProfileOnly) {
  unsigned device_profile = 0;
  this->module.app->node().entries().dictionary().for_each_entry(
      [&](std::uint16_t index, std::uint8_t, canopen::entry::Word) {
        EXPECT_TRUE((index >= 0x1000 && index < 0x2000) || (index >= 0x6000 && index < 0xA000)) << index;
        if (index >= 0x6000) ++device_profile;
      });
  EXPECT_NE(device_profile, 0u);
}

// shows 003.111
TEST(Manual003Modules, UseTheFunctionCodesOfTheTable) {
  for (const unsigned node_id : {1u, 32u, 99u}) {
    SCOPED_TRACE(node_id);
    const auto can_id = [node_id](unsigned function_code) {
      char text[16];
      std::snprintf(text, sizeof text, "%03X", function_code << 7 | node_id);
      return std::string{text};
    };
    DigitalInputs module{canopen::NodeId{static_cast<std::uint8_t>(node_id)}};
    EXPECT_EQ(module.boot_up, can_id(14) + " 00");
    EXPECT_EQ(module.input("fault eeprom"), can_id(1) + " 00 50 81 02 00 00 00 00");
    const auto ask = [&](std::uint16_t index) { return module.ask(sdo(can_id(12), 0x40, index, 1, 0)); };
    const auto expect_cob_id = [&](std::uint16_t index, unsigned function_code) {
      EXPECT_EQ(ask(index), sdo(can_id(11), 0x43, index, 1, function_code << 7 | node_id));
    };
    constexpr unsigned tpdos[] = {3, 5, 7, 9};
    constexpr unsigned rpdos[] = {4, 6, 8, 10};
    for (std::uint16_t i = 0; i < 4; ++i) {
      expect_cob_id(static_cast<std::uint16_t>(0x1800 + i), tpdos[i]);
      expect_cob_id(static_cast<std::uint16_t>(0x1400 + i), rpdos[i]);
    }
    module.ask("000 01 00");
    EXPECT_EQ(module.ask(can_id(3) + " R 0"), can_id(3) + " 00 00");
  }
}

// shows 003.3, 003.109, 003.140
TYPED_TEST(EveryRunnableModule, TakesTheNodeIdOfItsSwitchesAtPowerOn) {
  EXPECT_EQ(this->module.input("switches 3 2"), "");
  EXPECT_NE(this->module.ask(bench::reset_node).find("705 00"), std::string::npos);
  EXPECT_EQ(this->module.power_cycle(), "720 00");
  for (const char* const wrong : {"switches 0 0", "switches 1 10", "switches 10 1", "switches 1", "switches a 1"}) {
    EXPECT_EQ(this->module.input(wrong), "?") << wrong;
  }
  EXPECT_EQ(this->module.input("switches 9 9"), "");
  EXPECT_EQ(this->module.power_cycle(), "763 00");
}

// shows 003.132
TEST(Manual003Modules, AreTheNodes1To4OfTheExample) {
  EXPECT_EQ(bench::NodeBench<Can2057c>{std::nullopt}.boot_up, "701 00");
  EXPECT_EQ(bench::NodeBench<Can2053c>{std::nullopt}.boot_up, "702 00");
  EXPECT_EQ(bench::NodeBench<Can2024c>{std::nullopt}.boot_up, "703 00");
  EXPECT_EQ(bench::NodeBench<Can2017c>{std::nullopt}.boot_up, "704 00");
}

// Stored settings

// shows 003.94, 003.105
TEST(Manual003Modules, StoreAndRestoreTheirIoSettings) {
  struct Row {
    std::uint16_t index;
    std::uint8_t sub_index;
    unsigned bytes;
    std::uint32_t by_default;
    std::uint32_t own;
  };
  const auto expect_stored = [](auto& module, std::initializer_list<Row> rows) {
    for (const Row& row : rows) write(module, row.index, row.sub_index, row.bytes, row.own);
    EXPECT_EQ(module.ask(save), taken(0x1010, 1));
    for (const Row& row : rows) write(module, row.index, row.sub_index, row.bytes, row.by_default);
    module.power_cycle();
    for (const Row& row : rows)
      EXPECT_EQ(read(module, row.index, row.sub_index), value_of(row.index, row.sub_index, row.bytes, row.own));
    EXPECT_EQ(module.ask(load), taken(0x1011, 1));
    module.power_cycle();
    for (const Row& row : rows)
      EXPECT_EQ(read(module, row.index, row.sub_index), value_of(row.index, row.sub_index, row.bytes, row.by_default));
  };
  DigitalOutputs digital;
  expect_stored(digital, {{0x6206, 1, 1, 0xFF, 0x0F}, {0x6207, 2, 1, 0, 0xA5}, {0x1400, 2, 1, 0xFF, 1}});
  AnalogOutputs analog;
  expect_stored(analog, {{0x6443, 2, 1, 1, 0}, {0x6444, 4, 4, 0, 0x3FFF}, {0x1401, 2, 1, 0xFF, 1}});
  DigitalInputs inputs;
  expect_stored(inputs, {{0x1800, 5, 2, 0, 1000}, {0x1017, 0, 2, 0, 250}});
}

// shows 003.72
TYPED_TEST(EveryRunnableModule, ReportsThatItsMemoryCannotBeWritten) {
  TypeParam failing{canopen::NodeId{5}, "no such folder/module.parameters"};
  EXPECT_EQ(failing.ask(save), refused(0x1010, 1, 0x0606'0000));
  EXPECT_EQ(failing.pass(0s), "085 00 50 81 02 00 00 00 00");
  EXPECT_EQ(read(failing, 0x1003, 1), value_of(0x1003, 1, 4, 0x0002'5000));
}

// Digital and analog channels

// shows 003.59, 003.134, 003.159
TEST(Manual003Modules, SendABitOf1ForAnInputThatIsOn) {
  DigitalInputs module;
  module.ask(bench::start);
  EXPECT_EQ(module.input("digital 1 0x34"), "185 34 00");  // DI2, DI4 and DI5
  EXPECT_EQ(module.input("digital 2 0x12"), "185 34 12");  // DI9 and DI12
  EXPECT_EQ(read(module, 0x6000, 2), value_of(0x6000, 2, 1, 0x12));
  DigitalOutputs outputs;
  outputs.ask(bench::start);
  outputs.ask("205 34 12 00 00 00 00 00 00");
  EXPECT_TRUE(outputs.logged("digital 1 0x34"));
  EXPECT_TRUE(outputs.logged("digital 2 0x12"));
}

// shows 003.135
TEST(Manual003Modules, DriveTheirOutputsWhenAValueChanges) {
  DigitalOutputs module;
  module.ask(bench::start);
  module.ask("205 12 00");
  EXPECT_TRUE(module.logged("digital 1 0x12"));
  module.ask("205 12 00");
  EXPECT_FALSE(module.logged("digital 1 0x12"));
}

// shows 003.164
TEST(Manual003Modules, ScaleByTheFormula) {
  AnalogOutputs module;
  write(module, 0x6411, 1, 2, 0x4000);
  EXPECT_TRUE(module.logged("analogue 1 5.000 V"));  // 5.00023 V
  write(module, 0x6411, 1, 2, 0xFFFF);
  EXPECT_TRUE(module.logged("analogue 1 -0.000 V"));
}

// PDOs

// shows 003.117
TEST(Manual003Modules, MapUpToEightBytes) {
  AnalogInputs module;
  for (std::uint8_t entry = 1; entry <= 5; ++entry) {
    EXPECT_EQ(write(module, 0x1A05, entry, 4, 0x6401'0010u | unsigned{entry} << 8), taken(0x1A05, entry));
  }
  EXPECT_EQ(write(module, 0x1A05, 0, 1, 5), refused(0x1A05, 0, pdo_too_long));
  EXPECT_EQ(write(module, 0x1A05, 0, 1, 4), taken(0x1A05, 0));
  EXPECT_EQ(write(module, 0x1805, 1, 4, 0x333), taken(0x1805, 1));
  EXPECT_EQ(module.ask(bench::start),
            "285 00 00 00 00 00 00 00 00 | 385 00 00 00 00 00 00 00 00 | 333 00 00 00 00 00 00 00 00");
}

// shows 003.131, 003.154, 003.180
TYPED_TEST(EveryRunnableModule, HasTenPdosWithTheirMappings) {
  for (std::uint16_t i = 0; i < 10; ++i) {
    for (const unsigned area : {0x1600u, 0x1A00u}) {
      const auto mapping = static_cast<std::uint16_t>(area + i);
      const auto communication = static_cast<std::uint16_t>(mapping - 0x200);
      EXPECT_NE(read(this->module, communication, 1), refused(communication, 1, no_object));
      EXPECT_NE(read(this->module, mapping, 0), refused(mapping, 0, no_object));
      EXPECT_NE(read(this->module, mapping, 8), refused(mapping, 8, no_sub_index));
      EXPECT_EQ(read(this->module, mapping, 9), refused(mapping, 9, no_sub_index));
    }
  }
  for (const unsigned beyond : {0x140Au, 0x160Au, 0x180Au, 0x1A0Au, 0x140Fu, 0x160Fu, 0x180Fu, 0x1A0Fu}) {
    const auto index = static_cast<std::uint16_t>(beyond);
    EXPECT_EQ(read(this->module, index, 0), refused(index, 0, no_object));
  }
}

// shows 003.119, 003.121, 003.146, 003.147, 003.104
TEST(Manual003Modules, SendsSynchronousPdosAtSyncOnly) {
  for (const std::uint32_t type : {0u, 1u, 252u}) {
    DigitalInputs module;
    write(module, 0x1800, 2, 1, type);
    module.ask(bench::start);
    module.ask("080");
    EXPECT_EQ(module.input("digital 1 1"), "") << type;
    EXPECT_EQ(module.pass(1s), "") << type;
    EXPECT_EQ(module.ask("080"), type == 252 ? "" : "185 01 00") << type;
    EXPECT_EQ(module.ask("080"), type == 1 ? "185 01 00" : "") << type;
  }
  for (const std::uint32_t type : {254u, 255u}) {
    DigitalInputs module;
    write(module, 0x1800, 2, 1, type);
    module.ask(bench::start);
    EXPECT_EQ(module.ask("080"), "") << type;
    EXPECT_EQ(module.input("digital 1 1"), "185 01 00") << type;
  }
}

// shows 003.118, 003.120, 003.104
TEST(Manual003Modules, AnswerARemoteRequestInTheAsynchronousAndTheRtrOnlyTypes) {
  for (const std::uint32_t type : {252u, 253u, 254u, 255u}) {
    DigitalInputs module;
    write(module, 0x1800, 2, 1, type);
    module.ask(bench::start);
    EXPECT_EQ(module.ask("185 R 0"), "185 00 00") << type;
  }
}

// Steps 38 to 43 of the dynamic mapping with the bytes of the tables and with those of the text.
// shows 003.124, 003.153, 003.167, 003.168, 003.169
TEST(Manual003Modules, AcceptTheMappingOfTheTextAndRejectThatOfTheTables) {
  AnalogInputs inputs;
  inputs.ask(bench::start);
  EXPECT_EQ(inputs.ask("605 23 05 18 01 33 03 00 00"), taken(0x1805, 1));                   // bit 31 was 1
  EXPECT_EQ(inputs.ask("605 23 05 18 01 34 03 00 00"), refused(0x1805, 1, invalid_value));  // now it is 0
  EXPECT_EQ(inputs.ask("605 23 05 1A 01 10 03 01 64"), taken(0x1A05, 1));
  EXPECT_EQ(inputs.ask("605 23 05 1A 02 16 06 01 64"), refused(0x1A05, 2, not_mappable));
  EXPECT_EQ(inputs.ask("605 23 05 1A 02 10 06 01 64"), taken(0x1A05, 2));
  EXPECT_EQ(inputs.ask("605 2F 05 1A 00 02 00 00 00").substr(0, 27), taken(0x1A05, 0));
  inputs.input("analogue 6 5.001");
  EXPECT_EQ(inputs.ask("333 R 0"), "333 00 00 02 40");

  AnalogOutputs outputs;
  outputs.ask(bench::start);
  EXPECT_EQ(outputs.ask("605 23 05 14 01 22 02 00 00"), taken(0x1405, 1));
  EXPECT_EQ(outputs.ask("605 23 05 16 01 16 03 11 64"), refused(0x1605, 1, not_mappable));
  EXPECT_EQ(outputs.ask("605 23 05 16 01 10 03 11 64"), taken(0x1605, 1));
  EXPECT_EQ(outputs.ask("605 23 05 16 02 16 06 11 64"), refused(0x1605, 2, not_mappable));
  EXPECT_EQ(outputs.ask("605 23 05 16 02 10 06 11 64"), refused(0x1605, 2, not_mappable));  // AO5 does not exist
  EXPECT_EQ(outputs.ask("605 23 05 16 02 10 04 11 64"), taken(0x1605, 2));                  // AO3 instead
  EXPECT_EQ(outputs.ask("605 2F 05 16 00 02 00 00 00"), taken(0x1605, 0));
  outputs.ask("222 00 00 FF 3F");
  EXPECT_TRUE(outputs.logged("analogue 4 5.000 V"));
}

// SDO

// shows 003.129, 003.151
TEST(Manual003Modules, TakeASegmentedDownload) {
  AnalogOutputs module;
  EXPECT_EQ(module.ask("605 21 44 64 01 04 00 00 00"), taken(0x6444, 1));
  EXPECT_EQ(module.ask("605 07 FF 3F 00 00 00 00 00"), "585 20 00 00 00 00 00 00 00");
  EXPECT_EQ(read(module, 0x6444, 1), value_of(0x6444, 1, 4, 0x3FFF));
  EXPECT_EQ(module.ask("605 23 44 64 01 FE 3F 00 00"), taken(0x6444, 1));  // four bytes expedited
  EXPECT_EQ(read(module, 0x6444, 1), value_of(0x6444, 1, 4, 0x3FFE));
  EXPECT_EQ(module.ask("605 21 44 64 01 04 00 00 00"), taken(0x6444, 1));
  EXPECT_EQ(module.ask("605 17 FF 3F 00 00 00 00 00"), refused(0x6444, 1, 0x0503'0000));  // the toggle bit begins at 0
}

// shows 003.115, 003.128, 003.130
TEST(Manual003Modules, AnswerRequestsWithUnusedBytesOf0) {
  DigitalOutputs module;
  EXPECT_EQ(module.pass(10s), "");
  EXPECT_EQ(module.ask("605 40 00 14 00 11 22 33 44"), "585 4F 00 14 00 02 00 00 00");
  EXPECT_EQ(module.ask("605 2F 00 14 02 05 AA BB CC"), "585 60 00 14 02 00 00 00 00");
  EXPECT_EQ(module.ask("605 40 08 10 01 00 00 00 00"), "585 80 08 10 01 11 00 09 06");
}

// shows 003.116, 003.144
TEST(Manual003Modules, ServeBlocksInTheCan2053cOnly) {
  DigitalInputs with_blocks;
  EXPECT_EQ(with_blocks.ask("605 A4 08 10 00 7F 00 00 00"), "585 C6 08 10 00 09 00 00 00");
  DigitalOutputs digital;
  AnalogInputs inputs;
  AnalogOutputs outputs;
  constexpr auto rejected = "585 80 08 10 00 01 00 04 05";
  EXPECT_EQ(digital.ask("605 A4 08 10 00 7F 00 00 00"), rejected);
  EXPECT_EQ(inputs.ask("605 A4 08 10 00 7F 00 00 00"), rejected);
  EXPECT_EQ(outputs.ask("605 A4 08 10 00 7F 00 00 00"), rejected);
}

// shows 003.182
TYPED_TEST(EveryRunnableModule, HasNoDataInAnEmptyErrorField) {
  EXPECT_EQ(read(this->module, 0x1003, 1), refused(0x1003, 1, 0x0800'0024));
  this->module.input("fault eeprom");
  EXPECT_EQ(read(this->module, 0x1003, 1), value_of(0x1003, 1, 4, 0x0002'5000));
  EXPECT_EQ(read(this->module, 0x1003, 2), refused(0x1003, 2, 0x0800'0024));
}

// Indicators and outputs in errors

// shows 003.17
TEST(Manual003Modules, ShowTheMostSevereError) {
  DigitalOutputs module;
  write(module, 0x100C, 0, 2, 100);
  write(module, 0x100D, 0, 1, 1);
  module.ask("705 R 1");
  module.pass(100ms);
  EXPECT_TRUE(module.logged("ERR double flash"));
  module.app->on_bus_status({canopen::BusState::passive}, module.now);
  EXPECT_EQ(module.app->panel().error(), canopen::IndicatorPattern::double_flash);
  module.app->on_bus_status({canopen::BusState::off}, module.now);
  EXPECT_TRUE(module.logged("ERR on"));
  module.app->on_bus_status({}, module.now);
  EXPECT_TRUE(module.logged("ERR double flash"));
  module.ask("705 R 1");
  EXPECT_TRUE(module.logged("ERR off"));
}

// shows 003.87, 003.88
TEST(Manual003Modules, SetTheErrorValueOfEachAnalogOutputWhoseModeIs1) {
  AnalogOutputs module;
  constexpr std::uint32_t values[] = {0x1000, 0x2000, 0x3000, 0x4000};
  for (std::uint8_t channel = 1; channel <= 4; ++channel) {
    write(module, 0x6444, channel, 4, values[channel - 1]);
  }
  write(module, 0x6443, 3, 1, 0);
  write(module, 0x100C, 0, 2, 100);
  write(module, 0x100D, 0, 1, 1);
  module.ask("705 R 1");
  EXPECT_EQ(module.pass(100ms), "085 30 81 11 07 00 00 00 00");
  for (std::uint8_t channel = 1; channel <= 4; ++channel) {
    EXPECT_EQ(read(module, 0x6411, channel), value_of(0x6411, channel, 2, channel == 3 ? 0 : values[channel - 1]));
  }
}

// shows 003.148, 003.149
TEST(Manual003Modules, SetTheirErrorValuesAfterTheNodeLifeTimeOnly) {
  DigitalOutputs module;
  write(module, 0x6207, 1, 1, 0xA5);
  write(module, 0x100C, 0, 2, 100);
  write(module, 0x100D, 0, 1, 3);
  module.ask("705 R 1");
  module.ask(bench::start);  // the guard may expect another state
  module.ask("705 R 1");
  module.pass(299ms);
  EXPECT_FALSE(module.logged("digital 1 0xA5"));
  module.pass(1ms);
  EXPECT_TRUE(module.logged("digital 1 0xA5"));
}

}  // namespace
