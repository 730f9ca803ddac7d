/// The memory of programs with several threads. POSIX.
#pragma once

namespace edsc {

/// From now on, all threads take memory from one place. Otherwise each keeps what it has used once, for itself. Before
/// the first thread is started; without effect on a C library that does not do so.
void share_memory_between_threads();

}  // namespace edsc
