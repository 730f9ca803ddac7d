/// Channels of an I/O module (CiA 401) and of an encoder (CiA 406), and the frames that they cause.
#include <gtest/gtest.h>

#include <array>
#include <canopen/profile/cia401.hpp>
#include <canopen/profile/cia406.hpp>
#include <cstdint>
#include <encoder/device.hpp>
#include <io_device/device.hpp>
#include <sample/device.hpp>
#include <string>
#include <utility>
#include <vector>

#include "support/bench.hpp"

namespace {

using namespace std::chrono_literals;

struct ProfileDigitalInputs : testing::Test {
  ProfileDigitalInputs() {
    module.ask(bench::start);
    module.pass(1s);
  }
  /// Returns what the module sends if the terminals of its first block have these levels.
  std::string sample(std::uint8_t levels) {
    inputs.sample(module.node, 0, levels);
    return module.pass(1ms);
  }
  bench::Bench<io_device::Device> module;
  canopen::DigitalInputs<io_device::Device> inputs;
};

TEST_F(ProfileDigitalInputs, SendTheirTpdoAtAChange) {
  EXPECT_EQ(sample(0x55), "185 55 00");
  EXPECT_EQ(sample(0x55), "");
  inputs.sample(module.node, 1, 0x80);
  EXPECT_EQ(module.pass(1ms), "185 55 80");
  inputs.sample(module.node, 2, 0xFF);  // there is no third block
  EXPECT_EQ(module.pass(1ms), "");
}

TEST_F(ProfileDigitalInputs, AreInvertedBy6002h) {
  EXPECT_EQ(module.ask("605 2F 02 60 01 0F 00 00 00"), "585 60 02 60 01 00 00 00 00");
  EXPECT_EQ(sample(0x55), "185 5A 00");
}

TEST_F(ProfileDigitalInputs, CountWith6003hWhenTheyAreFoundAlikeTwice) {
  EXPECT_EQ(module.ask("605 2F 03 60 01 0F 00 00 00"), "585 60 03 60 01 00 00 00 00");
  EXPECT_EQ(sample(0x11), "185 10 00");
  EXPECT_EQ(sample(0x12), "");  // bit 0 was a spike, bit 1 is new
  EXPECT_EQ(sample(0x12), "185 12 00");
}

TEST_F(ProfileDigitalInputs, SendNothingWhile6005hIs0) {
  EXPECT_EQ(module.ask("605 2F 05 60 00 00 00 00 00"), "585 60 05 60 00 00 00 00 00");
  EXPECT_EQ(sample(0x01), "");
  EXPECT_EQ(module.ask("605 40 00 60 01 00 00 00 00"), "585 4F 00 60 01 01 00 00 00");
}

TEST_F(ProfileDigitalInputs, SendTheChangesThatTheMasksAskFor) {
  EXPECT_EQ(module.ask("605 2F 06 60 01 80 00 00 00"), "585 60 06 60 01 00 00 00 00");  // any change of bit 7
  EXPECT_EQ(module.ask("605 2F 07 60 01 01 00 00 00"), "585 60 07 60 01 00 00 00 00");  // bit 0 rises
  EXPECT_EQ(module.ask("605 2F 08 60 01 02 00 00 00"), "585 60 08 60 01 00 00 00 00");  // bit 1 falls
  EXPECT_EQ(sample(0x01), "185 01 00");
  EXPECT_EQ(sample(0x00), "");
  EXPECT_EQ(sample(0x02), "");
  EXPECT_EQ(sample(0x00), "185 00 00");
  EXPECT_EQ(sample(0x80), "185 80 00");
  EXPECT_EQ(sample(0x00), "185 00 00");
  EXPECT_EQ(sample(0x40), "");
}

struct ProfileDigitalOutputs : testing::Test {
  ProfileDigitalOutputs() {
    module.ask(bench::start);
    module.pass(1s);
  }
  /// Returns the levels of both blocks after this frame.
  std::vector<unsigned> ask(const std::string& request) {
    module.ask(request);
    return update();
  }
  std::vector<unsigned> update() {
    outputs.update(module.node, [this](std::uint8_t block, std::uint8_t now) { levels.at(block) = now; });
    return levels;
  }
  bench::Bench<io_device::Device> module;
  canopen::DigitalOutputs<io_device::Device> outputs;
  std::vector<unsigned> levels = {0, 0};
};

TEST_F(ProfileDigitalOutputs, FollowRpdoAndSdo) {
  EXPECT_EQ(ask("205 34 12"), (std::vector<unsigned>{0x34, 0x12}));
  EXPECT_EQ(ask("605 2F 00 62 02 56 00 00 00"), (std::vector<unsigned>{0x34, 0x56}));
}

TEST_F(ProfileDigitalOutputs, AreDrivenOncePerChange) {
  module.ask("205 34 00");
  int calls = 0;
  const auto count = [&calls](std::uint8_t, std::uint8_t) { ++calls; };
  outputs.update(module.node, count);
  outputs.update(module.node, count);
  EXPECT_EQ(calls, 1);
}

TEST_F(ProfileDigitalOutputs, AreInvertedBy6202hAndMaskedBy6208h) {
  EXPECT_EQ(ask("605 2F 02 62 01 F0 00 00 00"), (std::vector<unsigned>{0xF0, 0x00}));
  EXPECT_EQ(ask("605 2F 08 62 01 7F 00 00 00"), (std::vector<unsigned>{0xF0, 0x00}));
  EXPECT_EQ(ask("205 FF 00"), (std::vector<unsigned>{0x8F, 0x00}));  // bit 7 keeps its level
}

TEST_F(ProfileDigitalOutputs, TakeTheValuesOf6207hWhere6206hSaysSo) {
  ask("605 2F 06 62 01 0F 00 00 00");
  ask("605 2F 07 62 01 A5 00 00 00");
  ask("205 F0 FF");
  outputs.fail(module.node);
  EXPECT_EQ(update(), (std::vector<unsigned>{0xF5, 0x00}));
  EXPECT_EQ(module.ask("605 40 00 62 01 00 00 00 00"), "585 4F 00 62 01 F5 00 00 00");
  EXPECT_EQ(ask("205 F0 FF"), (std::vector<unsigned>{0xF0, 0xFF}));  // a new value takes effect again
}

/// The module without these objects.
template <std::uint16_t... Missing>
struct ModuleWithout : io_device::Device {
  static constexpr auto entries = [] {
    std::array<canopen::entry::Word, std::size(io_device::table::entries)> words{};
    for (std::size_t run = 0; run + 1 < std::size(io_device::table::runs); ++run) {
      for (std::size_t at = io_device::table::runs[run].position; at < io_device::table::runs[run + 1].position; ++at) {
        const std::size_t index = io_device::table::runs[run].first + at - io_device::table::runs[run].position;
        words[at] = ((index == Missing) || ...) ? canopen::Dictionary::no_object : io_device::table::entries[at];
      }
    }
    return words;
  }();
  static constexpr canopen::Dictionary dictionary = [] {
    canopen::Dictionary copy = io_device::dictionary;
    copy.entries = entries;
    return copy;
  }();
};

/// The outputs of the first blocks and channels after a loss of communication; they were F0h, FFh, 1000 and -1000.
template <std::uint16_t... Missing>
std::string outputs_after_a_loss() {
  bench::Bench<ModuleWithout<Missing...>> module;
  canopen::DigitalOutputs<ModuleWithout<Missing...>> digital;
  canopen::AnalogueOutputs<ModuleWithout<Missing...>> analogue;
  for (const char* write : {"605 2F 00 62 01 F0 00 00 00", "605 2F 00 62 02 FF 00 00 00", "605 2F 06 62 01 0F 00 00 00",
                            "605 2F 07 62 01 A5 00 00 00", "605 2B 11 64 01 E8 03 00 00", "605 2B 11 64 02 18 FC 00 00",
                            "605 2F 43 64 01 00 00 00 00", "605 23 44 64 02 07 00 00 00"}) {
    module.ask(write);
  }
  digital.fail(module.node);
  analogue.fail(module.node);
  std::string text;
  for (const char* read : {"605 40 00 62 01 00 00 00 00", "605 40 00 62 02 00 00 00 00", "605 40 11 64 01 00 00 00 00",
                           "605 40 11 64 02 00 00 00 00"}) {
    text += (text.empty() ? "" : ", ") + module.ask(read).substr(16, read[8] == '0' ? 2 : 5);
  }
  return text;
}

// CiA 401: error mode 1, the default, applies the error value, 0 by default.
TEST(ProfileOutputs, KeepTheirValuesWithoutErrorModeAndErrorValue) {
  EXPECT_EQ(outputs_after_a_loss<>(), "F5, 00, E8 03, 07 00");
  EXPECT_EQ((outputs_after_a_loss<0x6206, 0x6207>()), "F0, FF, E8 03, 07 00");
  EXPECT_EQ((outputs_after_a_loss<0x6443, 0x6444>()), "F5, 00, E8 03, 18 FC");
  EXPECT_EQ((outputs_after_a_loss<0x6206>()), "A5, 00, E8 03, 07 00");
  EXPECT_EQ((outputs_after_a_loss<0x6207>()), "F0, 00, E8 03, 07 00");
  EXPECT_EQ((outputs_after_a_loss<0x6443>()), "F5, 00, 00 00, 07 00");
  EXPECT_EQ((outputs_after_a_loss<0x6444>()), "F5, 00, E8 03, 00 00");
}

TEST(ProfileOutputs, FailInStoppedWithoutHeartbeatAndWithBusOff) {
  EXPECT_TRUE(canopen::outputs_fail(canopen::NmtState::stopped));
  EXPECT_FALSE(canopen::outputs_fail(canopen::NmtState::pre_operational));
  EXPECT_TRUE(canopen::outputs_fail(canopen::HeartbeatEvent::lost));
  EXPECT_FALSE(canopen::outputs_fail(canopen::HeartbeatEvent::back));
  EXPECT_TRUE(canopen::outputs_fail(canopen::BusStatus{canopen::BusState::off}));
  EXPECT_FALSE(canopen::outputs_fail(canopen::BusStatus{canopen::BusState::passive}));
}

/// A module that does all that CiA 401 requires of its outputs when communication is lost.
struct FailSafe {
  canopen::DigitalOutputs<io_device::Device> digital;
  canopen::AnalogueOutputs<io_device::Device> analogue;
  void fail(auto& node) {
    digital.fail(node);
    analogue.fail(node);
  }
};

auto fail_safe(FailSafe& outputs) {
  return bench::with<io_device::Device>(
      canopen::on_state([&](auto& node, canopen::NmtState state) {
        if (canopen::outputs_fail(state)) outputs.fail(node);
      }),
      canopen::on_heartbeat([&](auto& node, canopen::HeartbeatEvent event, canopen::NodeId, canopen::NmtState) {
        if (canopen::outputs_fail(event)) outputs.fail(node);
      }),
      canopen::on_life_guarding([&](auto& node, bool lost) {
        if (lost) outputs.fail(node);
      }));
}

/// Sets error values of the first digital block and analogue channel; then Operational, with 1 in each.
void set_up(auto& module) {
  module.ask("605 2F 07 62 01 A5 00 00 00");
  module.ask("605 23 44 64 01 00 C0 FF FF");  // -16384
  module.ask(bench::start);
  module.ask("205 01 00");
  module.ask("305 01 00 00 00");
  module.pass(1ms);
}

TEST(ProfileOutputs, TakeTheirErrorValuesWithoutHeartbeat) {
  FailSafe outputs;
  auto module = fail_safe(outputs);
  module.ask("605 23 16 10 01 64 00 01 00");  // node 1 within 100 ms
  set_up(module);
  module.ask("701 05");
  EXPECT_EQ(module.pass(99ms), "");
  EXPECT_EQ(module.pass(1ms), "085 30 81 11 00 00 00 00 00");
  EXPECT_EQ(module.ask("605 40 00 62 01 00 00 00 00"), "585 4F 00 62 01 A5 00 00 00");
  EXPECT_EQ(module.ask("605 40 11 64 01 00 00 00 00"), "585 4B 11 64 01 00 C0 00 00");
  EXPECT_EQ(module.node.state(), canopen::NmtState::pre_operational);
}

TEST(ProfileOutputs, TakeTheirErrorValuesInTheStateThat1029hLeadsTo) {
  FailSafe outputs;
  auto module = fail_safe(outputs);
  module.ask("605 2F 29 10 01 02 00 00 00");
  set_up(module);
  module.node.on_bus_status({canopen::BusState::off}, module.now);
  EXPECT_EQ(module.node.state(), canopen::NmtState::stopped);
  EXPECT_EQ(canopen::to_raw(module.node.get<io_device::od::write_output_8_bit<1>>()), 0xA5);
  EXPECT_EQ(module.node.get<io_device::od::write_analogue_output_16_bit<1>>(), -16384);
}

TEST(ProfileOutputs, TakeTheirErrorValuesAfterALifeGuardingEvent) {
  FailSafe outputs;
  auto module = fail_safe(outputs);
  module.ask("605 2B 0C 10 00 64 00 00 00");
  module.ask("605 2F 0D 10 00 02 00 00 00");
  set_up(module);
  EXPECT_EQ(module.ask("705 R 1"), "705 05");
  EXPECT_EQ(module.pass(200ms), "085 30 81 11 00 00 00 00 00");
  EXPECT_EQ(canopen::to_raw(module.node.get<io_device::od::write_output_8_bit<1>>()), 0xA5);
}

struct ProfileAnalogueInputs : testing::Test {
  ProfileAnalogueInputs() {
    module.ask(bench::start);
    module.pass(1s);
    module.ask("605 2F 23 64 00 01 00 00 00");
  }
  std::string sample(std::int16_t value) {
    inputs.sample(module.node, 0, value);
    return module.pass(1ms);
  }
  void trigger(unsigned bits) {
    module.ask(bench::text({.id = 0x605, .size = 8, .data = {0x2F, 0x21, 0x64, 1, static_cast<std::uint8_t>(bits)}}));
  }
  bench::Bench<io_device::Device> module;
  canopen::AnalogueInputs<io_device::Device> inputs;
};

TEST_F(ProfileAnalogueInputs, SendNothingWhile6423hIs0) {
  module.ask("605 2F 23 64 00 00 00 00 00");
  trigger(0x04);
  EXPECT_EQ(sample(100), "");
  EXPECT_EQ(module.ask("605 40 01 64 01 00 00 00 00"), "585 4B 01 64 01 64 00 00 00");
}

TEST_F(ProfileAnalogueInputs, SendEachChangeAtOrAboveTheUpperLimit) {
  module.ask("605 23 24 64 01 E8 03 00 00");  // 1000
  trigger(0x01);
  EXPECT_EQ(sample(999), "");
  EXPECT_EQ(sample(1000), "285 E8 03 00 00");
  EXPECT_EQ(sample(1000), "");
  EXPECT_EQ(sample(1001), "285 E9 03 00 00");
  EXPECT_EQ(sample(500), "");
}

TEST_F(ProfileAnalogueInputs, SendEachChangeBelowTheLowerLimit) {
  module.ask("605 23 25 64 01 18 FC FF FF");  // -1000
  trigger(0x02);
  EXPECT_EQ(sample(-1000), "");
  EXPECT_EQ(sample(-1001), "285 17 FC 00 00");
}

TEST_F(ProfileAnalogueInputs, SendWhatIsFartherThanADeltaFromTheValueToldLast) {
  module.ask("605 23 26 64 01 0A 00 00 00");
  module.ask("605 23 27 64 01 05 00 00 00");
  module.ask("605 23 28 64 01 14 00 00 00");
  trigger(0x04);
  EXPECT_EQ(sample(10), "");
  EXPECT_EQ(sample(11), "285 0B 00 00 00");
  EXPECT_EQ(sample(1), "");
  EXPECT_EQ(sample(0), "285 00 00 00 00");
  trigger(0x18);
  EXPECT_EQ(sample(20), "");
  EXPECT_EQ(sample(21), "285 15 00 00 00");
  EXPECT_EQ(sample(16), "");
  EXPECT_EQ(sample(15), "285 0F 00 00 00");
}

TEST_F(ProfileAnalogueInputs, WantBothALimitAndADeltaWhenBothAreAskedFor) {
  module.ask("605 23 24 64 01 64 00 00 00");
  module.ask("605 23 26 64 01 0A 00 00 00");
  trigger(0x05);
  EXPECT_EQ(sample(50), "");
  EXPECT_EQ(sample(100), "285 64 00 00 00");
  EXPECT_EQ(sample(105), "");
  EXPECT_EQ(sample(111), "285 6F 00 00 00");
  trigger(0x00);
  EXPECT_EQ(sample(1000), "");
}

TEST(ProfileAnalogueOutputs, FollowTheirObjectAndKeepItWhere6443hIs0) {
  bench::Bench<io_device::Device> module;
  canopen::AnalogueOutputs<io_device::Device> outputs;
  module.ask("605 2F 43 64 02 00 00 00 00");
  module.ask("605 23 44 64 01 F6 FF FF FF");  // -10
  module.ask(bench::start);
  module.ask("305 FF 3F 01 80");
  std::vector<int> values = {0, 0};
  const auto drive = [&](std::uint8_t channel, std::int16_t value) { values.at(channel) = value; };
  outputs.update(module.node, drive);
  EXPECT_EQ(values, (std::vector<int>{0x3FFF, -32767}));
  outputs.fail(module.node);
  outputs.update(module.node, drive);
  EXPECT_EQ(values, (std::vector<int>{-10, -32767}));
}

// A device without these objects has no overhead.
static_assert(canopen::DigitalInputs<sample::Device>::blocks == 0);
static_assert(sizeof(canopen::DigitalInputs<io_device::Device>) == 4);
static_assert(sizeof(canopen::AnalogueOutputs<io_device::Device>) == 4);

/// An encoder whose preset 6003h and cyclic timer 6200h are written over the bus.
struct ProfileEncoder : testing::Test {
  struct TakePreset {
    canopen::Encoder<encoder::Device>* channel;
    void operator()(std::uint32_t value) const { channel->preset(static_cast<std::int32_t>(value)); }
  };
  ProfileEncoder()
      : sensor{canopen::cyclic_timer_sets_event_timer(), canopen::event_timer_sets_cyclic_timer(),
               canopen::on_write<encoder::od::preset_value>(TakePreset{&channel})} {
    sensor.ask(bench::start);
    sensor.pass(1ms);
  }
  std::string measured(std::int32_t position, std::int16_t speed) {
    channel.measured(sensor.node, position, speed);
    return sensor.pass(1ms);
  }
  canopen::Encoder<encoder::Device> channel;
  bench::Bench<encoder::Device, canopen::CyclicTimerHandler, canopen::EventTimerHandler,
               canopen::WriteHandler<encoder::od::preset_value, TakePreset>>
      sensor;
};

TEST_F(ProfileEncoder, TellsPositionAndSpeed) {
  EXPECT_EQ(measured(123'456, -2), "185 40 E2 01 00 FE FF");
  EXPECT_EQ(measured(123'456, -2), "");
}

TEST_F(ProfileEncoder, TellsItsPresetFromTheNextMeasurementOn) {
  measured(1'000, 0);
  EXPECT_EQ(sensor.ask("605 23 03 60 00 0A 00 00 00"), "585 60 03 60 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 40 04 60 00 00 00 00 00"), "585 43 04 60 00 E8 03 00 00");
  EXPECT_EQ(measured(1'000, 0), "185 0A 00 00 00 00 00");
  EXPECT_EQ(measured(1'001, 0), "185 0B 00 00 00 00 00");
  EXPECT_EQ(channel.offset(), -990);
  channel.set_offset(0);
  EXPECT_EQ(measured(1'001, 0), "185 E9 03 00 00 00 00");
}

TEST_F(ProfileEncoder, MeasuresInTheStepsOf6005h) {
  EXPECT_EQ(channel.position_steps(sensor.node, 1'234'567), 1'234);  // nm, in steps of 1000 nm
  EXPECT_EQ(channel.position_steps(sensor.node, -5'000'000'000), -5'000'000);
  EXPECT_EQ(channel.speed_steps(sensor.node, -25'000), -25);  // 0.01 mm/s, in steps of 10 mm/s
}

TEST_F(ProfileEncoder, HasOneCyclicTimerInTwoPlaces) {
  EXPECT_EQ(sensor.ask("605 2B 00 62 00 14 00 00 00"), "585 60 00 62 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 40 00 18 05 00 00 00 00"), "585 4B 00 18 05 14 00 00 00");
  EXPECT_EQ(sensor.pass(20ms), "185 00 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 2B 00 18 05 05 00 00 00"), "585 60 00 18 05 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 40 00 62 00 00 00 00 00"), "585 4B 00 62 00 05 00 00 00");
  EXPECT_EQ(sensor.pass(5ms), "185 00 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 2B 00 62 00 E8 03 00 00"), "585 60 00 62 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 40 00 18 05 00 00 00 00"), "585 4B 00 18 05 E8 03 00 00") << "1000 ms";
  EXPECT_EQ(sensor.ask("605 2B 00 62 00 00 00 00 00"), "585 60 00 62 00 00 00 00 00");
  EXPECT_EQ(sensor.pass(1s), "");
}

}  // namespace
