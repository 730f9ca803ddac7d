#include <gtest/gtest.h>
#include <canopen/pdo/pdo_check.hpp>
#include <canopen/pdo/pdo_compatible.hpp>

#include <array>
#include <cstdint>

#include <sample/pdo.hpp>

namespace {

namespace od = sample::od;

// A mapping of the user's own, for TPDO 2 of the device.
using Motion = canopen::Tpdo<od::position_actual_value, od::statusword, od::inputs::input_1>;
using CheckedMotion =
    canopen::CheckedTpdo<sample::dictionary, 2, Motion, canopen::PdoParameters{.cob_id = 0x280, .plus_node_id = true}>;
static_assert(CheckedMotion::holds);
static_assert(canopen::distinct_cob_ids<sample::CheckedTpdo1, CheckedMotion, sample::CheckedRpdo1>());

// What a controller takes of it.
namespace plc {
struct drive_position : canopen::Object<0x2100, 1, std::int32_t, canopen::Access::rww, canopen::Mappable::rpdo> {};
struct drive_status : canopen::Object<0x2100, 2, std::uint16_t, canopen::Access::rww, canopen::Mappable::rpdo> {};
using Rpdo1 = canopen::Rpdo<drive_position, drive_status>;
}  // namespace plc
static_assert(canopen::compatible<Motion, plc::Rpdo1>);
static_assert(canopen::CompatiblePdos<Motion, plc::Rpdo1>::hold);

TEST(CheckedPdos, AreCodedLikeAnyOther) {
  canopen::Frame frame{.id = 0x285};
  Motion::pack_into(frame, -2, 0x0231, true);
  EXPECT_EQ(frame.size, 7);
  EXPECT_EQ(frame.data, (std::array<std::uint8_t, 8>{0xFE, 0xFF, 0xFF, 0xFF, 0x31, 0x02, 0x01}));
  Motion::set<od::statusword>(frame, 0x0637);
  EXPECT_EQ(plc::Rpdo1::get<plc::drive_status>(frame), 0x0637);
  EXPECT_EQ(plc::Rpdo1::get<plc::drive_position>(frame), -2);
}

TEST(CheckedPdos, KnowTheirCobIds) {
  EXPECT_EQ(CheckedMotion::cob_id.cob_id, 0x280U);
  EXPECT_TRUE(CheckedMotion::cob_id.plus_node_id);
  EXPECT_FALSE(CheckedMotion::cob_id.receive);
}

/// 512 TPDOs and 512 RPDOs, the maximum of a device.
constexpr std::array<canopen::PdoCobId, 1024> many = [] {
  std::array<canopen::PdoCobId, 1024> pdos{};
  for (std::size_t i = 0; i < pdos.size(); ++i) {
    const bool receive = i % 2 != 0;
    pdos[i] = {receive, 0x181 + static_cast<std::uint32_t>(receive ? i / 2 % 64 + 0x200 : i / 2), false};
  }
  return pdos;
}();

TEST(CheckedPdos, MayBeAsManyAsADeviceCanHave) {
  static_assert(!canopen::find_cob_id_clash(many.data(), many.size()).found, "within the limits of the compilers");
  constexpr canopen::CobIdClash clash = [] {
    auto pdos = many;
    pdos[1022].cob_id = pdos[4].cob_id;
    return canopen::find_cob_id_clash(pdos.data(), pdos.size());
  }();
  static_assert(clash.found && clash.first == 4 && clash.second == 1022);
}

}  // namespace
