/// What an image is compiled for.
#pragma once

namespace canopen {

/// Small rather than fast, as -Os says. All files of an image have to be compiled alike: inline functions are in it once.
#ifdef __OPTIMIZE_SIZE__
inline constexpr bool prefers_size = true;
#else
inline constexpr bool prefers_size = false;
#endif

}  // namespace canopen
