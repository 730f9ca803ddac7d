#include <gtest/gtest.h>
#include <canopen/pdo/pdo_parameters.hpp>

#include <vector>

namespace {

using canopen::PdoCobId;
using canopen::PdoParameters;

bool is_legal(std::uint32_t cob_id, bool plus_node_id) {
  return canopen::cob_id_is_legal({.cob_id = cob_id, .plus_node_id = plus_node_id});
}

TEST(PdoParameters, HaveACobIdThatNoOtherServiceNeeds) {
  for (const std::uint32_t base : {0x180u, 0x200u, 0x280u, 0x300u, 0x380u, 0x400u, 0x480u, 0x500u}) {
    EXPECT_TRUE(is_legal(base, true)) << base;
  }
  EXPECT_FALSE(is_legal(0x181 - 127, true)) << "of node 127 only";
  EXPECT_FALSE(is_legal(0x580, true)) << "SDO";
  EXPECT_FALSE(is_legal(0x700, true)) << "heartbeat";
  EXPECT_TRUE(is_legal(0x501, true)) << "up to 580h";
  EXPECT_FALSE(is_legal(0x502, true)) << "580h is free, 581h is not";
  EXPECT_TRUE(is_legal(0x580, false));
  EXPECT_FALSE(is_legal(0x000, false));
  EXPECT_TRUE(is_legal(0x181, false));
}

TEST(PdoParameters, HaveACobIdOfElevenBitsUnlessBit29SaysOtherwise) {
  EXPECT_FALSE(is_legal(0x800, false));
  EXPECT_TRUE(is_legal(0x2000'0800, false));
  EXPECT_TRUE(is_legal(0x4000'0180, true)) << "bit 30 is not part of the CAN-ID";
  EXPECT_TRUE(is_legal(0x8000'0700, true)) << "a PDO that is not valid has none";
}

TEST(PdoParameters, HaveATransmissionTypeOfTheirDirection) {
  for (const std::uint32_t type : {0u, 1u, 240u, 254u, 255u}) {
    EXPECT_TRUE(canopen::transmission_type_is_legal(true, type)) << type;
    EXPECT_TRUE(canopen::transmission_type_is_legal(false, type)) << type;
  }
  for (const std::uint32_t type : {241u, 251u, 256u, 510u}) {
    EXPECT_FALSE(canopen::transmission_type_is_legal(true, type)) << type;
    EXPECT_FALSE(canopen::transmission_type_is_legal(false, type)) << type;
  }
  for (const std::uint32_t type : {252u, 253u}) {
    EXPECT_FALSE(canopen::transmission_type_is_legal(true, type)) << type;
    EXPECT_TRUE(canopen::transmission_type_is_legal(false, type)) << type;
  }
}

TEST(PdoParameters, UseTheirTimesWhereTheTransmissionTypeLetsThem) {
  EXPECT_TRUE(canopen::inhibit_time_is_used(false, 254));
  EXPECT_FALSE(canopen::inhibit_time_is_used(false, 1));
  EXPECT_FALSE(canopen::inhibit_time_is_used(false, 253));
  EXPECT_FALSE(canopen::inhibit_time_is_used(true, 255));
  EXPECT_TRUE(canopen::event_timer_is_used(false, 255));
  EXPECT_FALSE(canopen::event_timer_is_used(false, 240));
  EXPECT_FALSE(canopen::event_timer_is_used(false, 252));
  EXPECT_TRUE(canopen::event_timer_is_used(true, 1)) << "it watches the RPDO";
}

// ---- two with the same CAN-ID ----

constexpr PdoCobId tpdo(std::uint32_t cob_id, bool plus_node_id = true) { return {false, cob_id, plus_node_id}; }
constexpr PdoCobId rpdo(std::uint32_t cob_id, bool plus_node_id = true) { return {true, cob_id, plus_node_id}; }

void expect_clash(const std::vector<PdoCobId>& pdos, std::size_t first, std::size_t second) {
  const canopen::CobIdClash clash = canopen::find_cob_id_clash(pdos.data(), pdos.size());
  EXPECT_TRUE(clash.found);
  EXPECT_EQ(clash.first, first);
  EXPECT_EQ(clash.second, second);
}
void expect_none(const std::vector<PdoCobId>& pdos) {
  EXPECT_FALSE(canopen::find_cob_id_clash(pdos.data(), pdos.size()).found);
}

TEST(CobIdsOfPdos, AreDistinctInThePredefinedConnectionSet) {
  expect_none({rpdo(0x200), rpdo(0x300), tpdo(0x180), tpdo(0x280)});
}

TEST(CobIdsOfPdos, OfTwoTpdosDiffer) { expect_clash({tpdo(0x280), tpdo(0x180), tpdo(0x4000'0180)}, 1, 2); }

TEST(CobIdsOfPdos, OfATpdoAndAnRpdoDiffer) { expect_clash({rpdo(0x180), tpdo(0x280), tpdo(0x180)}, 0, 2); }

TEST(CobIdsOfPdos, OfTwoRpdosMayBeTheSame) { expect_none({rpdo(0x200), rpdo(0x200)}); }

TEST(CobIdsOfPdos, AreComparedForEveryNodeId) {
  expect_clash({tpdo(0x180), tpdo(0x181, false)}, 0, 1);
  expect_clash({tpdo(0x1FF, false), tpdo(0x180)}, 0, 1);
  expect_none({tpdo(0x180), tpdo(0x200, false)});
  expect_none({tpdo(0x180), tpdo(0x180, false)});
}

TEST(CobIdsOfPdos, CountWhereThePdoIsValidOnly) { expect_none({tpdo(0x180), tpdo(0x8000'0180)}); }

TEST(CobIdsOfPdos, OfTwentyNineBitsAreOthersThanThoseOfEleven) {
  expect_none({tpdo(0x181, false), tpdo(0x2000'0181, false)});
  expect_clash({tpdo(0x2001'0000, false), rpdo(0x2001'0000, false)}, 0, 1);
}

}  // namespace
