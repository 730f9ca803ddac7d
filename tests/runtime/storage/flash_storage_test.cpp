/// Two pages of flash: values survive a power loss at any moment.
#include <gtest/gtest.h>
#include <canopen/storage/flash_storage.hpp>

#include <canopen/base/crc16.hpp>
#include <memory>
#include <stored_device/device.hpp>
#include <string_view>

#include "flash_emulation.hpp"
#include "support/bench.hpp"

namespace {

namespace od = stored_device::od;
using canopen::StorageState;

TEST(Crc16, HasTheCheckValueOfItsPolynomial) {
  std::uint16_t crc = 0;
  std::uint16_t crc_from_ones = 0xFFFF;
  for (const char c : std::string_view{"123456789"}) {
    crc = canopen::crc16_ccitt(crc, static_cast<std::uint8_t>(c));
    crc_from_ones = canopen::crc16_ccitt(crc_from_ones, static_cast<std::uint8_t>(c));
  }
  EXPECT_EQ(crc, 0x31C3);
  EXPECT_EQ(crc_from_ones, 0x29B1);
  static constexpr std::uint8_t nine[] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  static_assert(canopen::crc16_ccitt(0, std::span<const std::uint8_t>{nine}) == 0x31C3);
}

template <class Flash>
bool put(canopen::FlashStorage<Flash>& storage, std::span<const std::uint8_t> image) {
  if (!storage.begin(static_cast<std::uint32_t>(image.size()))) return false;
  for (std::size_t i = 0; i < image.size(); i += 3) {
    if (!storage.write(image.subspan(i, std::min<std::size_t>(3, image.size() - i)))) return false;
  }
  return storage.commit();
}

template <class Flash>
std::vector<std::uint8_t> get(const canopen::FlashStorage<Flash>& storage) {
  std::vector<std::uint8_t> image(storage.size());
  EXPECT_TRUE(storage.read(0, image));
  return image;
}

std::vector<std::uint8_t> image_of(std::size_t size, std::uint8_t first) {
  std::vector<std::uint8_t> image(size);
  for (std::size_t i = 0; i < size; ++i) image[i] = static_cast<std::uint8_t>(first + i);
  return image;
}

template <class Flash>
class FlashStorageOf : public testing::Test {};
using WordSizes =
    testing::Types<bench::FlashEmulation<256, 1>, bench::FlashEmulation<256, 2>, bench::FlashEmulation<256, 4>,
                   bench::FlashEmulation<256, 8>, bench::FlashEmulation<256, 32>>;
TYPED_TEST_SUITE(FlashStorageOf, WordSizes);

TYPED_TEST(FlashStorageOf, IsEmptyWhenThePagesAreErased) {
  TypeParam flash;
  canopen::FlashStorage storage{flash};
  EXPECT_EQ(storage.open(), StorageState::empty);
  EXPECT_EQ(storage.size(), 0u);
  EXPECT_EQ(storage.erasures(), 0u);
}

TYPED_TEST(FlashStorageOf, TakesNotMoreBytesThanTheAnnouncedSize) {
  TypeParam flash;
  canopen::FlashStorage storage{flash};
  static_cast<void>(storage.open());
  const auto image = image_of(5, 1);
  ASSERT_TRUE(storage.begin(5));
  EXPECT_FALSE(storage.write(image_of(6, 1))) << "more than all";
  ASSERT_TRUE(storage.write(std::span{image}.first(3)));
  EXPECT_FALSE(storage.write(image_of(3, 1))) << "more than the rest";
  EXPECT_FALSE(storage.commit()) << "it is not whole";
  ASSERT_TRUE(storage.write(std::span{image}.subspan(3)));
  EXPECT_FALSE(storage.write(image_of(1, 1)));
  EXPECT_TRUE(storage.commit());
  EXPECT_EQ(get(storage), image);
}

TYPED_TEST(FlashStorageOf, TakesNoImageThatAPageHasNoRoomFor) {
  TypeParam flash;
  canopen::FlashStorage storage{flash};
  static_cast<void>(storage.open());
  const std::uint32_t header = std::max(12u, TypeParam::word_size);
  const std::uint32_t words = (header + TypeParam::word_size - 1) / TypeParam::word_size;
  const std::uint32_t room = 256 - 2 * words * TypeParam::word_size;  // a header and its copy
  EXPECT_FALSE(storage.begin(room + 1));
  EXPECT_EQ(flash.erased[0] + flash.erased[1], 0);
  EXPECT_TRUE(put(storage, image_of(room, 1)));
  EXPECT_EQ(get(storage), image_of(room, 1));
}

/// A flipped bit in the newest image is not a power loss; a power loss would leave a bad header.
TYPED_TEST(FlashStorageOf, ReportsADamagedImageThatIsNewerThanTheOther) {
  TypeParam flash;
  const auto old_image = image_of(20, 1);
  const auto new_image = image_of(20, 100);
  canopen::FlashStorage storage{flash};
  static_cast<void>(storage.open());
  EXPECT_TRUE(put(storage, old_image));  // page 0
  EXPECT_TRUE(put(storage, new_image));  // page 1
  const std::uint32_t begin = std::max(12u, TypeParam::word_size);
  const std::uint32_t image_at = (begin + TypeParam::word_size - 1) / TypeParam::word_size * TypeParam::word_size;
  for (std::uint32_t bit = 0; bit < 20 * 8; ++bit) {
    TypeParam copy = flash;
    copy.pages[1].at(image_at + bit / 8) ^= static_cast<std::uint8_t>(1u << bit % 8);
    canopen::FlashStorage damaged{copy};
    EXPECT_EQ(damaged.open(), StorageState::damaged) << bit;
    EXPECT_EQ(get(damaged), old_image) << bit;
    EXPECT_TRUE(put(damaged, new_image));
    canopen::FlashStorage mended{copy};
    EXPECT_EQ(mended.open(), StorageState::whole) << bit;
    EXPECT_EQ(get(mended), new_image) << bit;
  }
}

/// One damaged header is replaced by its copy; if both are damaged, the older image does not pass for the newest one.
TYPED_TEST(FlashStorageOf, ReportsADamagedHeaderUnlessItsCopyIsGood) {
  TypeParam flash;
  canopen::FlashStorage storage{flash};
  static_cast<void>(storage.open());
  EXPECT_TRUE(put(storage, image_of(20, 1)));
  EXPECT_TRUE(put(storage, image_of(20, 100)));
  const std::uint32_t words = (12 + TypeParam::word_size - 1) / TypeParam::word_size;
  const std::uint32_t copy_at = 256 - words * TypeParam::word_size;
  for (std::uint32_t bit = 0; bit < 12 * 8; ++bit) {
    for (const bool copy_too : {false, true}) {
      TypeParam copy = flash;
      copy.pages[1].at(bit / 8) ^= static_cast<std::uint8_t>(1u << bit % 8);
      if (copy_too) copy.pages[1].at(copy_at + bit / 8) ^= static_cast<std::uint8_t>(1u << bit % 8);
      canopen::FlashStorage damaged{copy};
      EXPECT_EQ(damaged.open(), copy_too ? StorageState::damaged : StorageState::whole) << bit;
      EXPECT_EQ(get(damaged), image_of(20, copy_too ? 1 : 100)) << bit;
    }
  }
}

/// Power was lost while the older page was being erased, its image before its header.
TYPED_TEST(FlashStorageOf, PassesOverADamagedImageThatIsOlder) {
  TypeParam flash;
  canopen::FlashStorage storage{flash};
  static_cast<void>(storage.open());
  EXPECT_TRUE(put(storage, image_of(20, 1)));
  EXPECT_TRUE(put(storage, image_of(20, 100)));
  for (std::size_t at = 64; at < 256; ++at) flash.pages[0][at] = 0xFF;
  flash.pages[0][TypeParam::word_size >= 16 ? 32 : 16] = 0xFF;
  canopen::FlashStorage again{flash};
  EXPECT_EQ(again.open(), StorageState::whole);
  EXPECT_EQ(get(again), image_of(20, 100));
}

TYPED_TEST(FlashStorageOf, KeepsImagesOfAnyLength) {
  TypeParam flash;
  for (const std::size_t size : {std::size_t{1}, std::size_t{7}, std::size_t{16}, std::size_t{33}, std::size_t{190}}) {
    const auto image = image_of(size, static_cast<std::uint8_t>(size));
    canopen::FlashStorage storage{flash};
    static_cast<void>(storage.open());
    EXPECT_TRUE(put(storage, image));
    EXPECT_EQ(get(storage), image);
    canopen::FlashStorage again{flash};
    EXPECT_EQ(again.open(), StorageState::whole);
    EXPECT_EQ(get(again), image);
  }
  EXPECT_FALSE(flash.misused);
}

TYPED_TEST(FlashStorageOf, UsesThePagesInTurnAndCountsTheirErasures) {
  TypeParam flash;
  canopen::FlashStorage storage{flash};
  static_cast<void>(storage.open());
  for (std::uint8_t i = 1; i <= 10; ++i) EXPECT_TRUE(put(storage, image_of(20, i)));
  EXPECT_EQ(storage.erasures(), 10u);
  EXPECT_EQ(flash.erased, (std::array{5, 5}));
  canopen::FlashStorage again{flash};
  static_cast<void>(again.open());
  EXPECT_EQ(again.erasures(), 10u);
  EXPECT_EQ(get(again), image_of(20, 10));
}

TYPED_TEST(FlashStorageOf, HoldsTheOldOrTheNewImageWheneverPowerIsCut) {
  using Cut = typename TypeParam::Cut;
  const auto old_image = image_of(45, 1);
  const auto new_image = image_of(45, 101);
  for (const int images_before : {1, 2, 3}) {
    for (const Cut cut : {Cut::nothing_done, Cut::half_done, Cut::all_done}) {
      bool finished = false;
      for (int step = 0; !finished; ++step) {
        TypeParam flash;
        {
          canopen::FlashStorage storage{flash};
          static_cast<void>(storage.open());
          for (int i = 0; i < images_before; ++i) ASSERT_TRUE(put(storage, old_image));
          flash.cut = cut;
          flash.last_step = flash.steps + step;
          finished = put(storage, new_image);
        }
        flash.power_on();
        canopen::FlashStorage storage{flash};
        ASSERT_EQ(storage.open(), StorageState::whole) << "step " << step;
        const auto image = get(storage);
        ASSERT_TRUE(image == old_image || image == new_image) << "step " << step;
        if (finished) {
          ASSERT_EQ(image, new_image);
        }
        if (step == 0) {
          ASSERT_EQ(image, old_image);
        }
        ASSERT_TRUE(put(storage, image_of(60, 7))) << "step " << step;
        canopen::FlashStorage after{flash};
        ASSERT_EQ(after.open(), StorageState::whole);
        ASSERT_EQ(get(after), image_of(60, 7));
        ASSERT_FALSE(flash.misused) << "step " << step;
      }
    }
  }
}

using Flash = bench::FlashEmulation<512, 8>;

TEST(FlashStorage, FallsBackToTheOlderPage) {
  Flash flash;
  canopen::FlashStorage storage{flash};
  static_cast<void>(storage.open());
  ASSERT_TRUE(put(storage, image_of(40, 1)));
  ASSERT_TRUE(put(storage, image_of(40, 2)));
  flash.pages.at(1).at(30) ^= 0x10;
  EXPECT_EQ(storage.open(), StorageState::damaged);
  EXPECT_EQ(get(storage), image_of(40, 1));
}

TEST(FlashStorage, TellsThatBothPagesAreDamaged) {
  Flash flash;
  canopen::FlashStorage storage{flash};
  static_cast<void>(storage.open());
  ASSERT_TRUE(put(storage, image_of(40, 1)));
  ASSERT_TRUE(put(storage, image_of(40, 2)));
  flash.pages.at(0).at(2) ^= 1;
  flash.pages.at(0).at(512 - 16) ^= 1;  // the copy of the header
  flash.pages.at(1).at(50) ^= 1;
  EXPECT_EQ(storage.open(), StorageState::damaged);
  EXPECT_EQ(storage.size(), 0u);
  EXPECT_TRUE(put(storage, image_of(40, 3)));
  EXPECT_EQ(storage.open(), StorageState::whole);
}

TEST(FlashStorage, RefusesAnImageThatDoesNotFit) {
  Flash flash;
  canopen::FlashStorage storage{flash};
  static_cast<void>(storage.open());
  EXPECT_FALSE(storage.begin(512 - 31));
  EXPECT_EQ(flash.steps, 0);
  EXPECT_TRUE(put(storage, image_of(512 - 32, 1)));
  EXPECT_EQ(get(storage), image_of(512 - 32, 1));
}

TEST(FlashStorage, NoticesThatACellHasNotKeptItsValue) {
  struct StuckBit : Flash {
    [[nodiscard]] bool write(std::uint8_t page, std::uint32_t offset, std::span<const std::uint8_t> words) {
      const bool written = Flash::write(page, offset, words);
      if (page == 1) pages.at(1).at(20) &= 0xFE;
      return written;
    }
  };
  StuckBit flash;
  canopen::FlashStorage storage{flash};
  static_cast<void>(storage.open());
  EXPECT_TRUE(put(storage, image_of(40, 1)));
  EXPECT_FALSE(put(storage, image_of(40, 11)));
  EXPECT_EQ(get(storage), image_of(40, 1)) << "the old image counts";
}

// A node on flash

using Storage = canopen::FlashStorage<Flash>;
using Device = bench::Bench<stored_device::Device, canopen::StoredIn<Storage>>;

using InhibitTime = od::tpdo_communication_parameter_1::inhibit_time;

struct Values {
  std::uint32_t acceleration;
  std::uint16_t inhibit_time;
  std::int32_t gain;
  friend bool operator==(const Values&, const Values&) = default;
};

void set(Device& device, const Values& values) {
  EXPECT_EQ(device.node.set<od::profile_acceleration>(values.acceleration), canopen::ok);
  const std::uint8_t time[] = {static_cast<std::uint8_t>(values.inhibit_time),
                               static_cast<std::uint8_t>(values.inhibit_time >> 8)};
  EXPECT_EQ(device.node.set(InhibitTime::index, InhibitTime::sub_index, time), canopen::ok);  // while the PDO is valid
  EXPECT_EQ(device.node.set<od::gain>(values.gain), canopen::ok);
}

Values values(const Device& device) {
  return {device.node.get<od::profile_acceleration>(), device.node.get<InhibitTime>().raw(),
          device.node.get<od::gain>()};
}

/// More steps than any save takes.
constexpr int max_steps = 1000;

constexpr Values defaults{1000, 0, -5};
constexpr Values old_values{11, 1100, 111};
constexpr Values new_values{22, 2200, 222};

/// Sends a request to a device with old values in storage, cuts the power at this step, and returns the values after
/// the next power-on.
Values after_cut(const std::string& request, int step, std::string& answer) {
  Flash flash;
  {
    Storage storage{flash};
    Device device{canopen::stored_in(storage)};
    set(device, old_values);
    EXPECT_EQ(device.ask("605 23 10 10 01 73 61 76 65"), "585 60 10 10 01 00 00 00 00");
    set(device, new_values);
    flash.last_step = flash.steps + step;
    answer = device.ask(request);
  }
  flash.power_on();
  Storage storage{flash};
  Device device{canopen::stored_in(storage)};
  return values(device);
}

TEST(FlashStorage, ASaveThatPowerCutsLeavesOldOrNewValues) {
  std::string answer;
  int step = 0;
  for (; answer != "585 60 10 10 01 00 00 00 00" && step < max_steps; ++step) {
    const Values found = after_cut("605 23 10 10 01 73 61 76 65", step, answer);
    if (answer == "585 60 10 10 01 00 00 00 00") {
      EXPECT_EQ(found, new_values);
    } else {
      EXPECT_EQ(answer, "585 80 10 10 01 00 00 06 06");
      EXPECT_TRUE(found == old_values || found == new_values) << "step " << step;
    }
  }
  EXPECT_GT(step, 10);
  EXPECT_LT(step, max_steps);
}

TEST(FlashStorage, ARestoreThatPowerCutsLeavesOldOrDefaultValues) {
  std::string answer;
  int step = 0;
  for (; answer != "585 60 11 10 01 00 00 00 00" && step < max_steps; ++step) {
    const Values found = after_cut("605 23 11 10 01 6C 6F 61 64", step, answer);
    const bool restored = answer == "585 60 11 10 01 00 00 00 00";
    EXPECT_TRUE(found == defaults || (!restored && found == old_values)) << "step " << step;
  }
  EXPECT_GT(step, 2);
  EXPECT_LT(step, max_steps);
}

TEST(FlashStorage, ASaveOfOneRangeLeavesTheOthersWheneverPowerIsCut) {
  std::string answer;
  int step = 0;
  for (; answer != "585 60 10 10 03 00 00 00 00" && step < max_steps; ++step) {
    const Values found = after_cut("605 23 10 10 03 73 61 76 65", step, answer);
    EXPECT_EQ(found.inhibit_time, old_values.inhibit_time) << "step " << step;
    EXPECT_EQ(found.gain, old_values.gain) << "step " << step;
    const bool saved = answer == "585 60 10 10 03 00 00 00 00";
    EXPECT_TRUE(found.acceleration == 22 || (!saved && found.acceleration == 11)) << "step " << step;
  }
  EXPECT_LT(step, max_steps);
}

}  // namespace
