// expect: this PDO does not map the object .*ObjectAt<'2', '6', '0', '2', 'h', ':', '0', '0'>
// expect: every_type::od::access_rw>
// TPDO 1 does not map it.
#include <canopen/pdo/pdo.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
auto get(const canopen::Frame& frame) { return every_type::Tpdo1::get<od::access_rwr>(frame); }
#else
auto get(const canopen::Frame& frame) { return every_type::Tpdo1::get<od::access_rw>(frame); }
#endif
