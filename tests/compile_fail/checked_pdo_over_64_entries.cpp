// expect: 64 objects at most .*canopen::TpdoNumber<2> .*every_type::od::boolean_value
// A mapping parameter has at most 64 entries.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

template <class>
struct Switches;
template <std::size_t... I>
struct Switches<std::index_sequence<I...>> {
  template <std::size_t>
  using Switch = od::boolean_value;
  using type = canopen::Tpdo<Switch<I>...>;
};

#ifdef GOOD
using Mapping = Switches<std::make_index_sequence<64>>::type;
#else
using Mapping = Switches<std::make_index_sequence<65>>::type;
#endif

using Checked = canopen::CheckedTpdo<every_type::dictionary, 2, Mapping>;
static_assert(Checked::holds);
