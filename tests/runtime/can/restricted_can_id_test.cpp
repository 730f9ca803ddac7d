/// CAN-IDs that CiA 301 restricts (7.3.5, table 41): whatever the object dictionary contains, no service with a
/// configurable COB-ID transmits or receives on them.
#include <gtest/gtest.h>

#include <canopen/node/accepted_frames.hpp>
#include <cstring>
#include <every_service/device.hpp>
#include <settable_sdo/device.hpp>
#include <vector>

#include "support/bench.hpp"

namespace {

using canopen::NodeId;
using namespace std::chrono_literals;
namespace od = every_service::od;

/// First and last of each row of the table, and the CAN-IDs of this node's own fixed services.
constexpr std::uint32_t restricted[] = {0x000, 0x001, 0x07F, 0x101, 0x180, 0x581, 0x585, 0x5FF, 0x601,
                                        0x605, 0x67F, 0x6E0, 0x6FF, 0x701, 0x705, 0x77F, 0x780, 0x7FF};

struct Entry {
  std::uint16_t index;
  std::uint8_t sub_index;
  std::uint32_t flags;  ///< bits that activate the service
};

constexpr std::uint32_t produces = 0x4000'0000;
constexpr std::uint32_t consumes = 0x8000'0000;

constexpr Entry sent[] = {
    {0x1005, 0, produces}, {0x1012, 0, produces}, {0x1014, 0, 0}, {0x1800, 1, 0},
    {0x1801, 1, 0},        {0x1802, 1, 0},        {0x1803, 1, 0},
};

struct Seen {
  int syncs = 0;
  int times = 0;
  int emergencies = 0;
};

template <class... Handlers>
struct Device : bench::Bench<every_service::Device, Handlers...> {
  explicit Device(Handlers... handlers) : bench::Bench<every_service::Device, Handlers...>{std::move(handlers)...} {}

  /// Writes a number to the memory of an object, as a stored value or a default value of the EDS would be written.
  void put(std::uint16_t index, std::uint8_t sub_index, std::uint32_t value) {
    const canopen::EntryAccess entries = this->node.entries();
    std::memcpy(entries.ram(entries.find(index, sub_index)), &value, sizeof value);
  }

  /// Makes every service send everything that it can.
  std::string use() {
    std::string log = this->ask("000 01 05");
    this->node.template set<od::byte>(static_cast<std::uint8_t>(++count_));
    this->node.emergency(0x1000, canopen::ErrorRegister::generic);
    static_cast<void>(this->node.send_mpdo({NodeId{7}, 0x2000, 0}, 1));
    static_cast<void>(this->node.send_time({}));
    log += this->pass(1ms);
    log += this->ask("080");
    log += this->pass(50ms);
    this->node.emergency_over(canopen::ErrorRegister::generic);
    return log + this->pass(1ms);
  }

  int count_ = 0;
};

std::string can_id_text(std::uint32_t id) { return bench::text({.id = id}); }

bool occurs(const std::string& log, std::uint32_t id) {
  return log.starts_with(can_id_text(id)) || log.find("| " + can_id_text(id)) != std::string::npos;
}

TEST(RestrictedCanId, NothingIsSentOnOneThatStandsInTheDictionary) {
  for (const Entry& entry : sent) {
    for (const std::uint32_t id : restricted) {
      Device<> device;
      device.put(0x1006, 0, 10'000);
      device.put(entry.index, entry.sub_index, id | entry.flags);
      EXPECT_FALSE(occurs(device.use(), id)) << std::hex << entry.index << ": " << id;
    }
  }
}

TEST(RestrictedCanId, NothingIsSentOnOneThatComesInOperational) {
  for (const Entry& entry : sent) {
    for (const std::uint32_t id : restricted) {
      Device<> device;
      device.put(0x1006, 0, 10'000);
      device.put(0x1005, 0, produces | 0x80);
      device.use();
      device.put(entry.index, entry.sub_index, id | entry.flags);
      EXPECT_FALSE(occurs(device.use(), id)) << std::hex << entry.index << ": " << id;
    }
  }
}

TEST(RestrictedCanId, TheApplicationCanSetNone) {
  for (const Entry& entry : sent) {
    for (const std::uint32_t id : restricted) {
      Device<> device;
      device.put(0x1006, 0, 10'000);
      const std::uint32_t value = id | entry.flags;
      std::array<std::uint8_t, 4> bytes;
      std::memcpy(bytes.data(), &value, sizeof value);
      static_cast<void>(device.node.set(entry.index, entry.sub_index, bytes));
      EXPECT_FALSE(occurs(device.use(), id)) << std::hex << entry.index << ": " << id;
    }
  }
}

TEST(RestrictedCanId, OthersAreUsed) {
  for (const std::uint32_t id : {0x080u, 0x100u, 0x181u, 0x580u, 0x600u, 0x680u, 0x6DFu, 0x700u}) {
    Device<> device;
    device.put(0x1800, 1, id);
    EXPECT_TRUE(occurs(device.use(), id)) << std::hex << id;
  }
}

TEST(RestrictedCanId, OfASyncProducerLeavesTheNodeWithoutDeadline) {
  Device<> device;
  device.put(0x1006, 0, 10'000);
  device.put(0x1005, 0, produces);
  device.ask(bench::start);
  EXPECT_EQ(device.pass(50ms), "");
}

TEST(RestrictedCanId, HasNoReceiver) {
  for (const std::uint32_t id : restricted) {
    if (id == 0 || id == 0x605) continue;  // NMT and the default SDO receive these frames
    Seen seen;
    Device device{canopen::on_sync([&](std::uint8_t) { ++seen.syncs; }),
                  canopen::on_time_of_day([&](canopen::TimeOfDay) { ++seen.times; }),
                  canopen::on_emergency([&](const canopen::ConsumedEmergency&) { ++seen.emergencies; })};
    device.put(0x1005, 0, id);
    device.put(0x1012, 0, id | consumes);
    device.put(0x1028, 1, id);
    device.put(0x1201, 1, id);
    device.put(0x1201, 2, 0x5C0 - 0x100);
    device.put(0x1400, 1, id);
    device.put(0x1800, 1, id);
    device.ask(bench::start);
    EXPECT_EQ(device.ask(can_id_text(id) + " 40 34 12 00 00 00 00 00"), "") << std::hex << id;
    EXPECT_EQ(device.ask(can_id_text(id)), "") << std::hex << id;
    if (id != 0x705) {  // node guarding
      EXPECT_EQ(device.ask(can_id_text(id) + " R 0"), "") << std::hex << id;
    }
    EXPECT_EQ(device.node.template get<od::byte>(), 0) << std::hex << id;
    EXPECT_EQ(seen.syncs + seen.times + seen.emergencies, 0) << std::hex << id;
    int accepted = 0;
    canopen::for_each_accepted_frame(device.node, [&](const canopen::AcceptedFrame& frame) {
      if (frame.id == id && !frame.remote) ++accepted;
    });
    EXPECT_EQ(accepted, 0) << std::hex << id;
  }
}

TEST(RestrictedCanId, OfAnRpdoTakesNoNmtCommandForIt) {
  Device<> device;
  device.put(0x1400, 1, 0);
  device.ask(bench::start);
  device.ask("000 80 05 00 00");
  EXPECT_EQ(device.node.get<od::byte>(), 0);
  EXPECT_EQ(device.node.state(), canopen::NmtState::pre_operational);
}

// SDO servers

constexpr auto read_device_type = " 40 00 10 00 00 00 00 00";

TEST(SecondSdoServer, DoesNotExistWithARestrictedCobId) {
  for (const std::uint32_t id : restricted) {
    Device<> device;
    device.put(0x1201, 1, id);
    device.put(0x1201, 2, 0x4C0);
    if (id != 0x605) {
      EXPECT_EQ(device.ask(can_id_text(id) + read_device_type), "") << std::hex << id;
    }
    device.put(0x1201, 1, 0x540);
    device.put(0x1201, 2, id);
    EXPECT_EQ(device.ask(std::string{"540"} + read_device_type), "") << std::hex << id;
  }
}

/// `0` in 1201h:01 is the CAN-ID of NMT: "01 05" is a start command, not a request.
TEST(SecondSdoServer, LeavesNmtCommandsAlone) {
  Device<> device;
  device.put(0x1201, 1, 0);
  device.put(0x1201, 2, 0);
  EXPECT_EQ(device.ask(bench::start).find("000"), std::string::npos);
  EXPECT_EQ(device.node.state(), canopen::NmtState::operational);
}

TEST(SecondSdoServer, NeedsBothOfItsCobIds) {
  Device<> device;
  device.put(0x1201, 1, 0x540);
  EXPECT_EQ(device.ask(std::string{"540"} + read_device_type), "");
}

TEST(SecondSdoServer, LosesItsAnswerWithItsCobId) {
  Device<> device;
  device.put(0x1201, 1, 0x540);
  device.put(0x1201, 2, 0x4C0);
  device.bus.room = 0;
  device.ask(std::string{"540"} + read_device_type);
  device.put(0x1201, 2, 0);
  device.bus.room = 100;
  EXPECT_EQ(device.pass(1ms), "");
  EXPECT_EQ(device.ask(std::string{"605"} + read_device_type), "585 43 00 10 00 00 00 00 00");
}

TEST(DefaultSdoServer, HasItsCanIdsWhatever1200hSays) {
  bench::Bench<settable_sdo::Device> device;
  for (const std::uint32_t value : {0u, 0x8000'0000u, 0x606u, 0x640u}) {
    const canopen::EntryAccess entries = device.node.entries();
    for (const std::uint8_t sub_index : {std::uint8_t{1}, std::uint8_t{2}}) {
      std::memcpy(entries.ram(entries.find(0x1200, sub_index)), &value, sizeof value);
    }
    EXPECT_EQ(device.ask("605 40 00 10 00 00 00 00 00"), "585 43 00 10 00 00 00 00 00") << std::hex << value;
    EXPECT_EQ(device.ask("640 40 00 10 00 00 00 00 00"), "") << std::hex << value;
  }
}

}  // namespace
