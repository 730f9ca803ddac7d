// expect: without a fixed length
// expect: canopen::EntryNumber<1>
// expect: ObjectAt<'2', '0', '0', '0', 'h', ':', '0', '0'>
// expect: mapped_strings::od::state
// expect: canopen::TpdoNumber<1>
//
// A string is a variable-length data type.
#include <canopen/pdo/pdo_check.hpp>
#include <mapped_strings/device.hpp>

namespace od = mapped_strings::od;

#ifdef GOOD
using Checked = canopen::CheckedTpdo<mapped_strings::dictionary, 1, canopen::Tpdo<canopen::FixedString<od::state, 5>>>;
#else
using Checked = canopen::CheckedTpdo<mapped_strings::dictionary, 1, canopen::Tpdo<od::state>>;
#endif

static_assert(Checked::holds);
