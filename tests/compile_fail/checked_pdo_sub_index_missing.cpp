// expect: the object has no such sub-index
// expect: canopen::TpdoNumber<1>
// expect: canopen::EntryNumber<1>
// expect: ObjectAt<'2', '6', '0', '0', 'h', ':', '0', '1'>
// expect: other::od::access_ro_1
//
// 2600h is a VAR.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

namespace other::od {
struct access_ro_1 : canopen::Object<0x2600, 0x01, std::uint16_t, canopen::Access::ro, canopen::Mappable::tpdo> {};
}  // namespace other::od

#ifdef GOOD
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, canopen::Tpdo<od::access_ro>>;
#else
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, canopen::Tpdo<other::od::access_ro_1>>;
#endif

static_assert(Checked::holds);
