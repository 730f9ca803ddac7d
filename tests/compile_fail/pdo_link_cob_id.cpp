// expect: the TPDO and the RPDO have different COB-IDs .*sensor::Tpdo1 .*control::Rpdo1
// The RPDO receives 182h, the TPDO is sent with 181h.
#include <canopen_plant/signal.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

namespace sensor {
struct Tpdo1 : canopen::Tpdo<od::unsigned16_value> {
  static constexpr auto parameters = canopen::PdoParameters{.cob_id = 0x181};
};
}  // namespace sensor
namespace control {
struct Rpdo1 : canopen::Rpdo<od::unsigned16_value> {
#ifdef GOOD
  static constexpr auto parameters = canopen::PdoParameters{.cob_id = 0x40000181};
#else
  static constexpr auto parameters = canopen::PdoParameters{.cob_id = 0x182};
#endif
};
}  // namespace control

static_assert(canopen::LinkedPdos<sensor::Tpdo1, control::Rpdo1>::hold);
