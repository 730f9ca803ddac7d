/// The boot-up of slaves by an NMT master in the cases that occur in a plant: configuration, requests of the
/// application over the same SDO, slaves that reset, are slow, are silent or are replaced, and a full bus.
#include <gtest/gtest.h>
#include <canopen/host/virtual_bus.hpp>
#include <canopen/nmt_master/nmt_master.hpp>

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
using canopen::NmtCommand;
using canopen::NmtMasterEvent;
using canopen::NmtSlave;
using canopen::NmtStartUp;
using canopen::NmtState;
using canopen::NodeId;
using canopen::SdoAnswer;
using canopen::SdoRequest;
using canopen::TimePoint;
using canopen::VirtualBus;
namespace od = sample::od;
namespace assignment = canopen::slave_assignment;
using namespace std::chrono_literals;
using Lines = std::vector<std::string>;

constexpr std::uint32_t mandatory = assignment::listed | assignment::boot | assignment::mandatory;

struct Told {
  Lines log;
  std::vector<BootResult> results;
};

struct Host {
  Told* told;

  void happened(NmtMasterEvent event, NodeId node_id, NmtState) {
    if (event == NmtMasterEvent::state_changed) return;
    told->log.push_back(std::to_string(node_id.value()) + " " + std::string{to_text(event)});
  }
  void configure(NodeId node_id) { told->log.push_back(std::to_string(node_id.value()) + " configure"); }
  void booted(NodeId node_id, const BootResult& result) {
    told->log.push_back(std::to_string(node_id.value()) + " " + static_cast<char>(result.status));
    told->results.push_back(result);
  }
  void network_started() { told->log.push_back("network started"); }
  void boot_time_elapsed() { told->log.push_back("boot time elapsed"); }
};

/// A master of nodes 5 and 6; the test writes the frames of the slaves.
struct Desk {
  explicit Desk(std::vector<NmtSlave> list) : slaves{std::move(list)} {}

  void start() {
    master.start(now);
    EXPECT_EQ(bus.take(), "000 82 00");
  }
  std::string take(const std::string& text) {
    master.on_frame(bench::frame(text), now);
    return bus.take();
  }
  std::string pass(canopen::Duration span) {
    const TimePoint end = now + span;
    for (int calls = 0; calls < 100'000; ++calls) {
      const auto deadline = master.next_deadline();
      if (!deadline || *deadline > end) break;
      if (*deadline <= now) {  // it waits for room
        if (bus.room == 0) break;
      } else {
        now = *deadline;
      }
      master.on_time(now);
    }
    now = end;
    master.on_time(now);
    return bus.take();
  }
  Lines log() { return std::exchange(told.log, {}); }

  bench::RecordingBus bus;
  Told told;
  TimePoint now{};
  std::vector<NmtSlave> slaves;
  canopen::NmtMaster<bench::RecordingBus, 2, Host, 3> master{bus, slaves, {}, 100ms, Host{&told}};
};

/// The response to each read of the device type.
constexpr auto device_type = "585 43 00 10 00 91 01 0F 00";

NmtSlave slave(std::uint8_t node_id, std::uint16_t heartbeat_time = 0) {
  NmtSlave result{NodeId{node_id}, mandatory};
  result.heartbeat_time = heartbeat_time;
  return result;
}

/// A transfer of the application that records its result.
struct Transfer {
  SdoRequest read(std::uint16_t index, std::uint8_t sub_index) {
    SdoRequest request;
    request.index = index;
    request.sub_index = sub_index;
    request.memory = memory;
    request.done = done;
    request.context = this;
    return request;
  }
  SdoRequest write(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> bytes) {
    SdoRequest request;
    request.index = index;
    request.sub_index = sub_index;
    request.download = true;
    request.bytes = bytes;
    request.done = done;
    request.context = this;
    return request;
  }
  static void done(void* context, NodeId, const SdoAnswer& answer) {
    auto& self = *static_cast<Transfer*>(context);
    ++self.calls;
    self.result = answer.result;
    self.size = answer.data.size();
  }

  std::array<std::uint8_t, 8> memory{};
  AbortCode result = ok_to_come;
  std::size_t size = 0;
  int calls = 0;
  static constexpr AbortCode ok_to_come = AbortCode::local_control;
};

// Heartbeats

/// Boots slave 5 until the master reads 1017h; returns what the master sends in response to `answer`.
std::string ask_for_heartbeat_time(Desk& desk, const std::string& answer) {
  desk.start();
  desk.take("705 00");
  EXPECT_EQ(desk.take(device_type), "");
  desk.master.configured(NodeId{5}, canopen::ok, desk.now);
  EXPECT_EQ(desk.bus.take(), "605 40 17 10 00 00 00 00 00");
  return desk.take(answer);
}

TEST(NmtBoot, ASlaveWhoseHeartbeatTimeIsWrittenIsWatchedFromItsNextHeartbeatOn) {
  Desk desk{{slave(5, 300)}};
  EXPECT_EQ(ask_for_heartbeat_time(desk, "585 4B 17 10 00 FA 00 00 00"), "605 2B 17 10 00 96 00 00 00");
  EXPECT_EQ(desk.take("705 7F"), "");  // with the old period
  EXPECT_EQ(desk.pass(90ms), "");
  EXPECT_EQ(desk.take("585 60 17 10 00 00 00 00 00"), "");  // the new period begins here
  EXPECT_EQ(desk.pass(149ms), "");
  EXPECT_EQ(desk.take("705 7F"), "000 01 05");
  EXPECT_EQ(desk.pass(299ms), "");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure", "5 0", "network started"}));
}

TEST(NmtBoot, ASlaveThatKeepsAHeartbeatTimeInTimeMayRefuseAnother) {
  Desk desk{{slave(5, 300)}};
  EXPECT_EQ(ask_for_heartbeat_time(desk, "585 4B 17 10 00 FA 00 00 00"), "605 2B 17 10 00 96 00 00 00");
  EXPECT_EQ(desk.take("585 80 17 10 00 02 00 01 06"), "");
  EXPECT_EQ(desk.take("705 7F"), "000 01 05");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure", "5 0", "network started"}));
}

TEST(NmtBoot, ASlaveThatRefusesAHeartbeatAtAllDoesNotBoot) {
  Desk desk{{slave(5, 300)}};
  ask_for_heartbeat_time(desk, "585 4B 17 10 00 00 00 00 00");
  desk.take("585 80 17 10 00 02 00 01 06");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure", "5 K"}));
  EXPECT_EQ(desk.told.results.back().abort_code, AbortCode::read_only);
}

// Slaves that are silent

TEST(NmtBoot, SilentSlavesAreAskedInTurn) {
  bench::RecordingBus bus;
  Told told;
  const std::vector<NmtSlave> slaves{slave(1), slave(2), slave(3), slave(4), slave(5), slave(6)};
  canopen::NmtMaster<bench::RecordingBus, 6, Host, 1, 1> master{bus, slaves, {}, 500ms, Host{&told}};
  TimePoint now{};
  master.start(now);
  while (now < TimePoint{30s}) {
    now = std::max(now + 1ms, master.next_deadline().value_or(now));
    master.on_time(now);
  }
  const std::string sent = bus.take();
  for (const char* request : {"601 40", "602 40", "603 40", "604 40", "605 40", "606 40"}) {
    EXPECT_NE(sent.find(request), std::string::npos) << request;
  }
}

TEST(NmtBoot, AConfigurationThatEndsWithATimeoutIsRepeated) {
  Desk desk{{slave(5)}};
  desk.start();
  desk.take("705 00");
  desk.take(device_type);
  desk.master.configured(NodeId{5}, AbortCode::timeout, desk.now);
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure", "5 B"}));
  EXPECT_NE(desk.pass(1500ms).find("605 40 00 10 00 00 00 00 00"), std::string::npos);
}

// The configuration step

TEST(NmtBoot, TheApplicationConfiguresBeforeErrorControl) {
  Desk desk{{slave(5, 100)}};
  desk.start();
  desk.take("705 00");
  EXPECT_EQ(desk.take(device_type), "");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure"}));
  EXPECT_EQ(desk.pass(10s), "") << "it takes the time that it takes";

  Transfer first, second;
  const std::array<std::uint8_t, 2> value{0x12, 0x34};
  EXPECT_TRUE(desk.master.request(NodeId{5}, first.write(0x2001, 0, value), desk.now));
  EXPECT_TRUE(desk.master.request(NodeId{5}, second.write(0x2002, 0, value), desk.now));
  EXPECT_EQ(desk.bus.take(), "605 2B 01 20 00 12 34 00 00") << "one after the other";
  EXPECT_EQ(desk.take("585 60 01 20 00 00 00 00 00"), "605 2B 02 20 00 12 34 00 00");
  EXPECT_EQ(desk.take("585 60 02 20 00 00 00 00 00"), "");
  EXPECT_EQ(first.result, canopen::ok);
  EXPECT_EQ(second.result, canopen::ok);

  desk.master.configured(NodeId{5}, canopen::ok, desk.now);
  EXPECT_EQ(desk.bus.take(), "605 40 17 10 00 00 00 00 00");
  desk.take("585 4B 17 10 00 32 00 00 00");
  EXPECT_EQ(desk.take("705 7F"), "000 01 05");
  EXPECT_EQ(desk.log(), (Lines{"5 0", "network started"}));
}

TEST(NmtBoot, AFailedConfigurationEndsTheBootUp) {
  Desk desk{{slave(5)}};
  desk.start();
  desk.take("705 00");
  desk.take(device_type);
  desk.master.configured(NodeId{5}, AbortCode::value_too_high, desk.now);
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure", "5 J"}));
  EXPECT_EQ(desk.told.results.back().abort_code, AbortCode::value_too_high);
  EXPECT_EQ(desk.pass(10s), "");
  EXPECT_FALSE(desk.master.network_started());
  EXPECT_EQ(desk.take("705 00"), "605 40 00 10 00 00 00 00 00") << "until it boots up again";
}

TEST(NmtBoot, AConfigurationThatABootUpHasOvertakenDoesNotCount) {
  Desk desk{{slave(5)}};
  desk.start();
  desk.take("705 00");
  desk.take(device_type);
  EXPECT_EQ(desk.take("705 00"), "605 40 00 10 00 00 00 00 00");
  desk.master.configured(NodeId{5}, canopen::ok, desk.now);
  EXPECT_EQ(desk.bus.take(), "");
  desk.take(device_type);
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure", "5 boot-up", "5 configure"}));
}

constexpr std::uint8_t dcf[] = {2,    0,    0, 0,                                     // two entries
                                0x0C, 0x20, 0, 5, 0, 0, 0, 'h',  'e', 'l', 'l', 'o',  // 200Ch: a string
                                0x17, 0x10, 0, 2, 0, 0, 0, 0x32, 0};                  // 1017h = 50

TEST(NmtBoot, WritesTheConciseDcfBeforeTheApplicationConfigures) {
  NmtSlave with_dcf = slave(5);
  with_dcf.concise_dcf = dcf;
  Desk desk{{with_dcf}};
  desk.start();
  desk.take("705 00");
  EXPECT_EQ(desk.take(device_type), "605 21 0C 20 00 05 00 00 00");
  EXPECT_EQ(desk.take("585 60 0C 20 00 00 00 00 00"), "605 05 68 65 6C 6C 6F 00 00");
  EXPECT_EQ(desk.take("585 20 00 00 00 00 00 00 00"), "605 2B 17 10 00 32 00 00 00");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up"}));
  EXPECT_EQ(desk.take("585 60 17 10 00 00 00 00 00"), "");
  EXPECT_EQ(desk.log(), (Lines{"5 configure"}));
}

TEST(NmtBoot, TellsWhichEntryOfTheConciseDcfWasRefused) {
  NmtSlave with_dcf = slave(5);
  with_dcf.concise_dcf = dcf;
  Desk desk{{with_dcf}};
  desk.start();
  desk.take("705 00");
  desk.take(device_type);
  EXPECT_EQ(desk.take("585 80 0C 20 00 12 00 07 06"), "");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 J"}));
  EXPECT_EQ(desk.told.results.back().index, 0x200C);
  EXPECT_EQ(desk.told.results.back().abort_code, AbortCode::length_too_high);
}

TEST(NmtBoot, RefusesAConciseDcfThatIsShorterThanItSays) {
  for (std::size_t size = 1; size < std::size(dcf); ++size) {
    NmtSlave with_dcf = slave(5);
    with_dcf.concise_dcf = std::span{dcf}.first(size);
    Desk desk{{with_dcf}};
    desk.start();
    desk.take("705 00");
    desk.take(device_type);
    desk.take("585 60 0C 20 00 00 00 00 00");
    desk.take("585 20 00 00 00 00 00 00 00");
    desk.take("585 60 17 10 00 00 00 00 00");
    EXPECT_EQ(desk.log().back(), "5 J") << size;
    EXPECT_EQ(desk.told.results.back().abort_code, AbortCode::length_mismatch) << size;
  }
}

TEST(NmtBoot, TheBootUpGoesOnWhenASlaveIsSilentInTheMiddle) {
  NmtSlave with_dcf = slave(5);
  with_dcf.concise_dcf = dcf;
  Desk desk{{with_dcf}};
  desk.start();
  desk.take("705 00");
  desk.take(device_type);
  EXPECT_EQ(desk.pass(100ms), "605 80 0C 20 00 00 00 04 05");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 B"}));
  EXPECT_EQ(desk.told.results.back().index, 0x200C);
  EXPECT_EQ(desk.told.results.back().abort_code, AbortCode::timeout);
  EXPECT_EQ(desk.pass(1s), "000 80 05 | 605 40 00 10 00 00 00 00 00");
  EXPECT_EQ(desk.take(device_type), "605 21 0C 20 00 05 00 00 00");
}

// Reasons

TEST(NmtBoot, TellsTheExpectedAndTheSeenIdentity) {
  NmtSlave product = slave(5);
  product.product_code = 0x10001;
  Desk desk{{product}};
  desk.start();
  desk.take("705 00");
  desk.take(device_type);
  desk.take("585 43 18 10 02 01 00 02 00");
  const BootResult& result = desk.told.results.back();
  EXPECT_EQ(result.status, BootStatus::product_code);
  EXPECT_EQ(result.index, 0x1018);
  EXPECT_EQ(result.sub_index, 2);
  EXPECT_EQ(result.expected, 0x10001u);
  EXPECT_EQ(result.seen, 0x20001u);
  EXPECT_EQ(result.abort_code, canopen::ok);
}

TEST(NmtBoot, TellsThatANumberOfTheIdentityCannotBeRead) {
  NmtSlave product = slave(5);
  product.serial_number = 7;
  Desk desk{{product}};
  desk.start();
  desk.take("705 00");
  desk.take(device_type);
  desk.take("585 80 18 10 04 11 00 09 06");
  EXPECT_EQ(desk.told.results.back().status, BootStatus::serial_number);
  EXPECT_EQ(desk.told.results.back().abort_code, AbortCode::no_sub_index);
}

TEST(NmtBoot, TellsThatALossWillNotBeNoticed) {
  Desk desk{{slave(5), slave(6, 100)}};
  desk.start();
  desk.take("705 00");
  desk.take(device_type);
  desk.log();
  desk.master.configured(NodeId{5}, canopen::ok, desk.now);
  EXPECT_EQ(desk.log(), (Lines{"5 0", "5 not watched: no heartbeat time and no guard time in the network list"}));
}

TEST(NmtBoot, EveryEventAndStateHasAText) {
  for (int event = 0; event <= static_cast<int>(NmtMasterEvent::not_watched); ++event) {
    EXPECT_NE(to_text(static_cast<NmtMasterEvent>(event)), "unknown event");
  }
  EXPECT_EQ(to_text(static_cast<NmtMasterEvent>(99)), "unknown event");
  EXPECT_EQ(to_text(NmtState::initialisation), "initialisation");
  EXPECT_EQ(to_text(NmtState::stopped), "stopped");
  EXPECT_EQ(to_text(NmtState::operational), "operational");
  EXPECT_EQ(to_text(NmtState::pre_operational), "pre-operational");
  EXPECT_EQ(to_text(static_cast<NmtState>(6)), "unknown state");
}

// Two boot-up messages

TEST(NmtBoot, TheAnswerThatASecondBootUpLeavesOverIsNotTakenForAnother) {
  Desk desk{{slave(5)}};
  desk.start();
  EXPECT_EQ(desk.take("705 00"), "605 40 00 10 00 00 00 00 00");
  EXPECT_EQ(desk.take("705 00"), "605 80 00 10 00 22 00 00 08 | 605 40 00 10 00 00 00 00 00");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 boot-up"}));
  desk.take(device_type);  // the response to the first request
  Transfer write;
  const std::array<std::uint8_t, 1> value{1};
  EXPECT_TRUE(desk.master.request(NodeId{5}, write.write(0x2000, 1, value), desk.now));
  EXPECT_EQ(desk.bus.take(), "605 2F 00 20 01 01 00 00 00");
  EXPECT_EQ(desk.take(device_type), "") << "to the second one";
  EXPECT_EQ(write.calls, 0);
  desk.take("585 60 00 20 01 00 00 00 00");
  EXPECT_EQ(write.result, canopen::ok);
}

TEST(NmtBoot, ABootUpEndsWhatWasRequestedBefore) {
  Desk desk{{slave(5)}};
  desk.start();
  Transfer transfers[3];
  for (Transfer& transfer : transfers) {
    EXPECT_TRUE(desk.master.request(NodeId{5}, transfer.read(0x2001, 0), desk.now));
  }
  desk.bus.take();
  EXPECT_EQ(desk.take("705 00"), "605 80 01 20 00 22 00 00 08 | 605 40 00 10 00 00 00 00 00");
  for (const Transfer& transfer : transfers) {
    EXPECT_EQ(transfer.calls, 1);
    EXPECT_EQ(transfer.result, AbortCode::device_state);
  }
}

/// A transfer that configures a slave: its end is the end of the configuration.
struct Configuration {
  static void done(void* context, NodeId node_id, const SdoAnswer& answer) {
    auto& desk = *static_cast<Desk*>(context);
    desk.master.configured(node_id, answer.result, desk.now);
  }
  static SdoRequest write(Desk& desk, std::uint16_t index, std::span<const std::uint8_t> bytes) {
    SdoRequest request;
    request.index = index;
    request.download = true;
    request.bytes = bytes;
    request.done = done;
    request.context = &desk;
    return request;
  }
};

TEST(NmtBoot, AConfigurationThatABootUpEndsHasNotFailed) {
  Desk desk{{slave(5)}};
  desk.start();
  desk.take("705 00");
  desk.take(device_type);
  const std::array<std::uint8_t, 1> value{1};
  EXPECT_TRUE(desk.master.request(NodeId{5}, Configuration::write(desk, 0x2001, value), desk.now));
  EXPECT_EQ(desk.bus.take(), "605 2F 01 20 00 01 00 00 00");
  EXPECT_EQ(desk.take("705 00"), "605 80 01 20 00 22 00 00 08 | 605 40 00 10 00 00 00 00 00");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure", "5 boot-up"}));
  EXPECT_TRUE(desk.told.results.empty());
  desk.take(device_type);
  EXPECT_TRUE(desk.master.request(NodeId{5}, Configuration::write(desk, 0x2001, value), desk.now));
  desk.take("585 60 01 20 00 00 00 00 00");
  EXPECT_EQ(desk.log(),
            (Lines{"5 configure", "5 0", "5 not watched: no heartbeat time and no guard time in the network list",
                   "network started"}));
}

TEST(NmtBoot, ABootUpInTheMiddleOfTheConciseDcfBeginsItAnew) {
  NmtSlave listed = slave(5);
  listed.concise_dcf = dcf;
  Desk desk{{listed}};
  desk.start();
  desk.take("705 00");
  EXPECT_EQ(desk.take(device_type), "605 21 0C 20 00 05 00 00 00");
  EXPECT_EQ(desk.take("585 60 0C 20 00 00 00 00 00"), "605 05 68 65 6C 6C 6F 00 00");
  EXPECT_EQ(desk.take("705 00"), "605 80 0C 20 00 22 00 00 08 | 605 40 00 10 00 00 00 00 00");
  EXPECT_EQ(desk.take("585 20 00 00 00 00 00 00 00"), "") << "to the last segment before the reset";
  EXPECT_EQ(desk.take(device_type), "605 21 0C 20 00 05 00 00 00");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 boot-up"}));
}

// The queue

TEST(NmtBoot, TheApplicationAndTheMasterShareTheQueueOfANode) {
  Desk desk{{slave(5)}};
  desk.start();
  Transfer transfers[2];
  EXPECT_TRUE(desk.master.request(NodeId{5}, transfers[0].read(0x2001, 0), desk.now));
  EXPECT_TRUE(desk.master.request(NodeId{6}, transfers[1].read(0x2001, 0), desk.now));
  EXPECT_EQ(desk.bus.take(), "605 40 01 20 00 00 00 00 00 | 606 40 01 20 00 00 00 00 00") << "two nodes at once";
  EXPECT_EQ(desk.pass(99ms), "");
  EXPECT_EQ(desk.pass(1ms), "605 80 01 20 00 00 00 04 05 | 606 80 01 20 00 00 00 04 05");
  EXPECT_EQ(transfers[0].result, AbortCode::timeout);
  EXPECT_EQ(desk.take("705 00"), "605 40 00 10 00 00 00 00 00");
  Transfer next;
  EXPECT_TRUE(desk.master.request(NodeId{5}, next.read(0x2001, 0), desk.now));
  EXPECT_EQ(desk.bus.take(), "") << "the master asks";
  EXPECT_EQ(desk.take(device_type), "605 40 01 20 00 00 00 00 00");
}

TEST(NmtBoot, ABootUpWaitsForTheTransfersOfTheApplication) {
  Desk desk{{slave(5)}};
  desk.start();
  Transfer transfers[2];
  desk.pass(990ms);
  EXPECT_TRUE(desk.master.request(NodeId{5}, transfers[0].read(0x2001, 0), desk.now));
  EXPECT_EQ(desk.pass(10ms), "605 40 01 20 00 00 00 00 00");
  EXPECT_TRUE(desk.master.request(NodeId{5}, transfers[1].read(0x2001, 0), desk.now));
  EXPECT_EQ(desk.take("585 4F 01 20 00 01 00 00 00"), "605 40 00 10 00 00 00 00 00") << "its turn, as it came before";
  EXPECT_EQ(desk.take(device_type), "605 40 01 20 00 00 00 00 00");
}

TEST(NmtBoot, RefusesMoreRequestsThanFit) {
  Desk desk{{slave(5), slave(6)}};
  desk.start();
  Transfer transfers[6];
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(desk.master.request(NodeId{9}, transfers[i].read(0x2001, 0), desk.now)) << i;
  EXPECT_EQ(desk.master.request(NodeId{9}, transfers[4].read(0x2001, 0), desk.now).abort_code(), AbortCode::no_resource)
      << "three wait";
  EXPECT_EQ(transfers[4].calls, 0);
  desk.bus.take();
  EXPECT_EQ(desk.take("705 00"), "605 40 00 10 00 00 00 00 00") << "the master has its own places";
  desk.take("589 4F 01 20 00 01 00 00 00");
  EXPECT_EQ(transfers[0].result, canopen::ok);
  EXPECT_EQ(transfers[0].size, 1u);
  EXPECT_TRUE(desk.master.request(NodeId{9}, transfers[5].read(0x2001, 0), desk.now));
}

// A slave in Stopped

TEST(NmtBoot, ResetsASlaveThatTellsThatItIsStopped) {
  Desk desk{{slave(5, 100)}};
  desk.start();
  EXPECT_EQ(desk.take("705 04"), "000 82 05") << "it has missed the reset";
  EXPECT_EQ(desk.take("705 00"), "605 40 00 10 00 00 00 00 00");
}

// A full bus

TEST(NmtBoot, BootsWhenTheBusHasRoomAgainWhereverItHadNone) {
  for (std::size_t room = 0; room < 12; ++room) {
    SCOPED_TRACE(room);
    Desk desk{{slave(5, 100)}};
    desk.bus.room = room;
    desk.master.start(desk.now);
    bool configured = false;
    const auto step = [&](const char* text) {
      desk.master.on_frame(bench::frame(text), desk.now);
      if (!configured && !desk.told.log.empty() && desk.told.log.back() == "5 configure") {
        desk.master.configured(NodeId{5}, canopen::ok, desk.now);
        configured = true;
      }
    };
    const auto run = [&] {
      for (const char* text :
           {"705 00", device_type, "585 4B 17 10 00 00 00 00 00", "585 60 17 10 00 00 00 00 00", "705 7F"}) {
        step(text);
        desk.pass(1ms);
      }
    };
    run();
    desk.bus.room = 1'000'000;
    configured = false;
    desk.pass(1ms);
    run();
    EXPECT_TRUE(desk.master.network_started());
    EXPECT_EQ(desk.master.status(NodeId{5}), BootStatus::booted);
  }
}

}  // namespace
