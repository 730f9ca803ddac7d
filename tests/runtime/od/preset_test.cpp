/// Default values without their zero bytes are the default values.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <pdo_device/device.hpp>
#include <sync_device/device.hpp>

#include "canopen/od/preset.hpp"
#include "canopen/od/value.hpp"

namespace {

/// Unpacks the default values of a part into memory that is not zero, and compares each value with the constant of the
/// device.
template <class Device, auto Preset, std::size_t Offset>
void expect_default_values() {
  using Bytes = canopen::PresetBytes<Device, Preset, Offset>;
  static_assert(Bytes::are_numbers());
  using Packed = canopen::preset_detail::Packed<Bytes>;
  std::array<std::uint8_t, Bytes::size> unpacked;
  unpacked.fill(0xA5);
  canopen::preset_detail::unpack(unpacked.data(), unpacked.size(), Packed::bytes.data());

  const auto* const expected = reinterpret_cast<const std::uint8_t*>(Preset);
  unsigned values = 0;
  Device::dictionary.for_each_entry([&](std::uint16_t index, std::uint8_t sub_index, canopen::entry::Word word) {
    const std::size_t at = canopen::entry::offset_of(word) - Offset;
    if (canopen::entry::place_of(word) != canopen::entry::Place::ram || at >= Bytes::size) return;
    ++values;
    EXPECT_EQ(std::memcmp(&unpacked[at], expected + at, canopen::entry::wire_bytes(word)), 0)
        << std::hex << index << ':' << unsigned{sub_index};
  });
  EXPECT_GT(values, 0u);
}

TEST(Preset, HasTheValuesOfADynamicMapping) {
  using Values = pdo_device::Values;
  expect_default_values<pdo_device::Device, &pdo_device::communication_preset,
                        offsetof(Values, communication_preset)>();
}

TEST(Preset, HasTheValuesOfASync) {
  using Values = sync_device::Values;
  expect_default_values<sync_device::Device, &sync_device::communication_preset,
                        offsetof(Values, communication_preset)>();
}

/// Values with unused bytes behind them, and one that is extended to the type in which it is stored.
struct Times {
  struct Part {
    canopen::TimeOfDay time;
    std::int32_t of_24_bits;
    std::uint64_t of_40_bits;
  };
  struct Entries {
    template <class Visit>
    constexpr void for_each_entry(Visit&& visit) const {
      using namespace canopen::entry;
      visit(0x2000, 0, ram | time48 | offsetof(Part, time));
      visit(0x2001, 0, ram | i24 | offsetof(Part, of_24_bits));
      visit(0x2002, 0, ram | u40 | offsetof(Part, of_40_bits));
    }
  };
  static constexpr Entries dictionary{};
};
constexpr Times::Part times{{0x01020304, 5}, -2, 0x1122334455};

TEST(Preset, HasTimesAndExtendedNumbers) {
  expect_default_values<Times, &times, 0>();
  const auto bytes = canopen::PresetBytes<Times, &times, 0>::bytes();
  EXPECT_EQ(bytes[offsetof(Times::Part, of_24_bits) + 3], 0xFF) << "the sign";
}

TEST(Preset, IsShorterForADynamicMapping) {
  using Bytes = canopen::PresetBytes<pdo_device::Device, &pdo_device::communication_preset,
                                     offsetof(pdo_device::Values, communication_preset)>;
  EXPECT_LT(canopen::preset_detail::Packed<Bytes>::size, Bytes::size / 2);
}

}  // namespace
