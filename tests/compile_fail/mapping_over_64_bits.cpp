// expect: longer than its 64 bits
// expect: PdoEntry<canopen::EntryNumber<2>
// expect: every_type::od::unsigned8_value
//
// A CAN frame has at most 64 data bits.
#include <canopen/od/object_store.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Mapping = canopen::Tpdo<od::integer56_value, od::unsigned8_value>;
#else
using Mapping = canopen::Tpdo<od::integer64_value, od::unsigned8_value>;
#endif

static_assert(Mapping::entries == 2);
