/// The order in which the values of a DCF are written to a node.
#include "configure/configuration_plan.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "configure/configuration_values.hpp"
#include "configure/configure_node.hpp"
#include "format/dcf/concise_dcf.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

struct Wanted {
  std::uint16_t index;
  std::uint8_t sub_index;
  std::vector<std::uint8_t> bytes;
};

/// The steps as `off 1800h:01`, `clear 1A00h:00`, `1A00h:01 = 10 00`, `on 1800h:01`.
std::vector<std::string> plan(const std::vector<Wanted>& wanted, const Device* device = nullptr) {
  std::vector<ConfigurationValue> values;
  for (const Wanted& value : wanted) {
    ConfigurationValue row;
    row.entry.index = value.index;
    row.entry.sub_index = value.sub_index;
    row.entry.entry = device == nullptr ? nullptr : device->find(value.index, value.sub_index);
    row.bytes = value.bytes;
    values.push_back(std::move(row));
  }
  std::vector<std::string> steps;
  for (const ConfigurationStep& step : plan_configuration(values, device)) {
    const std::string entry = entry_label(step.entry.index, step.entry.sub_index);
    const std::string value = step.bytes.empty() ? "" : " = " + hex_bytes(step.bytes);
    switch (step.kind) {
      case StepKind::write: steps.push_back(entry + value); break;
      case StepKind::switch_off: steps.push_back("off " + entry); break;
      case StepKind::switch_on: steps.push_back("on " + entry + value); break;
      case StepKind::clear: steps.push_back("clear " + entry); break;
      case StepKind::restore: steps.push_back("restore " + entry + value); break;
    }
  }
  return steps;
}

using Steps = std::vector<std::string>;

TEST(ConfigurationPlan, WritesCommunicationBeforeApplicationAndPdosLast) {
  EXPECT_EQ(
      plan({{0x2000, 0, {1}}, {0x1400, 2, {0xFE}}, {0x6000, 1, {2}}, {0x1017, 0, {3, 0}}}),
      (Steps{"1017h:00 = 03 00", "2000h:00 = 01", "6000h:01 = 02", "off 1400h:01", "1400h:02 = FE", "on 1400h:01"}));
}

TEST(ConfigurationPlan, ChangesAMappingWhileItsPdoIsOffAndItsNumberIsZero) {
  EXPECT_EQ(plan({{0x1800, 1, {0x81, 1, 0, 0}},
                  {0x1800, 5, {100, 0}},
                  {0x1A00, 0, {1}},
                  {0x1A00, 1, {0x20, 0, 0x64, 0x60}},
                  {0x1A00, 2, {0, 0, 0, 0}}}),
            (Steps{"off 1800h:01", "clear 1A00h:00", "1A00h:01 = 20 00 64 60", "1A00h:00 = 01", "1800h:05 = 64 00",
                   "on 1800h:01 = 81 01 00 00"}));
}

/// A DCF of values that differ from the defaults may contain one entry of a mapping; the other entries stay mapped.
TEST(ConfigurationPlan, RestoresTheNumberOfMappedObjectsThatTheDcfDoesNotHave) {
  EXPECT_EQ(plan({{0x1600, 1, {8, 0, 0, 0x20}}, {0x1600, 2, {8, 0, 1, 0x20}}}),
            (Steps{"off 1400h:01", "clear 1600h:00", "1600h:01 = 08 00 00 20", "1600h:02 = 08 00 01 20",
                   "restore 1600h:00 = 02", "on 1400h:01"}));
}

TEST(ConfigurationPlan, LeavesACobIdAloneThatCannotBeWritten) {
  const DeviceFromText device{"[1400]\nParameterName=a\nObjectType=9\nSubNumber=3\n" + var("1400sub0", "a", "5", "ro") +
                              var("1400sub1", "b", "7", "ro") + var("1400sub2", "c", "5", "rw")};
  EXPECT_EQ(plan({{0x1400, 2, {1}}}, &device.device), (Steps{"1400h:02 = 01"}));
}

TEST(ConfigurationPlan, SwitchesCobIdsOffBeforeTheyChange) {
  EXPECT_EQ(
      plan(
          {{0x1014, 0, {0x85, 0, 0, 0}}, {0x1201, 1, {0x40, 6, 0, 0}}, {0x1201, 2, {0xC0, 5, 0, 0}}, {0x1201, 3, {9}}}),
      (Steps{"off 1014h:00", "on 1014h:00 = 85 00 00 00", "off 1201h:01", "off 1201h:02", "1201h:03 = 09",
             "on 1201h:01 = 40 06 00 00", "on 1201h:02 = C0 05 00 00"}));
}

TEST(ConfigurationPlan, StartsASyncProducerBehindItsPeriodAndOverflow) {
  EXPECT_EQ(plan({{0x1005, 0, {0x80, 0, 0, 0x40}}, {0x1006, 0, {0x10, 0x27, 0, 0}}, {0x1019, 0, {16}}}),
            (Steps{"clear 1006h:00", "1019h:00 = 10", "1006h:00 = 10 27 00 00", "off 1005h:00",
                   "on 1005h:00 = 80 00 00 40"}));
}

TEST(ConfigurationPlan, RestoresTheSyncPeriodThatTheDcfDoesNotHave) {
  const DeviceFromText device{var("1006", "a", "7", "rw") + var("1019", "b", "5", "rw")};
  EXPECT_EQ(plan({{0x1019, 0, {16}}}, &device.device), (Steps{"clear 1006h:00", "1019h:00 = 10", "restore 1006h:00"}));
  EXPECT_EQ(plan({{0x1019, 0, {16}}}), (Steps{"1019h:00 = 10"}));
}

TEST(ConfigurationPlan, WritesNodeIdAndBitRateAtLast) {
  const DeviceFromText device{var("2000", "Node-ID", "5", "rw") + var("2001", "CAN bit rate", "5", "rw") +
                              var("2002", "Gain", "5", "rw")};
  std::vector<ConfigurationValue> values;
  for (const Object& object : device.device.objects) {
    if (object.index >= 0x2000) values.push_back({live_entry(device.device, object, object.entries.front()), {1}, {}});
  }
  const auto steps = plan_configuration(values, &device.device);
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_EQ(steps.front().entry.index, 0x2002);
}

/// Names of objects in vendors' files; CiA 301 does not define an object for either.
TEST(NodeIdAndBitRate, AreKnownByTheirName) {
  const auto sets = [](std::uint16_t index, std::string name) {
    const Entry entry;
    LiveEntry named;
    named.index = index;
    named.entry = &entry;
    named.name = std::move(name);
    return sets_node_id_or_bit_rate(named);
  };
  for (const char* name :
       {"Node-ID", "Node ID", "CANopen NodeID", "CAN Node-ID", "Device, ucSetBaudIndex_2510h2", "CAN bit rate",
        "CAN Bitrate", "BaudRate", "Baudrate Set", "ulSetNodeId_2510h1", "CAN bus baud rate", "Bus bit rate",
        "Fieldbus baudrate", "CANopen slave node-ID", "CAN speed"}) {
    EXPECT_TRUE(sets(0x2000, name)) << name;
  }
  for (const char* name :
       {"Inhibit time EMCY", "RS232 Baudrate", "MODBUS RTU Baudrate", "Gain", "Remote TPDO number and node-ID",
        "Node-ID of the SDO server", "Scan speed", "UsbBaudrate"}) {
    EXPECT_FALSE(sets(0x2000, name)) << name;
  }
  EXPECT_FALSE(sets(0x1016, "Consumer heartbeat time, Node-ID 1"));
  EXPECT_TRUE(sets(0x100B, "Reserved"));
}

/// The values that are written, given which ones differ.
std::vector<std::string> to_write(const std::vector<Wanted>& wanted, const std::vector<bool>& differs) {
  std::vector<ConfigurationValue> values;
  for (const Wanted& value : wanted) {
    LiveEntry entry;
    entry.index = value.index;
    entry.sub_index = value.sub_index;
    values.push_back({entry, value.bytes, {}});
  }
  std::vector<std::string> names;
  for (const ConfigurationValue& value : values_to_write(values, differs)) {
    names.push_back(entry_label(value.entry.index, value.entry.sub_index));
  }
  return names;
}

TEST(ValuesToWrite, AreThoseThatDiffer) {
  EXPECT_EQ(to_write({{0x1017, 0, {1, 0}}, {0x1800, 1, {0x81, 1, 0, 0}}, {0x1800, 5, {1, 0}}}, {false, false, true}),
            (Steps{"1800h:05"}));
}

TEST(ValuesToWrite, AreAMappingAsAWhole) {
  EXPECT_EQ(to_write({{0x1800, 1, {0x81, 1, 0, 0}},
                      {0x1A00, 0, {2}},
                      {0x1A00, 1, {0x10, 0, 0x41, 0x60}},
                      {0x1A00, 2, {0x20, 0, 0x64, 0x60}},
                      {0x1A01, 0, {1}}},
                     {false, false, false, true, false}),
            (Steps{"1A00h:00", "1A00h:01", "1A00h:02"}));
}

TEST(ValuesToWrite, AreTheSyncPeriodWithTheOverflow) {
  EXPECT_EQ(to_write({{0x1006, 0, {1, 0, 0, 0}}, {0x1019, 0, {2}}}, {false, true}), (Steps{"1006h:00", "1019h:00"}));
}

TEST(ConfigurationPlan, LeavesOutWhatCommands) {
  EXPECT_EQ(plan({{0x1003, 0, {0}},
                  {0x1010, 1, {1, 0, 0, 0}},
                  {0x1011, 1, {1, 0, 0, 0}},
                  {0x1020, 1, {0, 0, 0, 0}},
                  {0x1F51, 1, {0}}}),
            Steps{});
}

TEST(ConfigurationPlan, LeavesOutWhatToolsShallNotWrite) {
  const DeviceFromText device{var("2000", "a", "7", "rw", "ObjFlags=1\n")};
  EXPECT_EQ(plan({{0x2000, 0, {1, 0, 0, 0}}}, &device.device), Steps{});
}

TEST(ConfigurationTime, CountsDaysFrom1984AndMillisecondsFromMidnight) {
  EXPECT_EQ(parse_configuration_time("01-01-1984", "12:00AM"), (ConfigurationTime{0, 0}));
  EXPECT_EQ(parse_configuration_time("01-02-1984", "12:01PM"), (ConfigurationTime{1, 43'260'000}));
  EXPECT_EQ(parse_configuration_time("02-01-2026", "02:30PM"), (ConfigurationTime{15'372, 52'200'000}));
}

TEST(ConfigurationTime, IsNothingWhereTheDcfWritesItOtherwise) {
  for (const auto& [date, time] : {std::pair{"13-01-2026", "02:30PM"},
                                   {"02-30-2026", "02:30PM"},
                                   {"02-01-26", "02:30PM"},
                                   {"02-01-2026", "14:30"},
                                   {"02-01-2026", "00:30AM"},
                                   {"02-01-1983", "02:30PM"},
                                   {"", ""}}) {
    EXPECT_FALSE(parse_configuration_time(date, time)) << date << ' ' << time;
  }
}

std::string bytes(std::initializer_list<int> numbers) { return {numbers.begin(), numbers.end()}; }

TEST(ReadConciseDcf, GivesTheEntriesOfTheStream) {
  const std::string stream = bytes({2, 0, 0, 0, 0x17, 0x10, 0, 2, 0, 0, 0, 0x64, 0, 0, 0x20, 3, 0, 0, 0, 0});
  const auto entries = read_concise_dcf(stream);
  ASSERT_TRUE(entries);
  ASSERT_EQ(entries->size(), 2U);
  EXPECT_EQ((*entries)[0].index, 0x1017);
  EXPECT_EQ((*entries)[0].data, bytes({0x64, 0}));
  EXPECT_EQ((*entries)[1].index, 0x2000);
  EXPECT_EQ((*entries)[1].sub_index, 3);
  EXPECT_EQ((*entries)[1].data, "");
}

TEST(ReadConciseDcf, TakesTheLastValueOfAnEntry) {
  const auto configuration = configuration_of(
      bytes({3, 0, 0, 0, 0, 0x1A, 0, 1, 0, 0, 0, 0, 1, 0x1A, 0, 1, 0, 0, 0, 7, 0, 0x1A, 0, 1, 0, 0, 0, 2}), nullptr);
  ASSERT_TRUE(configuration);
  ASSERT_EQ(configuration->values.size(), 2U);
  EXPECT_EQ(configuration->values[0].entry.index, 0x1A00);
  EXPECT_EQ(configuration->values[0].bytes, std::vector<std::uint8_t>{2});
}

TEST(ReadConciseDcf, RefusesAStreamOfAnotherLength) {
  const std::string stream = bytes({1, 0, 0, 0, 0x17, 0x10, 0, 2, 0, 0, 0, 0x64, 0});
  EXPECT_TRUE(read_concise_dcf(stream));
  for (std::size_t size = 0; size < stream.size(); ++size)
    EXPECT_FALSE(read_concise_dcf(stream.substr(0, size))) << size;
  EXPECT_FALSE(read_concise_dcf(stream + '\0'));
  EXPECT_FALSE(read_concise_dcf(bytes({-1, -1, -1, -1})));
}

}  // namespace
}  // namespace edsc
