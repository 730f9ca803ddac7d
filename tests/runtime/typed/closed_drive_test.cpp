/// Elements of an array with different meanings, and closed enumerations without limits in the EDS.
#include <gtest/gtest.h>

#include <canopen/node.hpp>
#include <closed_drive/device.hpp>
#include <closed_drive/meaning_text.hpp>

#include <cstdint>
#include <type_traits>

#include "support/bench.hpp"

namespace {

using canopen::AbortCode;
using namespace canopen::literals;
namespace od = closed_drive::od;
using closed_drive::Device;

static_assert(std::is_same_v<od::zone_temperature<1>::type, std::int16_t>);
static_assert(std::is_same_v<od::zone_temperature<2>::type, closed_drive::meaning::zone_temperature_2>);
static_assert(canopen::is_quantity<od::zone_temperature<3>::type>);
static_assert(std::is_same_v<od::zone_temperature<>::type, std::int16_t>);
static_assert(std::is_same_v<od::cooling_depth::type, std::int16_t>);
static_assert(to_text(od::heater_state::value::switch_) == "switch");

TEST(ClosedDrive, HasElementsWithDifferentMeanings) {
  bench::Bench<Device> device;
  EXPECT_EQ(device.node.set(od::zone_temperature<1>{}, std::int16_t{5}), canopen::ok);
  EXPECT_EQ(device.node.set(od::zone_temperature<2>{}, od::zone_temperature<2>::value::cold), canopen::ok);
  device.node.set(od::zone_temperature<3>{}, 20_K);
  EXPECT_EQ(device.ask("605 40 05 20 02 00 00 00 00"), "585 4B 05 20 02 F6 FF 00 00");
  EXPECT_EQ(device.ask("605 40 05 20 03 00 00 00 00"), "585 4B 05 20 03 14 00 00 00");
  // The second element accepts -10 and 0 alone.
  EXPECT_EQ(device.ask("605 2B 05 20 02 01 00 00 00"), "585 80 05 20 02 30 00 09 06");
  EXPECT_EQ(device.ask("605 2B 05 20 02 00 00 00 00"), "585 60 05 20 02 00 00 00 00");
  EXPECT_EQ(device.ask("605 2B 05 20 01 01 00 00 00"), "585 60 05 20 01 00 00 00 00");
  EXPECT_EQ(device.node.set(od::zone_temperature{}, 2, std::int16_t{7}), AbortCode::invalid_value);
  EXPECT_EQ(device.node.set(od::zone_temperature{}, 1, std::int16_t{7}), canopen::ok);
}

TEST(ClosedDrive, RejectsValuesInAnRpdoThatIsMappedAtRunTime) {
  bench::Bench<Device> device;
  device.ask("605 23 01 14 01 05 03 00 80");
  device.ask("605 2F 01 16 00 00 00 00 00");
  device.ask("605 23 01 16 01 08 00 03 20");
  device.ask("605 2F 01 16 00 01 00 00 00");
  EXPECT_EQ(device.ask("605 23 01 14 01 05 03 00 00"), "585 60 01 14 01 00 00 00 00");
  device.ask(bench::start);
  device.ask("305 FF");
  EXPECT_EQ(device.node.get(od::door{}), od::door::value::unknown);
  device.ask("305 02");
  EXPECT_EQ(device.node.get(od::door{}), od::door::value::unknown);
  device.ask("305 01");
  EXPECT_EQ(device.node.get(od::door{}), od::door::value::open);
}

}  // namespace
