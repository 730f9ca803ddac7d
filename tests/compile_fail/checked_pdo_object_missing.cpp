// expect: the device has no such object
// expect: canopen::TpdoNumber<1>
// expect: canopen::EntryNumber<2>
// expect: ObjectAt<'6', '0', '7', '1', 'h', ':', '0', '0'>
// expect: other::od::target_torque
//
// The device does not have 6071h.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

namespace other::od {
struct target_torque : canopen::Object<0x6071, 0x00, std::int16_t, canopen::Access::ro, canopen::Mappable::tpdo> {};
}  // namespace other::od

#ifdef GOOD
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, canopen::Tpdo<od::access_ro, od::access_rwr>>;
#else
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, canopen::Tpdo<od::access_ro, other::od::target_torque>>;
#endif

static_assert(Checked::holds);
