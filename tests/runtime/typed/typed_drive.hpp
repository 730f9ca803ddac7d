/// The device of tests/fixtures/typed_drive.eds with the meaning of its objects, as edsc generates it: each object
/// keeps its base, the type of its raw number, and has another `type`.
#ifndef EDSC_TYPED_DRIVE_HPP
#define EDSC_TYPED_DRIVE_HPP

#include <canopen/base/constant_errors.hpp>
//
#include <cstdint>
#include <untyped_drive/device.hpp>

#include "meaning.hpp"

namespace typed_drive {

namespace od {

struct setpoint : untyped_drive::od::setpoint {
  using type = meaning::temperature;
  static constexpr type low_limit{canopen::raw(std::int16_t{0})};
  static constexpr type high_limit{canopen::raw(std::int16_t{900})};
};
struct temperature : untyped_drive::od::temperature {
  using type = meaning::temperature;
};
struct heater_state : untyped_drive::od::heater_state {
  using type = meaning::heater_state;
  using value = type;
  static constexpr bool is_value(type value) {
    switch (value) {
      case type::off:
      case type::heating:
      case type::cooling: return true;
    }
    return false;
  }
};
struct door : untyped_drive::od::door {
  using type = meaning::door;
};
struct total_energy : untyped_drive::od::total_energy {
  using type = meaning::energy;
};
template <std::uint8_t SubIndex = canopen::whole_array>
struct zone_temperature : untyped_drive::od::zone_temperature<SubIndex> {
  using type = meaning::temperature;
  static constexpr type low_limit{canopen::raw(std::int16_t{-400})};
  static constexpr type high_limit{canopen::raw(std::int16_t{1200})};
};
template <>
struct zone_temperature<0> : untyped_drive::od::zone_temperature<0> {};
struct cooling_depth : untyped_drive::od::cooling_depth {
  using type = meaning::depth;
};
struct controlword : untyped_drive::od::controlword {
  using type = meaning::controlword;
};
struct statusword : untyped_drive::od::statusword {
  using type = meaning::statusword;
};
struct modes_of_operation : untyped_drive::od::modes_of_operation {
  using type = meaning::mode;
  using value = type;
};
struct modes_of_operation_display : untyped_drive::od::modes_of_operation_display {
  using type = meaning::mode;
  using value = type;
};
struct target_position : untyped_drive::od::target_position {
  using type = meaning::position;
};

}  // namespace od

using Rpdo1 = canopen::Rpdo<od::controlword, od::modes_of_operation, od::target_position, od::heater_state>;
using Rpdo2 = canopen::Rpdo<od::heater_state, od::setpoint, od::controlword>;
using Tpdo1 = canopen::Tpdo<od::statusword, od::modes_of_operation_display, od::temperature, od::door, od::setpoint>;

struct Device : untyped_drive::Device {
  using Objects =
      canopen::ObjectRows<untyped_drive::od::device_type, untyped_drive::od::error_register, od::setpoint,
                          od::temperature, od::heater_state, od::door, od::total_energy,
                          canopen::ArrayObjects<od::zone_temperature, 4>, od::cooling_depth, od::controlword,
                          od::statusword, od::modes_of_operation, od::modes_of_operation_display, od::target_position>;
  using ClosedObjects = canopen::ObjectList<od::heater_state>;
  using Rpdos = canopen::PdoList<canopen::NumberedPdo<1, Rpdo1>, canopen::NumberedPdo<2, Rpdo2>>;
  using Tpdos = canopen::PdoList<canopen::NumberedPdo<1, Tpdo1>>;
};

}  // namespace typed_drive

#endif  // EDSC_TYPED_DRIVE_HPP
