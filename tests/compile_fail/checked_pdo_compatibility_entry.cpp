// expect: sub-index 4 of its communication parameter is reserved .*canopen::TpdoNumber<2>
// The device has 1801h:04.
#include <canopen/pdo/pdo_check.hpp>
#include <mapped_strings/device.hpp>

namespace od = mapped_strings::od;

#ifdef GOOD
using Checked = canopen::CheckedTpdo<mapped_strings::dictionary, 1, canopen::Tpdo<od::speed>>;
#else
using Checked = canopen::CheckedTpdo<mapped_strings::dictionary, 2, canopen::Tpdo<od::speed>>;
#endif

static_assert(Checked::holds);
