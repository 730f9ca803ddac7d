// expect: the entry of the TPDO is at other bits than that of the RPDO .*sensor::Tpdo1 .*control::Rpdo1
#include <canopen_plant/signal.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

namespace sensor {
struct Tpdo1 : canopen::Tpdo<od::unsigned16_value, od::unsigned16_value> {};
}  // namespace sensor
namespace control {
struct Rpdo1 : canopen::Rpdo<od::unsigned16_value, od::unsigned16_value> {};
}  // namespace control

#ifdef GOOD
struct Position : canopen::ReceivedSignal<0, sensor::Tpdo1, 1, control::Rpdo1, 1> {};
#else
struct Position : canopen::ReceivedSignal<0, sensor::Tpdo1, 1, control::Rpdo1, 0> {};
#endif
