// expect: integer16_array has the sub-indices 0\.\.3
// The array has three elements.
#include <canopen/od/object_store.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Element = od::integer16_array<3>;
#else
using Element = od::integer16_array<4>;
#endif

static_assert(Element::index == 0x2203);
