#include <gtest/gtest.h>
#include <canopen/od/object_store.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <rk5c/device.hpp>
#include <sample/device.hpp>
#include <string>
#include <vector>

namespace {

using canopen::AbortCode;
using canopen::NodeId;
using Store = canopen::ObjectStore<sample::Device>;
namespace od = sample::od;

Store fresh() {
  Store store;
  store.reset_application(NodeId{5});
  store.reset_communication(NodeId{5});
  return store;
}

std::vector<std::uint8_t> read(Store& store, std::uint16_t index, std::uint8_t sub_index) {
  std::array<std::uint8_t, 8> scratch{};
  const auto bytes = store.entries().read(sample::dictionary.find(index, sub_index), scratch);
  return {bytes.begin(), bytes.end()};
}

AbortCode check(Store& store, std::uint16_t index, std::uint8_t sub_index, std::vector<std::uint8_t> bytes) {
  return store.entries().check(index, sub_index, sample::dictionary.find(index, sub_index), bytes);
}

using Bytes = std::vector<std::uint8_t>;

TEST(ObjectStore, BeginsWithTheDefaultValues) {
  Store store = fresh();
  EXPECT_EQ(canopen::to_raw(store.get<od::integer32_value>()), -2);
  EXPECT_EQ(canopen::to_raw(store.get<od::profile_acceleration>()), 1000u);
  EXPECT_EQ(store.get<od::visible_string_value>().view(), "hello");
  EXPECT_EQ(canopen::to_raw(store.get<od::filter::time_constant>()), 1000u);
}

/// Returns a value whose padding, and whose bytes after the end of a string, are all `filler`.
template <class T>
T padded(const T& value, std::uint8_t filler, std::size_t used) {
  T other;
  std::memset(static_cast<void*>(&other), filler, sizeof other);
  std::memcpy(static_cast<void*>(&other), &value, used);
  return other;
}

TEST(ObjectStore, EqualValuesAreEqualWhateverTheirPadding) {
  Store store = fresh();
  const canopen::TimeOfDay time{0x0ABCDEF0, 0x1234};
  EXPECT_TRUE(store.set<od::time_of_day_value>(padded(time, 0x00, 6)));
  EXPECT_FALSE(store.set<od::time_of_day_value>(padded(time, 0xFF, 6)));
  EXPECT_TRUE(store.set<od::time_of_day_value>(canopen::TimeOfDay{0x0ABCDEF0, 0x1235}));
  using Text = od::visible_string_value::type;
  const Text text{"abc"};
  EXPECT_TRUE(store.set<od::visible_string_value>(padded(text, 0x00, 5)));
  EXPECT_FALSE(store.set<od::visible_string_value>(padded(text, 0xFF, 5)));
  EXPECT_TRUE(store.set<od::visible_string_value>(Text{"ab"}));
  EXPECT_TRUE(store.set<od::visible_string_value>(Text{"ac"}));
}

TEST(ObjectStore, AddsTheNodeIdToCobIds) {
  Store store = fresh();
  EXPECT_EQ(canopen::to_raw(store.get<od::rpdo_communication_parameter_1::cob_id_used_by_rpdo>()), 0x205u);
  EXPECT_EQ(canopen::to_raw(store.get<od::tpdo_communication_parameter_2::cob_id_used_by_tpdo>()), 0xC0000285u);
  EXPECT_EQ(canopen::to_raw((store.get<od::sdo_server_parameter::cob_id_client_to_server>())), 0x605u);
}

/// 1018h has its product code in flash and its serial number, which the application sets, in RAM.
TEST(ObjectStore, FindsTheValuesOfARecordInFlashAndInRam) {
  canopen::ObjectStore<rk5c::Device> store;
  store.set<rk5c::od::identity_object::serial_number>(0x12345678);
  EXPECT_EQ(store.entries().number(0x1018, 2), 0x43354B52u);
  EXPECT_EQ(store.entries().number(0x1018, 4), 0x12345678u);
}

TEST(ObjectStore, SaysWhetherAValueIsNew) {
  Store store = fresh();
  EXPECT_TRUE(store.set<od::statusword>(1));
  EXPECT_FALSE(store.set<od::statusword>(1));
  EXPECT_EQ(canopen::to_raw(store.get<od::statusword>()), 1);
}

TEST(ObjectStore, KnowsWhatCanBeSet) {
  static_assert(Store::settable<od::statusword>());
  static_assert(!Store::settable<od::device_type>());
  static_assert(!Store::settable<od::number_of_channels>());
}

TEST(ObjectStore, ReadsTheBytesThatSdoSends) {
  Store store = fresh();
  store.set<od::integer24_value>(-2);
  store.set<od::integer40_value>(-2);
  store.set<od::boolean_value>(true);
  EXPECT_EQ(read(store, 0x2003, 0), (Bytes{0xFE, 0xFF, 0xFF}));
  EXPECT_EQ(read(store, 0x2006, 0), (Bytes{0xFE, 0xFF, 0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(read(store, 0x2000, 0), (Bytes{1}));
  EXPECT_EQ(read(store, 0x1009, 0), (Bytes{'A', '1'}));
  EXPECT_EQ(read(store, 0x2017, 0), (Bytes{0xFB, 0xFF}));
  EXPECT_EQ(read(store, 0x1200, 2), (Bytes{0x85, 0x05, 0, 0}));
}

TEST(ObjectStore, WidensNumbersOfOddLength) {
  Store store = fresh();
  store.entries().write(sample::dictionary.find(0x2003, 0), Bytes{0xFD, 0xFF, 0xFF});
  EXPECT_EQ(canopen::to_raw(store.get<od::integer24_value>()), -3);
  store.set<od::unsigned40_value>(~std::uint64_t{0});
  store.entries().write(sample::dictionary.find(0x2009, 0), Bytes{1, 2, 3, 4, 0xF5});
  EXPECT_EQ(canopen::to_raw(store.get<od::unsigned40_value>()), 0xF504030201u);
}

TEST(ObjectStore, ChecksLengthsBeforeValues) {
  Store store = fresh();
  EXPECT_EQ(check(store, 0x2001, 0, {0x7F, 0x7F}), AbortCode::length_too_high);
  EXPECT_EQ(check(store, 0x2002, 0, {0x7F}), AbortCode::length_too_low);
  EXPECT_EQ(check(store, 0x200C, 0, Bytes(17, 'x')), AbortCode::length_too_high);
  EXPECT_EQ(check(store, 0x200C, 0, {}), canopen::ok);
}

TEST(ObjectStore, ChecksSignedLimits) {
  Store store = fresh();
  EXPECT_EQ(check(store, 0x2001, 0, {100}), canopen::ok);
  EXPECT_EQ(check(store, 0x2001, 0, {101}), AbortCode::value_too_high);
  EXPECT_EQ(check(store, 0x2001, 0, {0x9C}), canopen::ok);
  EXPECT_EQ(check(store, 0x2001, 0, {0x9B}), AbortCode::value_too_low);
}

TEST(ObjectStore, TheElementsOfAnArrayShareTheirLimits) {
  Store store = fresh();
  for (std::uint8_t element = 1; element <= 3; ++element) {
    EXPECT_EQ(check(store, 0x2013, element, {10, 0}), canopen::ok);
    EXPECT_EQ(check(store, 0x2013, element, {11, 0}), AbortCode::value_too_high);
  }
}

TEST(ObjectStore, ChecksRealLimits) {
  Store store = fresh();
  EXPECT_EQ(check(store, 0x200A, 0, {0, 0, 0xC0, 0x3F}), canopen::ok);                // 1.5
  EXPECT_EQ(check(store, 0x200A, 0, {1, 0, 0xC0, 0x3F}), AbortCode::value_too_high);  // the next one
  EXPECT_EQ(check(store, 0x200A, 0, {0, 0, 0xC0, 0xBF}), canopen::ok);                // -1.5
  EXPECT_EQ(check(store, 0x200A, 0, {1, 0, 0xC0, 0xBF}), AbortCode::value_too_low);
  EXPECT_EQ(check(store, 0x200A, 0, {0, 0, 0, 0x80}), canopen::ok);                   // -0
  EXPECT_EQ(check(store, 0x200A, 0, {0, 0, 0x80, 0x7F}), AbortCode::value_too_high);  // infinity
  EXPECT_EQ(check(store, 0x200A, 0, {0, 0, 0xC0, 0xFF}), AbortCode::invalid_value);   // not a number
}

TEST(ObjectStore, ResetOfCommunicationLeavesTheApplicationAlone) {
  Store store = fresh();
  store.set<od::profile_acceleration>(7);
  store.set<od::producer_heartbeat_time>(canopen::from_raw<od::producer_heartbeat_time::type>(7));
  store.reset_communication(NodeId{6});
  EXPECT_EQ(canopen::to_raw(store.get<od::profile_acceleration>()), 7u);
  EXPECT_EQ(canopen::to_raw(store.get<od::producer_heartbeat_time>()), 0);
  EXPECT_EQ(canopen::to_raw(store.get<od::rpdo_communication_parameter_1::cob_id_used_by_rpdo>()), 0x206u);
}

}  // namespace
