/// A hook for tests: which objects the application of a node, its handlers and its profiles use. Accesses by SDO, PDOs
/// and the storage are not reported. A program without CANOPEN_ACCESS_PROBE does not pay for it.
#pragma once

#ifdef CANOPEN_ACCESS_PROBE
#include CANOPEN_ACCESS_PROBE  // defines canopen::AccessProbe
#else

#include <cstdint>

namespace canopen {

/// `uses(index, sub_index)` is called at each access. A program defines CANOPEN_ACCESS_PROBE, as the header of its own
/// class, for all of its sources.
template <class Device>
struct AccessProbe {
  static constexpr void uses(std::uint16_t, std::uint8_t) {}
};

}  // namespace canopen

#endif
