/// The application of a device as a class: which of its functions the node calls, and when.
#include <gtest/gtest.h>

#include <every_service/device.hpp>
#include <map>
#include <string>
#include <vector>

#include "support/bench.hpp"

namespace {

using canopen::AbortCode;
using canopen::NmtState;
using namespace std::chrono_literals;
namespace od = every_service::od;

struct Application {
  canopen::Result<void> write(od::word, std::uint16_t value) {
    calls.push_back("write " + std::to_string(value));
    return value <= 1000 ? canopen::ok : AbortCode::value_too_high;
  }
  void written(od::word, std::uint16_t value, auto& node) {
    calls.push_back("written " + std::to_string(value) + ", holds " + std::to_string(node.get(od::word{})));
    node.set(od::measured_value{}, static_cast<std::int16_t>(-value));
  }
  template <std::uint8_t I>
  void written(od::positions<I>, std::int32_t value) {
    calls.push_back("position " + std::to_string(I) + " = " + std::to_string(value));
  }
  void written(od::text, const canopen::VisibleString<16>& value) { calls.push_back(std::string{value.view()}); }
  std::uint8_t read(od::percentage) { return ++reads; }
  canopen::Result<float> read(od::ratio) { return AbortCode::device_state; }
  void on_state(NmtState state) { states.push_back(state); }
  void on_sync(std::uint8_t counter, auto& node) {
    calls.push_back("sync " + std::to_string(counter) + " of node " + std::to_string(node.node_id().value()));
  }

  std::vector<std::string> calls;
  std::vector<NmtState> states;
  std::uint8_t reads = 0;
};

using Device = bench::Bench<every_service::Device, Application>;

[[nodiscard]] std::vector<std::string> take(Application& application) { return std::exchange(application.calls, {}); }
using Calls = std::vector<std::string>;

TEST(Application, AcceptsOrRejectsAValueBeforeItIsStored) {
  Device device{Application{}};
  Application& application = device.node.application<Application>();
  EXPECT_EQ(device.ask("605 2B 01 20 00 E8 03 00 00"), "585 60 01 20 00 00 00 00 00");
  EXPECT_EQ(take(application), (Calls{"write 1000", "written 1000, holds 1000"}));
  EXPECT_EQ(device.node.get(od::measured_value{}), -1000);
  EXPECT_EQ(device.ask("605 2B 01 20 00 E9 03 00 00"), "585 80 01 20 00 31 00 09 06") << "0609 0031h: too high";
  EXPECT_EQ(take(application), Calls{"write 1001"});
  EXPECT_EQ(device.node.get(od::word{}), 1000);
}

TEST(Application, IsAskedForTheValuesOfAnRpdo) {
  Device device{Application{}};
  Application& application = device.node.application<Application>();
  device.ask(bench::start);
  EXPECT_EQ(device.ask("205 09 02 01 FF FF FF FF").substr(0, 15), "185 09 02 01 00") << "TPDO 1 maps the word";
  EXPECT_EQ(take(application), (Calls{"write 258", "written 258, holds 258", "position 1 = -1"}));
  device.ask("205 09 FF FF 02 00 00 00");  // the word is rejected, the rest is applied
  EXPECT_EQ(take(application), (Calls{"write 65535", "position 1 = 2"}));
  EXPECT_EQ(device.node.get(od::word{}), 258);
}

TEST(Application, LearnsOfAnEqualValueToo) {
  Device device{Application{}};
  Application& application = device.node.application<Application>();
  device.ask("605 23 02 20 02 07 00 00 00");
  device.ask("605 23 02 20 02 07 00 00 00");
  EXPECT_EQ(take(application), (Calls{"position 2 = 7", "position 2 = 7"}));
}

TEST(Application, GetsAStringOfSeveralSegments) {
  Device device{Application{}};
  device.ask("605 21 06 20 00 08 00 00 00");
  device.ask("605 00 63 61 6E 6F 70 65 6E");
  EXPECT_EQ(take(device.node.application<Application>()), Calls{});
  EXPECT_EQ(device.ask("605 1D 21 00 00 00 00 00 00"), "585 30 00 00 00 00 00 00 00");
  EXPECT_EQ(take(device.node.application<Application>()), Calls{"canopen!"});
}

TEST(Application, SuppliesTheValueOfAnUpload) {
  Device device{Application{}};
  EXPECT_EQ(device.ask("605 40 05 20 00 00 00 00 00"), "585 4F 05 20 00 01 00 00 00");
  EXPECT_EQ(device.ask("605 40 05 20 00 00 00 00 00"), "585 4F 05 20 00 02 00 00 00");
  EXPECT_EQ(device.ask("605 40 0A 20 00 00 00 00 00"), "585 80 0A 20 00 22 00 00 08")
      << "0800 0022h: not in this state";
}

/// Measures the word of TPDO 1 and a position of TPDO 2.
struct Sensor {
  std::uint16_t read(od::word) { return static_cast<std::uint16_t>(++measurements * 0x101); }
  canopen::Result<std::int32_t> read(od::positions<1>) {
    if (broken) return AbortCode::device_state;
    return -2;
  }
  int measurements = 0;
  bool broken = false;
};

TEST(Application, SuppliesTheValuesOfATpdoThatIsSent) {
  auto device = bench::with<every_service::Device>(Sensor{});
  EXPECT_EQ(device.ask("605 2B 00 18 05 0A 00 00 00"), "585 60 00 18 05 00 00 00 00") << "event timer: 10 ms";
  device.ask(bench::start);
  Sensor& sensor = device.node.application<Sensor>();
  sensor.measurements = 0;
  EXPECT_EQ(device.pass(10ms).substr(0, 15), "185 00 01 01 00") << "the first value";
  EXPECT_EQ(device.pass(10ms).substr(0, 15), "185 00 02 02 00");
  EXPECT_EQ(sensor.measurements, 2) << "once for each TPDO";
}

TEST(Application, SuppliesTheValuesOfATpdoAtASync) {
  auto device = bench::with<every_service::Device>(Sensor{});
  device.ask(bench::start);
  const std::string synchronous = device.ask("080");
  EXPECT_NE(synchronous.find("285 FE FF FF FF 00 00 00 00"), std::string::npos) << synchronous;
  device.node.application<Sensor>().broken = true;
  device.node.set(od::positions<1>{}, 7);
  device.pass(0s);
  const std::string last = device.ask("080");
  EXPECT_NE(last.find("285 07 00 00 00 00 00 00 00"), std::string::npos) << "the last value is sent: " << last;
}

TEST(Application, SuppliesAValueOfTwoTpdosWithoutEnd) {
  auto device = bench::with<every_service::Device>(Sensor{});
  for (const auto* request : {"605 23 01 18 01 85 02 00 80", "605 2F 01 18 02 FF 00 00 00",  // TPDO 2: event-driven,
                              "605 2F 01 1A 00 00 00 00 00", "605 23 01 1A 01 10 00 01 20",  // maps the word as well
                              "605 2F 01 1A 00 01 00 00 00", "605 23 01 18 01 85 02 00 00"})
    device.ask(request);
  const std::string first = device.ask(bench::start);
  EXPECT_EQ(first.substr(0, 33), "185 00 01 01 00 | 285 02 02 | 485") << "each with a value of its own";
  EXPECT_EQ(device.pass(0s), "");
  EXPECT_EQ(device.node.next_deadline(), std::nullopt);
  device.node.set(od::word{}, 7);
  EXPECT_EQ(device.pass(0s).substr(0, 27), "185 00 03 03 00 | 285 04 04") << "both are sent, once";
  EXPECT_EQ(device.pass(0s), "");
}

/// Measures with the node.
struct Converter {
  std::uint8_t read(od::byte, auto& node) { return static_cast<std::uint8_t>(node.get(od::word{}) / 2); }
};

TEST(Application, SuppliesAValueWithItsNode) {
  auto device = bench::with<every_service::Device>(Converter{});
  device.node.set(od::word{}, 8);
  EXPECT_EQ(device.ask("605 40 00 20 00 00 00 00 00"), "585 4F 00 20 00 04 00 00 00");
}

TEST(Application, LearnsOfStatesAndSyncs) {
  Device device{Application{}};
  Application& application = device.node.application<Application>();
  device.ask(bench::start);
  device.ask("080");
  EXPECT_EQ(take(application), Calls{"sync 0 of node 5"});
  EXPECT_EQ(application.states,
            (std::vector{NmtState::initialisation, NmtState::pre_operational, NmtState::operational}));
}

TEST(Application, IsNotCalledForItsOwnValues) {
  Device device{Application{}};
  device.node.set(od::word{}, 5);
  EXPECT_EQ(take(device.node.application<Application>()), Calls{});
}

TEST(Application, MayLiveOutsideOfItsNode) {
  Application application;
  auto device = bench::with<every_service::Device>(canopen::application_at(application));
  device.ask("605 2B 01 20 00 05 00 00 00");
  EXPECT_EQ(take(application), (Calls{"write 5", "written 5, holds 5"}));
}

TEST(Application, IsDefaultConstructedInItsNode) {
  bench::RecordingBus bus;
  bench::NodeOf<every_service::Device, bench::RecordingBus, Application> node{bus, canopen::NodeId{7}};
  node.start({});
  EXPECT_EQ(bus.take(), "707 00");
  EXPECT_EQ(node.application<Application>().states.size(), 2u);
}

struct Resets {
  void written(od::byte, std::uint8_t, auto& node) {
    node.request(canopen::NmtCommand::reset_communication, canopen::TimePoint{});
  }
};

TEST(Application, MayRequestAnNmtCommandAfterItsValueIsStored) {
  auto device = bench::with<every_service::Device>(Resets{});
  EXPECT_EQ(device.ask("605 2F 00 20 00 09 00 00 00"), "585 60 00 20 00 00 00 00 00 | 705 00");
}

struct Starts {
  void on_state(NmtState state, auto& node) {
    if (state == NmtState::pre_operational) node.request(canopen::NmtCommand::start, canopen::TimePoint{});
  }
};
struct Follows {
  void on_state(NmtState state) { states.push_back(state); }
  std::vector<NmtState> states;
};

TEST(Application, AfterOneThatLeavesAStateLearnsOfTheNewOneOnly) {
  auto device = bench::with<every_service::Device>(Starts{}, Follows{});
  EXPECT_EQ(device.node.state(), NmtState::operational);
  EXPECT_EQ(device.node.application<Follows>().states, (std::vector{NmtState::initialisation, NmtState::operational}));
}

struct StopsAtAnError {
  void on_rpdo(canopen::RpdoEvent event, std::uint16_t, auto& node) {
    if (event == canopen::RpdoEvent::length_right) node.request(canopen::NmtCommand::stop, canopen::TimePoint{});
  }
};

TEST(Application, GetsNoValuesOfAnRpdoAtWhichItLeavesOperational) {
  auto device = bench::with<every_service::Device>(StopsAtAnError{});
  device.ask(bench::start);
  device.ask("205 01");  // too short
  device.ask("205 09 01 00 FF FF FF FF");
  EXPECT_EQ(device.node.state(), NmtState::stopped);
  EXPECT_EQ(device.node.get(od::byte{}), 0);
}

/// Maps the RPDO, or the TPDO, of which it gets a value. A valid PDO keeps its mapping.
struct Remaps {
  template <std::uint16_t Number, class Layout, class Node, class CobId>
  void map(Node& node, CobId cob_id) {
    while_valid = node.template map<Number, Layout>();
    const auto valid = node.get(cob_id);
    ASSERT_EQ(node.modify(cob_id, [](auto& word) { word.not_valid(true); }), canopen::ok);
    mapped = node.template map<Number, Layout>();
    ASSERT_EQ(node.set(cob_id, valid), canopen::ok);
  }
  void written(od::word, std::uint16_t value, auto& node) {
    const od::rpdo_communication_parameter_1::cob_id rpdo{};
    const od::tpdo_communication_parameter_1::cob_id tpdo{};
    if (value == 1) map<1, canopen::Rpdo<od::word, od::byte>>(node, rpdo);
    if (value == 2) map<1, canopen::Rpdo<od::byte>>(node, rpdo);
    if (value == 3) map<1, canopen::Tpdo<od::byte, od::positions<1>>>(node, tpdo);
    if (value == 4) map<1, canopen::Tpdo<od::word>>(node, tpdo);
  }
  AbortCode mapped = AbortCode::general;
  AbortCode while_valid = canopen::ok;
};

TEST(Application, MayMapAPdoAnewWhenItGetsAValueOfIt) {
  const auto after = [](const char* frame, std::int32_t position) {
    auto device = bench::with<every_service::Device>(Remaps{});
    device.ask(bench::start);
    device.ask(frame);
    EXPECT_EQ(device.node.application<Remaps>().while_valid, AbortCode::unsupported_access) << frame;
    EXPECT_EQ(device.node.application<Remaps>().mapped, canopen::ok) << frame;
    EXPECT_EQ(device.node.get(od::positions<1>{}), position) << frame;
    device.ask("205 0A 0B 0C 0D 0E 0F 10 11");
    return std::to_string(device.node.get(od::byte{})) + " " + std::to_string(device.node.get(od::word{}));
  };
  EXPECT_EQ(after("205 09 01 00 07 00 00 00", 0), "12 2826") << "the rest of the frame has no object any more";
  EXPECT_EQ(after("205 09 02 00 07 00 00 00", 0), "10 2");
  EXPECT_EQ(after("205 09 03 00 07 00 00 00", 7), "10 3083") << "of another PDO: the rest is applied";
  EXPECT_EQ(after("205 09 04 00 07 00 00 00", 7), "10 3083");
}

/// One function for all objects.
struct Log {
  void written(auto object, const auto&) { ++count[object.index]; }
  std::map<std::uint16_t, int> count;
};

TEST(Application, MayHaveOneFunctionForAllObjects) {
  auto device = bench::with<every_service::Device>(Log{});
  device.ask("605 2F 00 20 00 09 00 00 00");
  device.ask("605 2B 01 20 00 09 00 00 00");
  device.ask("605 2B 17 10 00 64 00 00 00");
  EXPECT_EQ(device.node.application<Log>().count,
            (std::map<std::uint16_t, int>{{0x2000, 1}, {0x2001, 1}, {0x1017, 1}}));
}

// A small application takes no memory of its own.
struct Stateless {
  void written(od::byte, std::uint8_t) {}
};
struct Nowhere {
  static bool send(const canopen::Frame&) { return true; }
};
struct OneWriteHandler {
  void operator()(std::uint8_t) const {}
};
static_assert(sizeof(bench::NodeOf<every_service::Device, Nowhere, Stateless>) <=
              sizeof(bench::NodeOf<every_service::Device, Nowhere, canopen::WriteHandler<od::byte, OneWriteHandler>>));

TEST(WrittenHandler, IsCalledAfterTheValueIsStored) {
  std::vector<int> seen;
  auto device = bench::with<every_service::Device>(canopen::on_written(od::byte{}, [&](auto& node, std::uint8_t value) {
    seen = {value, node.get(od::byte{})};
  }));
  device.ask("605 2F 00 20 00 09 00 00 00");
  EXPECT_EQ(seen, (std::vector{9, 9}));
}

// Values by tags

TEST(ObjectValues, TakeAnElementByItsNumberAtRunTime) {
  bench::Bench<every_service::Device> device;
  for (std::uint8_t i = 1; i <= 2; ++i) EXPECT_EQ(device.node.set(od::positions{}, i, -i), canopen::ok);
  EXPECT_EQ(device.node.get(od::positions<1>{}), -1);
  EXPECT_EQ(*device.node.get(od::positions{}, 2), -2);
  EXPECT_EQ(device.node.get(od::positions{}, 0).abort_code(), AbortCode::no_sub_index) << "0 is the number of elements";
  EXPECT_EQ(device.node.get(od::positions{}, 200).abort_code(), AbortCode::no_sub_index);
  EXPECT_EQ(device.node.set(od::positions{}, 0, 1), AbortCode::no_sub_index);
  EXPECT_EQ(device.node.set(od::contacts{}, 1, true), canopen::ok);
  EXPECT_TRUE(*device.node.get(od::contacts{}, 1));
}

TEST(ObjectValues, AskTheServiceOfAnElement) {
  bench::Bench<every_service::Device> device;
  EXPECT_EQ(device.node.set(od::consumer_heartbeat_time{}, 1, canopen::raw(0x000A'0064)), canopen::ok);
  EXPECT_EQ(device.node.set(od::consumer_heartbeat_time{}, 2, canopen::raw(0x000A'0064)),
            AbortCode::parameter_incompatible)
      << "1016h:01 consumes node 10";
  EXPECT_EQ(canopen::to_raw(device.node.get(od::consumer_heartbeat_time<2>{})), 0u);
}

TEST(ObjectValues, CheckAValueOfTheRunningProgram) {
  bench::Bench<every_service::Device> device;
  std::uint8_t value = 100;
  EXPECT_EQ(device.node.set(od::percentage{}, value), canopen::ok);
  EXPECT_EQ(device.node.set(od::percentage{}, ++value), AbortCode::value_too_high);
  EXPECT_EQ(device.node.get(od::percentage{}), 100);
  device.node.set(od::percentage{}, 7);
  EXPECT_EQ(device.node.get(od::percentage{}), 7);
  EXPECT_EQ(device.node.set(od::signed_24_bits{}, value), canopen::ok);
  EXPECT_EQ(device.node.get(od::signed_24_bits{}), 101) << "an UNSIGNED8 fits into 24 bits";
  device.node.set<od::signed_24_bits, -8'388'608>();
  EXPECT_EQ(device.node.get(od::signed_24_bits{}), -8'388'608);
}

struct EventForms {
  void on_state(auto) { ++calls; }
  void on_sync(auto...) { ++calls; }
  void on_emergency(const canopen::ConsumedEmergency&, auto&) {}
  void on_heartbeat(canopen::HeartbeatEvent, canopen::NodeId, NmtState, auto&) {}
  static void on_error(std::uint16_t) {}
  int calls = 0;
};

TEST(Application, AcceptsEachFormOfAFunctionOfAnEvent) {
  EventForms application;
  auto device = bench::with<every_service::Device>(canopen::application_at(application));
  device.ask("000 01 05");
  const int before = application.calls;
  device.ask("080");
  EXPECT_EQ(application.calls, before + 1);
}

}  // namespace
