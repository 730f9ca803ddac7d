/// The runnable position sensor: the statements of manual 004 about its application.
#include "rk5c/rk5c.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include "node_bench.hpp"

namespace {

using namespace std::chrono_literals;
using Sensor = bench::NodeBench<Rk5c>;

constexpr auto read_status = "605 40 02 10 00 00 00 00 00";
constexpr auto read_error_register = "605 40 01 10 00 00 00 00 00";
constexpr auto read_position = "605 40 20 60 01 00 00 00 00";
constexpr auto read_preset = "605 40 10 60 01 00 00 00 00";
constexpr auto preset_1000 = "605 23 10 60 01 E8 03 00 00";
constexpr auto preset_taken = "585 60 10 60 01 00 00 00 00";
constexpr auto save = "605 23 10 10 01 73 61 76 65";
constexpr auto saved = "585 60 10 10 01 00 00 00 00";
constexpr auto load = "605 23 11 10 01 6C 6F 61 64";
constexpr auto loaded = "585 60 11 10 01 00 00 00 00";

std::string status(unsigned bits) {
  return bench::text({.id = 0x585, .size = 8, .data = {0x42, 0x02, 0x10, 0, static_cast<std::uint8_t>(bits)}});
}
std::string error_register(unsigned bits) {
  return bench::text({.id = 0x585, .size = 8, .data = {0x42, 0x01, 0x10, 0, static_cast<std::uint8_t>(bits)}});
}
/// The answer to `read_position` in steps of 0.1 mm.
std::string position(std::int32_t steps) {
  const auto bits = static_cast<std::uint32_t>(steps);
  const auto byte = [bits](unsigned i) { return static_cast<std::uint8_t>(bits >> (8 * i)); };
  return bench::text({.id = 0x585, .size = 8, .data = {0x42, 0x20, 0x60, 1, byte(0), byte(1), byte(2), byte(3)}});
}

/// After its first measuring cycle.
struct RunningSensor : Sensor {
  RunningSensor() { pass(1ms); }
};

// shows 004.47, 004.48
TEST(Rk5cNode, RunsAfterItsFirstMeasuringCycle) {
  Sensor sensor;
  EXPECT_EQ(sensor.boot_up, "705 00");
  EXPECT_EQ(sensor.ask(read_status), status(0x02));
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_status), status(0x01));
  sensor.input("test on");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_status), status(0x02));
  sensor.input("test off");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_status), status(0x01));
}

TEST(Rk5cNode, TellsPositionAndSpeedInTpdo1) {
  RunningSensor sensor;
  sensor.input("position 1 12345");
  sensor.input("speed 1 -100000");
  sensor.pass(1ms);
  sensor.ask(bench::start);
  EXPECT_EQ(sensor.pass(1ms), "185 7B 00 00 00 9C FF");  // 12.3 mm, -100 mm/s
}

// shows 004.49
TEST(Rk5cNode, TellsThatTheMagnetIsMissing) {
  RunningSensor sensor;
  sensor.input("position 1 200000");
  sensor.pass(1ms);
  sensor.input("magnet off");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_status), status(0x04));
  sensor.input("magnet on");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_status), status(0x01));
  EXPECT_EQ(sensor.ask(read_position), position(2000));
}

// shows 004.49
TEST(Rk5cNode, TellsThatThereAreTwoMagnets) {
  RunningSensor sensor;
  sensor.input("magnet two");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_status), status(0x04));
  EXPECT_EQ(sensor.ask(preset_1000), "585 80 10 60 01 20 00 00 08");
  sensor.input("magnet on");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_status), status(0x01));
}

// shows 004.50, 004.122
TEST(Rk5cNode, TellsZeroesOutOfItsRange) {
  RunningSensor sensor;
  sensor.input("position 1 4000001");
  sensor.input("speed 1 5000");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_status), status(0x08));
  EXPECT_EQ(sensor.ask(read_position), position(0));
  EXPECT_EQ(sensor.ask("605 40 30 60 01 00 00 00 00"), "585 42 30 60 01 00 00 00 00");
  sensor.input("position 1 4000000");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_status), status(0x01));
  EXPECT_EQ(sensor.ask(read_position), position(40'000));
}

// shows 004.53
TEST(Rk5cNode, WarnsAbove105Degrees) {
  RunningSensor sensor;
  sensor.input("temperature 105");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_status), status(0x01));
  sensor.input("temperature 106");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_status), status(0x41));
}

// shows 004.46, 004.52
TEST(Rk5cNode, TellsAnErrorOfItsHardware) {
  RunningSensor sensor;
  EXPECT_EQ(sensor.input("hardware bad"), "085 00 50 81 00 00 00 00 00");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_status), status(0x20));
  EXPECT_EQ(sensor.ask(read_error_register), error_register(0x81));
  EXPECT_EQ(sensor.input("hardware good"), "085 00 00 00 00 00 00 00 00");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_status), status(0x01));
}

// shows 004.44, 004.45, 004.51
TEST(Rk5cNode, ChecksItsParametersAtEachResetAndAtLoad) {
  for (const char* const check : {bench::reset_node, bench::reset_communication, load}) {
    SCOPED_TRACE(check);
    RunningSensor sensor;
    sensor.input("flash damaged");
    EXPECT_EQ(sensor.pass(1s), "");  // not before it checks its memory
    EXPECT_NE(sensor.ask(check).find("085 00 63 01 00 00 00 00 00"), std::string::npos);
    sensor.pass(1ms);
    EXPECT_EQ(sensor.ask(read_status), status(0x11));
    EXPECT_EQ(sensor.ask(read_error_register), error_register(0x01));
    sensor.input("flash whole");
    EXPECT_EQ(sensor.ask(bench::reset_node), "705 00 | 085 00 63 01 00 00 00 00 00");  // the error remains
    EXPECT_EQ(sensor.power_cycle(), "705 00");
    EXPECT_EQ(sensor.ask(read_error_register), error_register(0x00));
  }
}

TEST(Rk5cNode, TellsADataSetErrorWhenTheFileOfItsParametersIsDamaged) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "edsc_rk5c_test.parameters";
  std::ofstream{file} << "EDSP, but not what the checksum is of";
  Sensor sensor{canopen::NodeId{5}, file.string()};
  std::filesystem::remove(file);
  EXPECT_EQ(sensor.boot_up, "705 00 | 085 00 63 01 00 00 00 00 00");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_status), status(0x11));
  EXPECT_TRUE(sensor.logged("ERR blinking"));
}

// shows 004.96
TEST(Rk5cNode, TakesAPresetWithTheNextMeasuringCycle) {
  RunningSensor sensor;
  sensor.input("position 1 200000");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(preset_1000), preset_taken);
  EXPECT_EQ(sensor.ask(read_position), position(2000));
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_position), position(1000));
  sensor.input("position 1 200100");
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_position), position(1001));
}

// shows 004.96
TEST(Rk5cNode, RefusesAPresetWithoutAValidPosition) {
  RunningSensor sensor;
  for (const char* const state : {"magnet off", "test on", "hardware bad", "position 1 -1"}) {
    sensor.input(state);
    sensor.pass(1ms);
    EXPECT_EQ(sensor.ask(preset_1000), "585 80 10 60 01 20 00 00 08") << state;
    sensor.input("magnet on");
    sensor.input("test off");
    sensor.input("hardware good");
    sensor.input("position 1 0");
    sensor.pass(1ms);
  }
}

// shows 004.98
TEST(Rk5cNode, ReadsBackThePresetUntilTheNextReset) {
  RunningSensor sensor;
  sensor.ask(preset_1000);
  EXPECT_EQ(sensor.ask(read_preset), "585 42 10 60 01 E8 03 00 00");
  sensor.ask(save);
  sensor.ask(bench::reset_node);
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_preset), "585 42 10 60 01 00 00 00 00");
  EXPECT_EQ(sensor.ask(read_position), position(1000));
}

// shows 004.97
TEST(Rk5cNode, KeepsTheOffsetBeyondPowerOffWhenItIsSaved) {
  RunningSensor sensor;
  sensor.ask(preset_1000);
  sensor.power_cycle();
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_position), position(0));
  sensor.ask(preset_1000);
  EXPECT_EQ(sensor.ask(save), saved);
  sensor.power_cycle();
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_position), position(1000));
  EXPECT_EQ(sensor.ask(read_preset), "585 42 10 60 01 00 00 00 00");
}

// shows 004.72, 004.166
TEST(Rk5cNode, LosesTheOffsetWithThePowerCycleAfterLoad) {
  RunningSensor sensor;
  sensor.ask(preset_1000);
  sensor.ask(save);
  EXPECT_EQ(sensor.ask(load), loaded);
  sensor.ask(bench::reset_node);
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_position), position(1000));
  sensor.power_cycle();
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask(read_position), position(0));
}

// shows 004.90
TEST(Rk5cNode, HasOneCyclicTimerInTwoPlaces) {
  RunningSensor sensor;
  EXPECT_EQ(sensor.ask("605 2B 00 62 00 14 00 00 00"), "585 60 00 62 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 40 00 18 05 00 00 00 00"), "585 42 00 18 05 14 00 00 00");
  sensor.ask(bench::start);
  EXPECT_EQ(sensor.pass(19ms), "");
  EXPECT_EQ(sensor.pass(1ms), "185 00 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 2B 00 18 05 02 00 00 00"), "585 60 00 18 05 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 40 00 62 00 00 00 00 00"), "585 42 00 62 00 02 00 00 00");
  EXPECT_EQ(sensor.pass(2ms), "185 00 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 2B 00 62 00 00 00 00 00"), "585 60 00 62 00 00 00 00 00");
  EXPECT_EQ(sensor.pass(1s), "");
}

// shows 004.158, 004.170
TEST(Rk5cNode, HasOneCyclicTimerAfterEachReset) {
  for (const char* const reset : {bench::reset_node, bench::reset_communication}) {
    SCOPED_TRACE(reset);
    RunningSensor sensor;
    sensor.ask("605 2B 00 62 00 FF FF 00 00");
    EXPECT_EQ(sensor.ask("605 40 00 18 05 00 00 00 00"), "585 42 00 18 05 FF FF 00 00");
    sensor.ask(bench::start);
    EXPECT_EQ(sensor.pass(65'534ms), "");
    EXPECT_EQ(sensor.pass(1ms), "185 00 00 00 00 00 00");
    EXPECT_EQ(sensor.ask(reset), "705 00");
    EXPECT_EQ(sensor.ask("605 40 00 18 05 00 00 00 00"), "585 42 00 18 05 01 00 00 00");
    EXPECT_EQ(sensor.ask("605 40 00 62 00 00 00 00 00"), "585 42 00 62 00 01 00 00 00");
    sensor.ask("605 2B 00 62 00 05 00 00 00");
    EXPECT_EQ(sensor.ask(save), saved);
    sensor.ask("605 2B 00 62 00 07 00 00 00");
    EXPECT_EQ(sensor.ask(reset), "705 00");
    EXPECT_EQ(sensor.ask("605 40 00 18 05 00 00 00 00"), "585 42 00 18 05 05 00 00 00");
    EXPECT_EQ(sensor.ask("605 40 00 62 00 00 00 00 00"), "585 42 00 62 00 05 00 00 00");
  }
}

// shows 004.164
TEST(Rk5cNode, ResetsTheApplicationWithResetNodeOnly) {
  RunningSensor sensor;
  sensor.ask(preset_1000);
  sensor.ask("605 2B 17 10 00 E8 03 00 00");
  sensor.ask(bench::reset_communication);
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask("605 40 17 10 00 00 00 00 00"), "585 42 17 10 00 00 00 00 00");
  EXPECT_EQ(sensor.ask(read_position), position(1000));
  sensor.ask("605 2B 17 10 00 E8 03 00 00");
  sensor.ask(bench::reset_node);
  sensor.pass(1ms);
  EXPECT_EQ(sensor.ask("605 40 17 10 00 00 00 00 00"), "585 42 17 10 00 00 00 00 00");
  EXPECT_EQ(sensor.ask(read_position), position(0));
}

// shows 004.148
TEST(Rk5cNode, SendsItsValuesFromStartToPreOperational) {
  for (const char* const node : {"00", "05"}) {
    RunningSensor sensor;
    EXPECT_EQ(sensor.pass(10ms), "");
    sensor.ask(std::string{"000 01 "} + node);
    EXPECT_EQ(sensor.pass(2ms), "185 00 00 00 00 00 00 | 185 00 00 00 00 00 00");
    sensor.ask(std::string{"000 80 "} + node);
    EXPECT_EQ(sensor.pass(10ms), "");
  }
}

// shows 004.146
TEST(Rk5cNode, KeepsWhatLssHasStoredBeyondPowerOff) {
  Sensor sensor{std::nullopt};
  EXPECT_EQ(sensor.boot_up, "");
  sensor.ask("7E5 04 01 00 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("7E5 11 05 00 00 00 00 00 00"), "7E4 11 00 00 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("7E5 13 00 02 00 00 00 00 00"), "7E4 13 00 00 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("7E5 17 00 00 00 00 00 00 00"), "7E4 17 00 00 00 00 00 00 00");
  EXPECT_TRUE(sensor.logged("LSS: node-ID 5, 500 kbit/s stored"));
  EXPECT_EQ(sensor.power_cycle(), "705 00");
  EXPECT_EQ(sensor.app->node().node_id(), canopen::NodeId{5});
}

// shows 004.19
TEST(Rk5cNode, TellsThatItsMemoryCannotBeWritten) {
  Sensor sensor{canopen::NodeId{5}, "no such folder/rk5c.parameters"};
  sensor.ask("7E5 04 01 00 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("7E5 17 00 00 00 00 00 00 00"), "7E4 17 02 00 00 00 00 00 00");
  EXPECT_EQ(sensor.ask(save), "585 80 10 10 01 00 00 06 06");
}

// shows 004.6
TEST(Rk5cNode, TellsRevisionAndSerialNumberByLssAndIn1018h) {
  Sensor sensor;
  sensor.ask("7E5 04 01 00 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("7E5 5C 00 00 00 00 00 00 00"), "7E4 5C 01 00 01 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 40 18 10 03 00 00 00 00"), "585 42 18 10 03 01 00 01 00");
  EXPECT_EQ(sensor.ask("7E5 5D 00 00 00 00 00 00 00"), "7E4 5D 34 12 01 15 00 00 00");
  EXPECT_EQ(sensor.ask("605 40 18 10 04 00 00 00 00"), "585 42 18 10 04 34 12 01 15");
}

TEST(Rk5cNode, LogsItsStateAndItsIndicators) {
  Sensor sensor;
  EXPECT_TRUE(sensor.logged("status 0x02"));
  EXPECT_TRUE(sensor.logged("state pre-operational, node-ID 5"));
  EXPECT_TRUE(sensor.logged("RUN blinking"));
  sensor.ask(bench::start);
  EXPECT_TRUE(sensor.logged("state operational, node-ID 5"));
  EXPECT_TRUE(sensor.logged("RUN on"));
  EXPECT_EQ(sensor.input("position 2 0"), "?");
  EXPECT_EQ(sensor.input("magnet perhaps"), "?");
  EXPECT_EQ(sensor.input("nothing"), "?");
}

}  // namespace
