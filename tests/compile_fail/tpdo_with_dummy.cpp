// expect: a TPDO may not carry this object .*canopen::EntryNumber<2> .*canopen::Dummy<5, 8>
// A dummy reserves bits in an RPDO that the device ignores.
#include <canopen/pdo/pdo.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Mapping = canopen::Rpdo<od::access_rw, canopen::Dummy<0x0005, 8>>;
#else
using Mapping = canopen::Tpdo<od::access_rw, canopen::Dummy<0x0005, 8>>;
#endif

static_assert(Mapping::entries == 2);
