/// The optimization goal of an image: size or speed.
#pragma once

namespace canopen {

/// True if compiled for size (-Os). All files of an image must be compiled alike: the linker keeps one copy of an
/// inline function.
#ifdef __OPTIMIZE_SIZE__
inline constexpr bool prefers_size = true;
#else
inline constexpr bool prefers_size = false;
#endif

}  // namespace canopen
