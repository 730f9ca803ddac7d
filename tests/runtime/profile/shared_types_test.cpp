/// Types of CiA 402 that drives share: one function for the words and modes of two drives.
#include <gtest/gtest.h>

#include <cia402_drive/dictionary.hpp>
#include <cia402_drive/meaning_text.hpp>
#include <every_mode/dictionary.hpp>
#include <every_mode/meaning_text.hpp>
#include <typed_drive/dictionary.hpp>

#include <string_view>
#include <type_traits>

namespace {

bool is_running(canopen::cia402::Statusword status) {
  using State = canopen::cia402::Statusword::state_value;
  return status.is(State::operation_enabled) && !status.warning();
}

std::string_view name_of(canopen::cia402::ModesOfOperation mode) { return to_text(mode); }

template <class Type>
Type with_raw(std::uint16_t number) {
  return Type{canopen::raw(number)};
}

TEST(SharedTypes, ServeTwoDrives) {
  using One = cia402_drive::od::statusword::type;
  using Other = every_mode::od::statusword::type;
  EXPECT_TRUE(is_running(with_raw<One>(0x0237)));
  EXPECT_TRUE(is_running(with_raw<Other>(0x0237)));
  EXPECT_FALSE(is_running(with_raw<One>(0x02B7))) << "a warning";
  EXPECT_FALSE(is_running(with_raw<Other>(0x0233))) << "switched on";
  EXPECT_EQ(name_of(cia402_drive::od::modes_of_operation::value::homing), "homing");
  EXPECT_EQ(name_of(every_mode::od::modes_of_operation_display::value::profile_velocity), "profile_velocity");
}

TEST(SharedTypes, HaveTheirNamesInTheNamespaceOfTheDevice) {
  static_assert(std::is_same_v<cia402_drive::meaning::statusword, canopen::cia402::Statusword>);
  static_assert(std::is_same_v<every_mode::meaning::controlword, canopen::cia402::Controlword>);
  EXPECT_EQ(cia402_drive::meaning::to_text(cia402_drive::od::statusword::type::state_value::fault), "fault");
}

TEST(SharedTypes, AreNotThoseOfADriveWithOtherBits) {
  using Own = typed_drive::od::statusword::type;
  static_assert(!std::is_convertible_v<Own, canopen::cia402::Statusword>);
  static_assert(!std::is_invocable_v<decltype(is_running), Own>);
  static_assert(!std::is_invocable_v<decltype(name_of), typed_drive::od::modes_of_operation::type>);
  static_assert(std::is_invocable_v<decltype(is_running), every_mode::od::statusword::type>);
}

}  // namespace
