// expect: every_type::od::integer24_value|integer24_value::type
// A speed is not a position, and a struct is not a number.
#include <canopen/od/object_store.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

struct Speed {
  int value;
};

#ifdef GOOD
constexpr auto data = every_type::Tpdo1::pack(1, true, Speed{2}.value);
#else
constexpr auto data = every_type::Tpdo1::pack(1, true, Speed{2});
#endif

static_assert(data[0] == 1);
