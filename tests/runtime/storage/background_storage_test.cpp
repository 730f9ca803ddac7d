/// "save" to a flash that is slow: the node works meanwhile, and answers when the parameters are stored.
#include <gtest/gtest.h>

#include <canopen/storage/background_storage.hpp>
#include <canopen/storage/flash_storage.hpp>
#include <every_service/device.hpp>
#include <stored_device/device.hpp>

#include <algorithm>

#include "flash_emulation.hpp"
#include "parameter_storage_bench.hpp"
#include "support/bench.hpp"

namespace {

using canopen::BackgroundStorage;
using canopen::FlashStorage;
using canopen::TimePoint;
using storage_bench::change;
using storage_bench::defaults;
using storage_bench::load_all;
using storage_bench::loaded_all;
using storage_bench::Ranges;
using storage_bench::ranges;
using storage_bench::save_all;
using storage_bench::saved_all;
namespace od = stored_device::od;
using namespace std::chrono_literals;

constexpr Ranges changed{0x800, 7, 8, 9};
constexpr auto store_busy = "585 80 10 10 01 22 00 00 08";

/// An erase takes 40 ms, in which the flash is not ready; a word takes no time.
struct SlowFlash {
  using Cells = bench::FlashEmulation<1024, 8>;
  static constexpr std::uint32_t page_size = Cells::page_size;
  static constexpr std::uint32_t word_size = Cells::word_size;

  [[nodiscard]] bool ready() const { return *now >= erased_at; }
  [[nodiscard]] bool erase(std::uint8_t page) {
    erased_at = *now + 40ms;
    return cells.erase(page);
  }
  [[nodiscard]] bool write(std::uint8_t page, std::uint32_t offset, std::span<const std::uint8_t> words) {
    misused = misused || !ready();
    written += static_cast<std::uint32_t>(words.size());
    return cells.write(page, offset, words);
  }
  [[nodiscard]] bool read(std::uint8_t page, std::uint32_t offset, std::span<std::uint8_t> to) const {
    return cells.read(page, offset, to);
  }

  Cells cells;
  const TimePoint* now = nullptr;
  TimePoint erased_at{};
  std::uint32_t written = 0;  ///< bytes
  bool misused = false;       ///< used while it is not ready
};

struct CountSteps {
  int* steps;
  void operator()() const { ++*steps; }
};

constexpr std::uint32_t step_size = 16;
using Background = BackgroundStorage<FlashStorage<SlowFlash>, 768, step_size, CountSteps>;

struct Memory {
  SlowFlash pages;
  TimePoint power_on{};
  FlashStorage<SlowFlash> flash{pages};
  int steps = 0;
  Background storage{flash, CountSteps{&steps}};
  Memory() { pages.now = &power_on; }
};

/// The time of the flash is that of the device.
struct Device {
  explicit Device(Memory& given) : memory{given}, device{canopen::stored_in(given.storage)} {
    memory.pages.now = &device.now;
    memory.pages.erased_at = {};
  }
  ~Device() { memory.pages.now = &memory.power_on; }
  Memory& memory;
  bench::Bench<stored_device::Device, canopen::StoredIn<Background>> device;
};

TEST(BackgroundStorage, TheResponseToSaveComesWhenTheParametersAreStored) {
  Memory memory;
  {
    Device slow{memory};
    change(slow.device);
    slow.device.bus.take();
    EXPECT_EQ(slow.device.ask(save_all), "");
    slow.device.node.on_time(slow.device.now);
    EXPECT_TRUE(memory.storage.busy());
    EXPECT_EQ(memory.pages.cells.erased[0], 1);
    EXPECT_FALSE(memory.pages.ready());
    std::string sent;
    while (memory.storage.busy()) sent += slow.device.pass(1ms);
    EXPECT_GE(slow.device.now, TimePoint{40ms});
    EXPECT_NE(sent.find(saved_all), std::string::npos);
    EXPECT_FALSE(memory.pages.misused);
  }
  Device next{memory};
  EXPECT_EQ(ranges(next.device), changed);
}

TEST(BackgroundStorage, FramesAreAnsweredMeanwhile) {
  Memory memory;
  Device slow{memory};
  slow.device.ask("605 2B 17 10 00 0A 00 00 00");  // heartbeat each 10 ms
  slow.device.pass(10ms);
  EXPECT_EQ(slow.device.ask(save_all), "");
  int heartbeats = 0;
  while (memory.storage.busy()) {
    const std::string sent = slow.device.pass(1ms);
    if (sent.find("705 7F") != std::string::npos) ++heartbeats;
    if (memory.storage.busy()) {
      EXPECT_EQ(sent.find("585"), std::string::npos);
    }
  }
  EXPECT_GE(heartbeats, 3);
  EXPECT_EQ(slow.device.ask(save_all), "");
  EXPECT_EQ(slow.device.ask("000 01 05"), "185 00 00");
  EXPECT_EQ(slow.device.node.state(), canopen::NmtState::operational);
  EXPECT_EQ(slow.device.ask("000 80 05"), "");
  EXPECT_EQ(slow.device.node.state(), canopen::NmtState::pre_operational);
  EXPECT_TRUE(memory.storage.busy());
}

TEST(BackgroundStorage, EachOnTimeWritesOneStep) {
  Memory memory;
  Device slow{memory};
  EXPECT_EQ(slow.device.ask(save_all), "");
  int calls = 0;
  for (; memory.storage.busy(); ++calls) {
    const std::uint32_t before = memory.pages.written;
    slow.device.node.on_time(slow.device.now);
    if (!memory.storage.busy()) break;  // the last word and the header
    EXPECT_LE(memory.pages.written - before, step_size);
    if (const auto deadline = slow.device.node.next_deadline()) slow.device.now = std::max(slow.device.now, *deadline);
  }
  EXPECT_GT(calls, 4);
  EXPECT_GT(memory.steps, 4);
  EXPECT_EQ(slow.device.bus.take(), saved_all);
}

TEST(BackgroundStorage, StoresTheValuesAtTheTimeOfTheCommand) {
  Memory memory;
  {
    Device slow{memory};
    change(slow.device);
    slow.device.bus.take();
    slow.device.ask(save_all);
    slow.device.pass(1ms);
    EXPECT_EQ(slow.device.node.set<od::gain>(77), canopen::ok);
    slow.device.pass(1s);
    EXPECT_FALSE(memory.storage.busy());
  }
  Device next{memory};
  EXPECT_EQ(ranges(next.device), changed);
}

TEST(BackgroundStorage, AMediumThatFailsIsReportedByTheResponse) {
  Memory memory;
  Device slow{memory};
  slow.device.ask(save_all);
  memory.pages.cells.last_step = 3;
  EXPECT_NE(slow.device.pass(1s).find("585 80 10 10 01 00 00 06 06"), std::string::npos);
  EXPECT_TRUE(memory.storage.failed());
  memory.pages.cells.power_on();
  slow.device.ask(load_all);  // nothing is stored: there is nothing to do
  EXPECT_EQ(slow.device.node.next_deadline(), std::nullopt);
}

TEST(BackgroundStorage, ASecondCommandIsRejectedWhileTheFirstOneRuns) {
  Memory memory;
  Device slow{memory};
  slow.device.ask(save_all);
  slow.device.pass(1ms);
  EXPECT_EQ(slow.device.ask(save_all), store_busy);
  EXPECT_EQ(slow.device.node.save(), canopen::AbortCode::device_state);
  // The client of the second command does not wait for the first one.
  EXPECT_EQ(slow.device.pass(1s), "");
  EXPECT_EQ(slow.device.node.save(), canopen::ok);
  EXPECT_TRUE(memory.storage.busy());
  EXPECT_EQ(slow.device.pass(1s), "");
  EXPECT_FALSE(memory.storage.failed());
}

TEST(BackgroundStorage, ASaveOfTheApplicationBeginsWhileTheNodeIsIdle) {
  Memory memory;
  Device slow{memory};
  const auto finish = [&] {
    for (int i = 0; i < 200 && memory.storage.busy(); ++i) {
      slow.device.now = slow.device.now + 1ms;
      slow.device.node.on_time(slow.device.now);
    }
    return !memory.storage.busy();
  };
  const auto idle = [&] {
    for (int i = 0; i < 3; ++i) slow.device.node.on_time(slow.device.now);
  };
  idle();
  EXPECT_EQ(slow.device.node.save(), canopen::ok);
  EXPECT_TRUE(finish());
  idle();
  EXPECT_EQ(slow.device.node.restore(), canopen::ok);
  EXPECT_TRUE(memory.storage.busy());
  EXPECT_TRUE(finish());
}

TEST(BackgroundStorage, AnotherClientIsAnsweredMeanwhile) {
  SlowFlash pages;
  FlashStorage<SlowFlash> flash{pages};
  BackgroundStorage<FlashStorage<SlowFlash>, 2048> storage{flash};
  bench::Bench<every_service::Device, canopen::StoredIn<decltype(storage)>> device{canopen::stored_in(storage)};
  pages.now = &device.now;
  device.ask("605 23 01 12 01 A5 06 00 00");
  device.ask("605 23 01 12 02 B5 06 00 00");
  device.bus.take();
  EXPECT_EQ(device.ask(save_all), "");
  EXPECT_EQ(device.ask("6A5 40 18 10 00 00 00 00 00"), "6B5 4F 18 10 00 04 00 00 00");
  EXPECT_EQ(device.ask("6A5 23 10 10 01 73 61 76 65"), "6B5 80 10 10 01 22 00 00 08");
  EXPECT_TRUE(storage.busy());
  EXPECT_NE(device.pass(1s).find(saved_all), std::string::npos);
  EXPECT_EQ(device.ask("6A5 23 10 10 01 73 61 76 65"), "");
  EXPECT_NE(device.pass(1s).find("6B5 60 10 10 01 00 00 00 00"), std::string::npos);
}

TEST(BackgroundStorage, AClientThatAbortsGetsNoResponse) {
  Memory memory;
  {
    Device slow{memory};
    change(slow.device);
    slow.device.ask(save_all);
    slow.device.bus.take();
    EXPECT_EQ(slow.device.ask("605 80 10 10 01 00 00 04 05"), "");
    EXPECT_EQ(slow.device.ask("605 40 17 10 00 00 00 00 00"), "585 4B 17 10 00 00 08 00 00");
    EXPECT_EQ(slow.device.pass(1s).find("585"), std::string::npos);
  }
  Device next{memory};
  EXPECT_EQ(ranges(next.device), changed);
}

TEST(BackgroundStorage, AResetWaitsForTheImage) {
  Memory memory;
  memory.pages.now = &memory.power_on;
  bench::Bench<stored_device::Device, canopen::StoredIn<Background>> device{canopen::stored_in(memory.storage)};
  change(device);
  device.ask(save_all);  // the time of this flash stays 0: its erase must not be waited for
  device.node.on_time(device.now);
  memory.power_on = TimePoint{1s};
  device.bus.take();
  EXPECT_EQ(device.ask(bench::reset_node), "705 00");
  EXPECT_FALSE(memory.storage.busy());
  EXPECT_EQ(ranges(device), changed);
  EXPECT_EQ(device.pass(0ms), "");
}

/// Ready after it has been asked ten times.
struct PatientFlash : SlowFlash::Cells {
  int asked = 10;
  [[nodiscard]] bool ready() { return asked == 10 || ++asked == 10; }
  [[nodiscard]] bool erase(std::uint8_t page) {
    asked = 0;
    return SlowFlash::Cells::erase(page);
  }
  [[nodiscard]] bool write(std::uint8_t page, std::uint32_t offset, std::span<const std::uint8_t> words) {
    return asked == 10 && SlowFlash::Cells::write(page, offset, words);
  }
};

TEST(FlashStorage, WaitsForAnEraseThatHasOnlyBeenStarted) {
  PatientFlash pages;
  FlashStorage<PatientFlash> storage{pages};
  auto device = bench::with<stored_device::Device>(canopen::stored_in(storage));
  EXPECT_EQ(device.ask(save_all), saved_all);
  EXPECT_EQ(pages.erased[0], 1);
}

/// Does not become ready again after an erase.
struct StuckFlash : SlowFlash::Cells {
  static constexpr std::uint32_t max_polls = 1000;
  std::uint32_t polls = 0;
  [[nodiscard]] bool ready() {
    if (erased[0] + erased[1] == 0) return true;
    ++polls;
    return false;
  }
};

constexpr auto hardware_error = "585 80 10 10 01 00 00 06 06";

TEST(FlashStorage, FailsIfAnEraseDoesNotEnd) {
  StuckFlash pages;
  FlashStorage<StuckFlash> storage{pages};
  auto device = bench::with<stored_device::Device>(canopen::stored_in(storage));
  EXPECT_EQ(device.ask(save_all), hardware_error);
  EXPECT_EQ(pages.polls, StuckFlash::max_polls + 1);
}

TEST(BackgroundStorage, AResetDoesNotWaitForAnEraseThatDoesNotEnd) {
  StuckFlash pages;
  FlashStorage<StuckFlash> flash{pages};
  int steps = 0;
  BackgroundStorage<FlashStorage<StuckFlash>, 768, step_size, CountSteps> storage{flash, CountSteps{&steps}};
  auto device = bench::with<stored_device::Device>(canopen::stored_in(storage));
  change(device);
  device.ask(save_all);
  device.pass(1s);
  EXPECT_TRUE(storage.busy());
  device.bus.take();
  steps = 0;
  EXPECT_EQ(device.ask(bench::reset_node), "705 00");
  EXPECT_FALSE(storage.busy());
  EXPECT_TRUE(storage.failed());
  EXPECT_EQ(steps, static_cast<int>(StuckFlash::max_polls));  // the watchdog is served meanwhile
}

TEST(BackgroundStorage, APowerLossLeavesTheOldValuesOrTheNewOnes) {
  for (int last = 0; last < 100; ++last) {
    Memory memory;
    {
      Device slow{memory};
      change(slow.device);
      slow.device.ask(save_all);
      slow.device.pass(1s);
      ASSERT_EQ(slow.device.node.set<od::gain>(1), canopen::ok);
      memory.pages.cells.last_step = memory.pages.cells.steps + last;
      slow.device.ask(save_all);
      slow.device.pass(1s);
    }
    const bool complete = memory.pages.cells.has_power();
    memory.pages.cells.power_on();
    Device next{memory};
    const int gain = next.device.node.get<od::gain>();
    ASSERT_TRUE(gain == 1 || (gain == changed.manufacturer && !complete)) << last;
    if (complete) return;
  }
  FAIL() << "more than 100 steps";
}

TEST(BackgroundStorage, RestoresDefaultsInSteps) {
  Memory memory;
  {
    Device slow{memory};
    change(slow.device);
    slow.device.ask(save_all);
    slow.device.pass(1s);
    EXPECT_EQ(slow.device.ask(load_all), "");
    EXPECT_NE(slow.device.pass(1s).find(loaded_all), std::string::npos);
  }
  Device next{memory};
  EXPECT_EQ(ranges(next.device), defaults);
}

}  // namespace
