/// The examples of docs/node.md for values with a meaning.
#include <gtest/gtest.h>

#include <canopen/node.hpp>
#include <typed_drive/device.hpp>
#include <typed_drive/meaning_text.hpp>

#include <cstdint>
#include <ratio>
#include <string>

#include "support/bench.hpp"

namespace {

namespace od = typed_drive::od;
using namespace canopen::literals;
using canopen::AbortCode;

struct Heater {
  using heater = od::heater_state::value;

  AbortCode write(od::setpoint, od::setpoint::type value) {
    return value > 353.15_K ? AbortCode::local_control : canopen::ok;
  }

  void written(od::setpoint, od::setpoint::type value, auto& node) {
    const od::temperature::type now = node.get(od::temperature{});
    node.set(od::heater_state{}, now < value ? heater::heating : heater::off);
    node.modify(od::door{}, [](auto& door) { door.open(false).zone(3); });
  }
};

TEST(TypedExample, UsesUnitsNamesAndFields) {
  bench::Bench<typed_drive::Device, Heater> device{Heater{}};
  auto& node = device.node;
  EXPECT_EQ(device.ask("605 2B 00 20 00 21 03 00 00"), "585 80 00 20 00 21 00 00 08");  // 80.1 °C
  EXPECT_EQ(device.ask("605 2B 00 20 00 D7 00 00 00"), "585 60 00 20 00 00 00 00 00");  // 21.5 °C
  EXPECT_EQ(node.get(od::heater_state{}), Heater::heater::heating);
  EXPECT_EQ(node.get(od::door{}).raw(), 0x30);
  node.set(od::temperature{}, 21.5_degC);

  // The value in a unit, as double; in hundredths of K, with integers only; as number; a number of the program as
  // value.
  const double kelvin = node.get(od::temperature{}).in<canopen::unit::kelvin>();
  const std::int32_t hundredths = node.get(od::temperature{}).count<canopen::unit::kelvin, std::ratio<1, 100>>();
  const std::int16_t number = node.get(od::temperature{}).raw();
  node.set(od::temperature{}, canopen::raw(number));
  EXPECT_DOUBLE_EQ(kelvin, 294.65);
  EXPECT_EQ(hundredths, 29'465);
  EXPECT_EQ(node.get(od::temperature{}).raw(), 215);

  // The value that is nearest to 29,465 hundredths of K, with integers only; value_too_high or value_too_low if the
  // object's type does not have it.
  const auto measured = od::temperature::type::rounded<canopen::unit::kelvin, std::ratio<1, 100>>(29'465);
  if (measured) node.set(od::temperature{}, *measured);
  EXPECT_EQ(node.get(od::temperature{}).raw(), 215);

  const bool is_day = hundredths > 29'000;
  node.set(od::temperature{}, is_day ? od::temperature::type{20_degC} : 15_degC);
  EXPECT_EQ(node.get(od::temperature{}).raw(), 200);

  using state = od::statusword::type::state_value;
  node.modify(od::statusword{}, [](auto& word) { word.state(state::operation_enabled); });
  const auto status = node.get(od::statusword{});
  const bool is_ready = status.is(state::operation_enabled) && !status.profile_position().following_error();
  const std::string text{to_text(node.get(od::modes_of_operation{}))};
  EXPECT_TRUE(is_ready);
  EXPECT_EQ(text, "no_mode");
}

}  // namespace
