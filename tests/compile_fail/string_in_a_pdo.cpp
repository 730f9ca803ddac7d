// expect: no value without a fixed length
// expect: PdoEntry<canopen::EntryNumber<2>, canopen::ObjectAt<'2', '0', '0', '9', 'h', ':', '0', '0'>
// expect: every_type::od::visible_string_value
//
// A string is a variable-length data type.
#include <canopen/od/object_store.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Mapping = canopen::PdoLayout<od::access_ro, od::unsigned8_value>;
#else
using Mapping = canopen::PdoLayout<od::access_ro, od::visible_string_value>;
#endif

static_assert(Mapping::entries == 2);
