/// Stored parameters after an update of the firmware: values that fit are loaded, others are reported, listed, and
/// passed to the application, and "save" does not remove them before the application could use them.
#include <gtest/gtest.h>

#include <algorithm>
#include <canopen/host/memory_storage.hpp>
#include <canopen/storage/flash_storage.hpp>
#include <parameters/device.hpp>
#include <parameters_1/device.hpp>
#include <parameters_2/device.hpp>
#include <parameters_3/device.hpp>
#include <parameters_4/device.hpp>
#include <parameters_5/device.hpp>
#include <string>
#include <vector>

#include "first_format_images.hpp"
#include "flash_emulation.hpp"
#include "support/bench.hpp"

namespace {

using canopen::MemoryStorage;
using canopen::NotLoaded;

/// A device at power-on.
template <class Device, class Storage = MemoryStorage, class... Handlers>
struct Powered {
  explicit Powered(Storage& storage, std::uint8_t node_id = 5, Handlers... handlers)
      : node{bus, canopen::NodeId{node_id}, canopen::stored_in(storage), std::move(handlers)...} {
    node.start(canopen::TimePoint{});
    node.on_time(canopen::TimePoint{});
    reported = bus.take().find(" 00 63 01 ") != std::string::npos;
  }

  /// Returns the bytes of an entry, as SDO sends them.
  std::string value(std::uint16_t index, std::uint8_t sub_index = 0) {
    std::array<std::uint8_t, 8> scratch{};
    std::string text;
    for (const std::uint8_t byte : node.entries().read(node.entries().find(index, sub_index), scratch)) {
      char hexadecimal[4];
      std::snprintf(hexadecimal, sizeof hexadecimal, "%02X", byte);
      text += hexadecimal;
    }
    return text;
  }

  /// Lists what is not loaded: index, sub-index, reason.
  std::vector<std::string> not_loaded() {
    std::vector<std::string> list;
    node.for_each_not_loaded([&](const canopen::StoredValue& stored) {
      char text[32];
      std::snprintf(text, sizeof text, "%04X:%02X %u", stored.index(), stored.sub_index(),
                    static_cast<unsigned>(stored.why()));
      list.emplace_back(text);
    });
    return list;
  }

  bench::RecordingBus bus;
  bool reported = false;  ///< EMCY 6300h
  bench::NodeOf<Device, bench::RecordingBus, canopen::StoredIn<Storage>, Handlers...> node;
};

using List = std::vector<std::string>;

MemoryStorage memory_of(std::span<const std::uint8_t> image) {
  MemoryStorage storage;
  storage.image.assign(image.begin(), image.end());
  return storage;
}

/// The image of the first version with the values of first_format_images.hpp.
MemoryStorage stored() {
  MemoryStorage storage = memory_of(first_format::all_of_node_5);
  Powered<parameters::Device> device{storage};
  EXPECT_EQ(device.node.save(), canopen::ok);
  return storage;
}

/// The values that all versions accept.
void expect_common(auto& device) {
  EXPECT_EQ(device.value(0x1017), "F401");
  EXPECT_EQ(device.value(0x2003, 2), "16");
  EXPECT_EQ(device.value(0xA000), "0900");
}

// Images of the first format

TEST(FirstFormat, IsLoaded) {
  MemoryStorage storage = memory_of(first_format::all_of_node_5);
  Powered<parameters::Device> device{storage};
  EXPECT_FALSE(device.reported);
  expect_common(device);
  EXPECT_EQ(device.value(0x1014), "85000000");
  EXPECT_EQ(device.value(0x2000), "0700");
  EXPECT_EQ(device.value(0x2001), "616263");
  EXPECT_EQ(device.value(0x2002), "FEFFFF");
  EXPECT_EQ(device.value(0x2004), "40E20100");
  EXPECT_EQ(device.value(0x6000), "39300000");
  EXPECT_EQ(device.value(0x6001), "00002040");
  EXPECT_EQ(device.not_loaded(), List{});
}

TEST(FirstFormat, FollowsTheNodeIdOfEachSection) {
  MemoryStorage storage = memory_of(first_format::manufacturer_of_node_5_communication_of_node_9);
  Powered<parameters::Device> device{storage, 7};
  EXPECT_FALSE(device.reported);
  EXPECT_EQ(device.value(0x1014), "87000000");
  EXPECT_EQ(device.value(0x1017), "F401");
  EXPECT_EQ(device.value(0x2000), "0700");
  EXPECT_EQ(device.value(0x6000), "00000000") << "was not stored";
}

TEST(FirstFormat, IsKeptWhereAnotherSectionIsSaved) {
  MemoryStorage storage = memory_of(first_format::all_of_node_5);
  {
    Powered<parameters::Device> device{storage};
    device.node.set<parameters::od::position>(1);
    ASSERT_EQ(device.node.set<parameters::od::gain>(1), canopen::ok);
    EXPECT_EQ(device.node.save(3), canopen::ok);
  }
  EXPECT_EQ(storage.image.at(0), 'P') << "the format of today";
  Powered<parameters::Device> device{storage};
  expect_common(device);
  EXPECT_EQ(device.value(0x6000), "01000000");
  EXPECT_EQ(device.value(0x2000), "0700");
  EXPECT_EQ(device.value(0x2001), "616263");
}

TEST(FirstFormat, OfPagesOfFlashIsLoadedAndReplaced) {
  using Flash = bench::FlashEmulation<256, 8>;
  Flash flash;
  std::ranges::copy(first_format::flash_page_0, flash.pages[0].begin());
  std::ranges::copy(first_format::flash_page_1, flash.pages[1].begin());
  canopen::FlashStorage storage{flash};
  for (const std::string gain : {"0700", "0800", "0900"}) {
    Powered<parameters::Device, canopen::FlashStorage<Flash>> device{storage};
    EXPECT_FALSE(device.reported);
    expect_common(device);
    EXPECT_EQ(device.value(0x2000), gain);
    ASSERT_EQ(device.node.set<parameters::od::gain>(static_cast<std::uint16_t>(gain[1] - '0' + 1)), canopen::ok);
    EXPECT_EQ(device.node.save(), canopen::ok);
  }
}

/// The first format does not tell which objects a section of another dictionary has.
TEST(FirstFormat, OfAnotherDictionaryIsReportedBySection) {
  MemoryStorage storage = memory_of(first_format::all_of_node_5);
  Powered<parameters_1::Device> device{storage};
  EXPECT_TRUE(device.reported);
  EXPECT_EQ(device.not_loaded(), List{"0000:00 7"});
  EXPECT_EQ(device.value(0x1017), "F401") << "1000h..1FFFh is the same";
  EXPECT_EQ(device.value(0x6000), "39300000");
  EXPECT_EQ(device.value(0x2000), "0300") << "the default value";
}

TEST(FirstFormat, ThatIsNoneIsReported) {
  MemoryStorage storage = memory_of(std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8, 9});
  Powered<parameters::Device> device{storage};
  EXPECT_TRUE(device.reported);
  EXPECT_EQ(device.value(0x2000), "0300");
  EXPECT_EQ(device.node.save(), canopen::ok);
  EXPECT_FALSE(Powered<parameters::Device>{storage}.reported);
}

// Updates

TEST(UpdatedParameters, AreKeptWhenAnObjectIsAddedAndALimitIsWidened) {
  MemoryStorage storage = stored();
  Powered<parameters_1::Device> device{storage};
  EXPECT_FALSE(device.reported);
  expect_common(device);
  EXPECT_EQ(device.value(0x2000), "0700");
  EXPECT_EQ(device.value(0x2001), "616263");
  EXPECT_EQ(device.value(0x2004), "40E20100");
  EXPECT_EQ(device.value(0x2009), "0900") << "the default value";
  EXPECT_EQ(device.not_loaded(), List{});
}

TEST(UpdatedParameters, OutsideNewLimitsAreReported) {
  MemoryStorage storage = stored();
  Powered<parameters_2::Device> device{storage};
  EXPECT_TRUE(device.reported);
  expect_common(device);
  EXPECT_EQ(device.value(0x2000), "0300");
  EXPECT_EQ(device.value(0x2004), "40E20100") << "the others are loaded";
  EXPECT_EQ(device.not_loaded(), (List{"2000:00 5", "6001:00 5"}));
}

TEST(UpdatedParameters, OfAnotherTypeAreReported) {
  MemoryStorage storage = stored();
  Powered<parameters_3::Device> device{storage};
  EXPECT_TRUE(device.reported);
  expect_common(device);
  EXPECT_EQ(device.value(0x2000), "03000000");
  EXPECT_EQ(device.value(0x2001), "616263") << "three letters fit";
  EXPECT_EQ(device.not_loaded(), (List{"2000:00 3"}));
}

TEST(UpdatedParameters, WhoseTextIsTooLongAreReported) {
  MemoryStorage storage;
  {
    Powered<parameters::Device> device{storage};
    const std::array<std::uint8_t, 5> text{'l', 'a', 'b', 'e', 'l'};
    ASSERT_EQ(device.node.set(0x2001, 0, text), canopen::ok);
    ASSERT_EQ(device.node.save(), canopen::ok);
  }
  Powered<parameters_3::Device> device{storage};
  EXPECT_EQ(device.not_loaded(), (List{"2000:00 3", "2001:00 4"}));
  EXPECT_EQ(device.value(0x2001), "74657874");
}

TEST(UpdatedParameters, OfARemovedObjectAreReported) {
  MemoryStorage storage = stored();
  Powered<parameters_4::Device> device{storage};
  EXPECT_TRUE(device.reported);
  expect_common(device);
  EXPECT_EQ(device.value(0x2003, 4), "04");
  EXPECT_EQ(device.not_loaded(), (List{"2002:00 1"}));
}

TEST(UpdatedParameters, OfEntriesThatAreNotStoredAreReported) {
  MemoryStorage storage = stored();
  Powered<parameters_5::Device> device{storage};
  EXPECT_TRUE(device.reported);
  expect_common(device);
  EXPECT_EQ(device.value(0x2004), "E8030000");
  EXPECT_EQ(device.value(0x6000), "00000000");
  EXPECT_EQ(device.not_loaded(), (List{"2004:00 2", "6000:00 2"}));
}

TEST(UpdatedParameters, StayInTheStorageUntilTheApplicationCouldUseThem) {
  MemoryStorage storage = stored();
  {
    Powered<parameters_4::Device> device{storage};
    EXPECT_EQ(device.node.save(), canopen::ok);
    EXPECT_EQ(device.node.save(4), canopen::ok);
  }
  {
    Powered<parameters::Device> device{storage};
    EXPECT_EQ(device.value(0x2002), "FEFFFF") << "back to the version before";
  }
  {
    Powered<parameters_4::Device> device{storage};
    EXPECT_EQ(device.not_loaded(), (List{"2002:00 1"}));
    EXPECT_EQ(device.node.save(4), canopen::ok) << "a part of the parameters: the application may convert to another";
    EXPECT_EQ(device.not_loaded(), (List{"2002:00 1"}));
    EXPECT_EQ(device.node.save(), canopen::ok);
    EXPECT_EQ(device.not_loaded(), List{});
  }
  EXPECT_FALSE(Powered<parameters_4::Device>{storage}.reported);
}

TEST(UpdatedParameters, AreRemovedByLoad) {
  MemoryStorage storage = stored();
  {
    Powered<parameters_4::Device> device{storage};
    EXPECT_EQ(device.node.restore(3), canopen::ok);
    EXPECT_EQ(device.not_loaded(), (List{"2002:00 1"})) << "it is in 2000h..5FFFh";
    EXPECT_EQ(device.node.restore(4), canopen::ok);
    EXPECT_EQ(device.not_loaded(), List{});
  }
  EXPECT_EQ(Powered<parameters_4::Device>{storage}.value(0x1017), "F401");
}

TEST(UpdatedParameters, MakeRoomForNewOnes) {
  using Flash = bench::FlashEmulation<152, 8>;  // room for the parameters of one version
  Flash flash;
  canopen::FlashStorage storage{flash};
  {
    Powered<parameters::Device, canopen::FlashStorage<Flash>> device{storage};
    ASSERT_EQ(device.node.save(), canopen::ok);
  }
  Powered<parameters_4::Device, canopen::FlashStorage<Flash>> device{storage};
  EXPECT_TRUE(device.reported);
  EXPECT_EQ(device.node.save(), canopen::ok);
}

// The application

/// The application of version 3, whose gain has another type and unit.
struct Converting {
  std::vector<std::string> seen;
  void on_stored_value(const canopen::StoredValue& old) {
    char text[32];
    std::snprintf(text, sizeof text, "%04X:%02X %u %u", old.index(), old.sub_index(), static_cast<unsigned>(old.why()),
                  old.version());
    seen.emplace_back(text);
    if (old.is(0x2000, 0) && old.type() == canopen::entry::u16) {
      EXPECT_EQ(old.size(), 2);
      EXPECT_EQ(old.replace_by(parameters_3::od::gain{}, old.number() + 2), canopen::ok);
    }
    if (old.is(0x2004, 0) && old.why() == NotLoaded::version) {
      EXPECT_EQ(old.replace_by(parameters_3::od::range{}, old.number() / 10), canopen::ok);
    }
  }
};

TEST(MigratedParameters, AreConvertedByTheApplication) {
  MemoryStorage storage = stored();
  {
    Powered<parameters_3::Device, MemoryStorage, Converting> device{storage, 5, Converting{}};
    EXPECT_FALSE(device.reported) << "nothing is lost";
    expect_common(device);
    EXPECT_EQ(device.value(0x2000), "09000000");
    EXPECT_EQ(device.value(0x2004), "39300000");
    const List& seen = device.node.application<Converting>().seen;
    EXPECT_NE(std::ranges::find(seen, "2000:00 3 0"), seen.end());
    EXPECT_NE(std::ranges::find(seen, "2001:00 6 0"), seen.end()) << "stored with another version of the options";
    EXPECT_EQ(device.node.save(), canopen::ok);
  }
  Powered<parameters_3::Device, MemoryStorage, Converting> device{storage, 5, Converting{}};
  EXPECT_EQ(device.node.application<Converting>().seen, List{}) << "converted once";
  EXPECT_EQ(device.value(0x2000), "09000000");
  EXPECT_EQ(device.value(0x2004), "39300000");
}

TEST(MigratedParameters, AreConvertedByALambda) {
  MemoryStorage storage = stored();
  auto convert = canopen::on_stored_value([](const canopen::StoredValue& old) {
    if (old.is(0x2002, 0)) {
      EXPECT_EQ(old.signed_number(), -2);
      EXPECT_EQ(old.replace_by(parameters_4::od::gain{}, 10 + old.signed_number()), canopen::ok);
    }
  });
  Powered<parameters_4::Device, MemoryStorage, decltype(convert)> device{storage, 5, convert};
  EXPECT_FALSE(device.reported);
  EXPECT_EQ(device.value(0x2000), "0800");
}

TEST(MigratedParameters, AreDiscardedByTheApplication) {
  MemoryStorage storage = stored();
  auto discard = canopen::on_stored_value([](const canopen::StoredValue& old) { old.discard(); });
  Powered<parameters_4::Device, MemoryStorage, decltype(discard)> device{storage, 5, discard};
  EXPECT_FALSE(device.reported);
  EXPECT_EQ(device.node.save(), canopen::ok);
  EXPECT_EQ(device.not_loaded(), List{});
}

TEST(MigratedParameters, CannotBeReplacedByWhatTheNodeWouldReject) {
  MemoryStorage storage = stored();
  canopen::AbortCode code = canopen::ok;
  auto convert = canopen::on_stored_value(
      [&](const canopen::StoredValue& old) { code = old.replace_by(parameters_4::od::gain{}, 11); });
  Powered<parameters_4::Device, MemoryStorage, decltype(convert)> device{storage, 5, convert};
  EXPECT_EQ(code, canopen::AbortCode::value_too_high);
  EXPECT_TRUE(device.reported);
  EXPECT_EQ(device.value(0x2000), "0700");
}

// Sub-indices of 1010h that the options define

TEST(StorageSubIndices, StoreAndRestoreTheirEntries) {
  MemoryStorage storage;
  const std::array<std::uint8_t, 1> seven{7};
  const std::array<std::uint8_t, 2> gain{7, 0};
  {
    Powered<parameters_5::Device> device{storage};
    ASSERT_EQ(device.node.set(0x2003, 1, seven), canopen::ok);
    ASSERT_EQ(device.node.set(0x2000, 0, gain), canopen::ok);
    EXPECT_EQ(device.node.save(6), canopen::AbortCode::hardware) << "no entries";
    EXPECT_EQ(device.node.save(5), canopen::ok);
  }
  {
    Powered<parameters_5::Device> device{storage};
    EXPECT_EQ(device.value(0x2003, 1), "07");
    EXPECT_EQ(device.value(0x2000), "0300") << "stored by 1010h:04";
    ASSERT_EQ(device.node.set(0x2000, 0, gain), canopen::ok);
    EXPECT_EQ(device.node.save(1), canopen::ok);
    EXPECT_EQ(device.node.restore(4), canopen::ok);
  }
  Powered<parameters_5::Device> device{storage};
  EXPECT_EQ(device.value(0x2003, 1), "07");
  EXPECT_EQ(device.value(0x2000), "0300");
}

}  // namespace
