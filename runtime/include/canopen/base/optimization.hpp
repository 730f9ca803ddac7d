/// The optimization goal of an image: size or speed.
#pragma once

#include "canopen/base/same_in_all_files.hpp"

namespace canopen {

/// True if compiled for size (-Os). It selects algorithms, and members of a node. All files of an image must be
/// compiled alike: the linker keeps one copy of an inline function, and a file would access a node of another file at
/// offsets that the node does not have. Such files are not linked: base/same_in_all_files.hpp.
#ifdef __OPTIMIZE_SIZE__
inline constexpr bool prefers_size = true;
CANOPEN_SAME_IN_ALL_FILES("canopen_optimization_goal", "2");
#else
inline constexpr bool prefers_size = false;
CANOPEN_SAME_IN_ALL_FILES("canopen_optimization_goal", "1");
#endif

}  // namespace canopen
