/// Faults of mapped objects (CiA 301, 7.4.7.1 and 7.5.2.36).
#include "pdo/mapping_fault.hpp"

#include <gtest/gtest.h>

namespace edsc {
namespace {

using canopen::DataType;
using canopen::Mappable;
using Fault = std::optional<MappingFault>;

constexpr std::uint16_t allowed_dummies[] = {0x0005, 0x0009};

MappableObject object_of(DataType type, Mappable mappable = Mappable::both) {
  return {canopen::find_data_type(static_cast<std::uint32_t>(type)), mappable, true, {}};
}

Fault fault_in(PdoDirection direction, std::uint32_t value, const MappableObject& object) {
  return fault_of(direction, MappingValue::of(value), &object, allowed_dummies);
}

Fault fault_in_rpdo(std::uint32_t value, const MappableObject& object) {
  return fault_in(PdoDirection::receive, value, object);
}

Fault fault_of_dummy(PdoDirection direction, std::uint32_t value) {
  return fault_of(direction, MappingValue::of(value), nullptr, allowed_dummies);
}

TEST(MappingFaultOfAnObject, IsNothingForTheLengthOfTheType) {
  EXPECT_EQ(fault_in_rpdo(0x2000'0010, object_of(DataType::unsigned16)), Fault{});
  EXPECT_EQ(fault_in_rpdo(0x2000'0001, object_of(DataType::boolean)), Fault{});
}

TEST(MappingFaultOfAnObject, IsAnotherLength) {
  EXPECT_EQ(fault_in_rpdo(0x2000'0008, object_of(DataType::unsigned16)), MappingFault::wrong_length);
  EXPECT_EQ(fault_in_rpdo(0x2000'0000, object_of(DataType::unsigned16)), MappingFault::wrong_length);
}

TEST(MappingFaultOfAnObject, IsNotABooleanInAByte) {
  const MappableObject boolean = object_of(DataType::boolean);
  EXPECT_EQ(fault_in_rpdo(0x2000'0008, boolean), Fault{});
  EXPECT_TRUE(is_boolean_in_a_byte(MappingValue::of(0x2000'0008), *boolean.type));
  EXPECT_FALSE(is_boolean_in_a_byte(MappingValue::of(0x2000'0001), *boolean.type));
  EXPECT_EQ(fault_in_rpdo(0x2000'0010, boolean), MappingFault::wrong_length);
}

TEST(MappingFaultOfAnObject, IsThatItDoesNotExist) {
  EXPECT_EQ(fault_of(PdoDirection::transmit, MappingValue::of(0x2000'0008), nullptr, {}), MappingFault::unknown_object);
}

TEST(MappingFaultOfAnObject, IsPdoMapping0BeforeTheDirection) {
  MappableObject object = object_of(DataType::unsigned8, Mappable::no);
  object.pdo_mapping = false;
  EXPECT_EQ(fault_in_rpdo(0x2000'0008, object), MappingFault::not_mappable);
}

TEST(MappingFaultOfAnObject, IsADirectionThatItsAccessTypeDoesNotAllow) {
  const MappableObject input = object_of(DataType::unsigned8, Mappable::tpdo);
  const MappableObject output = object_of(DataType::unsigned8, Mappable::rpdo);
  EXPECT_EQ(fault_in(PdoDirection::receive, 0x2000'0008, input), MappingFault::wrong_direction);
  EXPECT_EQ(fault_in(PdoDirection::transmit, 0x2000'0008, input), Fault{});
  EXPECT_EQ(fault_in(PdoDirection::receive, 0x2000'0008, output), Fault{});
  EXPECT_EQ(fault_in(PdoDirection::transmit, 0x2000'0008, output), MappingFault::wrong_direction);
}

TEST(MappingFaultOfAnObject, IsATypeWithoutALength) {
  EXPECT_EQ(fault_in_rpdo(0x2000'0008, object_of(DataType::domain)), MappingFault::variable_length);
  EXPECT_EQ(fault_in_rpdo(0x2000'0008, object_of(DataType::visible_string)), MappingFault::variable_length);
}

TEST(MappingFaultOfAString, IsMoreThanItHoldsOrAPartOfAByte) {
  MappableObject text = object_of(DataType::visible_string);
  text.string_octets = 4;
  EXPECT_EQ(fault_in_rpdo(0x2000'0020, text), Fault{});
  EXPECT_EQ(fault_in_rpdo(0x2000'0008, text), Fault{});
  EXPECT_EQ(fault_in_rpdo(0x2000'0028, text), MappingFault::wrong_length);
  EXPECT_EQ(fault_in_rpdo(0x2000'000C, text), MappingFault::part_of_a_byte);
  EXPECT_EQ(fault_in_rpdo(0x2000'0000, text), MappingFault::part_of_a_byte);
}

TEST(MappingFaultOfADummy, IsATpdo) {
  EXPECT_EQ(fault_of_dummy(PdoDirection::receive, 0x0005'0008), Fault{});
  EXPECT_EQ(fault_of_dummy(PdoDirection::transmit, 0x0005'0008), MappingFault::dummy_in_tpdo);
}

TEST(MappingFaultOfADummy, IsATypeThatDummyUsageDoesNotList) {
  EXPECT_EQ(fault_of_dummy(PdoDirection::receive, 0x0006'0010), MappingFault::dummy_not_allowed);
}

TEST(MappingFaultOfADummy, IsAnotherLengthThanThatOfItsType) {
  EXPECT_EQ(fault_of_dummy(PdoDirection::receive, 0x0005'0010), MappingFault::wrong_length);
  EXPECT_EQ(fault_of_dummy(PdoDirection::receive, 0x0009'0010), MappingFault::variable_length);
}

TEST(MappingRule, IsOneForEachFault) {
  EXPECT_EQ(rule_of(MappingFault::unknown_object).text(), "pdo-object");
  EXPECT_EQ(rule_of(MappingFault::not_mappable).text(), "pdo-mappable");
  EXPECT_EQ(rule_of(MappingFault::wrong_direction).text(), "pdo-direction");
  EXPECT_EQ(rule_of(MappingFault::wrong_length).text(), "pdo-length");
  EXPECT_EQ(rule_of(MappingFault::variable_length).text(), "pdo-variable-length");
  EXPECT_EQ(rule_of(MappingFault::part_of_a_byte).text(), "pdo-variable-length");
  EXPECT_EQ(rule_of(MappingFault::dummy_in_tpdo).text(), "pdo-dummy");
  EXPECT_EQ(rule_of(MappingFault::dummy_not_allowed).text(), "pdo-dummy");
  EXPECT_EQ(rule_of(MappingFault::too_many_bits).text(), "pdo-size");
  EXPECT_EQ(rule_of(MappingFault::too_many_objects).text(), "pdo-entries");
  EXPECT_TRUE(is_mapping_rule(AnyRule{"pdo-dummy"}));
  EXPECT_FALSE(is_mapping_rule(AnyRule{"pdo-empty"}));
}

}  // namespace
}  // namespace edsc
