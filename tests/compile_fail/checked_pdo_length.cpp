// expect: the entry has another length than the object
// expect: canopen::TpdoNumber<1>
// expect: canopen::EntryNumber<2>
// expect: ObjectAt<'2', '6', '0', '0', 'h', ':', '0', '0'>
// expect: other::od::access_ro
//
// The object has 16 bits.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

namespace other::od {
struct access_ro : canopen::Object<0x2600, 0x00, std::uint32_t, canopen::Access::ro, canopen::Mappable::tpdo> {};
}  // namespace other::od

#ifdef GOOD
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, canopen::Tpdo<od::access_rw, od::access_ro>>;
#else
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, canopen::Tpdo<od::access_rw, other::od::access_ro>>;
#endif

static_assert(Checked::holds);
