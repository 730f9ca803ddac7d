/// The boot-up of slaves by an NMT master in the cases that occur in a plant: heartbeats, slaves that are silent,
/// stopped or replaced, and a full bus.
#include <gtest/gtest.h>
#include <canopen/nmt_master/nmt_master.hpp>

#include <string>
#include <vector>

#include "nmt_boot_bench.hpp"
#include "support/bench.hpp"

namespace {

using boot_bench::Desk;
using boot_bench::device_type;
using boot_bench::Host;
using boot_bench::slave;
using boot_bench::Told;
using canopen::AbortCode;
using canopen::BootResult;
using canopen::BootStatus;
using canopen::NmtMasterEvent;
using canopen::NmtSlave;
using canopen::NmtState;
using canopen::NodeId;
using canopen::TimePoint;
using namespace std::chrono_literals;
using Lines = std::vector<std::string>;

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
  EXPECT_EQ(desk.beat(3, 150ms), "000 01 05") << "its rate has been measured";
  EXPECT_EQ(desk.pass(299ms), "");
  EXPECT_EQ(desk.log(), (Lines{"5 boot-up", "5 configure", "5 0", "network started"}));
}

TEST(NmtBoot, ASlaveThatKeepsAHeartbeatTimeInTimeMayRefuseAnother) {
  Desk desk{{slave(5, 300)}};
  EXPECT_EQ(ask_for_heartbeat_time(desk, "585 4B 17 10 00 FA 00 00 00"), "605 2B 17 10 00 96 00 00 00");
  EXPECT_EQ(desk.take("585 80 17 10 00 02 00 01 06"), "");
  EXPECT_EQ(desk.beat(3, 250ms), "000 01 05");
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
  EXPECT_EQ(desk.pass(19ms), "") << "a late response would be a fault";
  EXPECT_EQ(desk.pass(1ms), "000 01 05");
  EXPECT_EQ(desk.log(), (Lines{"5 0", "5 not watched: no heartbeat time and no guard time in the network list"}));
}

TEST(NmtBoot, EveryEventAndStateHasAText) {
  for (int event = 0; event <= static_cast<int>(NmtMasterEvent::restarted); ++event) {
    EXPECT_NE(to_text(static_cast<NmtMasterEvent>(event)), "unknown event");
  }
  EXPECT_EQ(to_text(static_cast<NmtMasterEvent>(99)), "unknown event");
  EXPECT_EQ(to_text(NmtState::initialisation), "initialisation");
  EXPECT_EQ(to_text(NmtState::stopped), "stopped");
  EXPECT_EQ(to_text(NmtState::operational), "operational");
  EXPECT_EQ(to_text(NmtState::pre_operational), "pre-operational");
  EXPECT_EQ(to_text(static_cast<NmtState>(6)), "unknown state");
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
    struct Response {
      const char* request;
      const char* response;
    };
    constexpr Response responses[] = {{"605 40 00 10 00", device_type},
                                      {"605 40 17 10 00", "585 4B 17 10 00 00 00 00 00"},
                                      {"605 2B 17 10 00", "585 60 17 10 00 00 00 00 00"}};
    const auto run = [&] {
      step("705 00");
      for (int time = 0; time < 500; ++time) {
        const std::string sent = desk.pass(1ms);
        for (const Response& row : responses) {
          if (sent.find(row.request) != std::string::npos) step(row.response);
        }
        if (time % 50 == 49) step("705 7F");
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
