/// A read that another thread can end: Windows calls the handler of Ctrl-C in a thread of its own.
#pragma once

#include <cstddef>

namespace edsc {

/// Reads at most `most` bytes. Returns their number, 0 at the end or if the read was cancelled, and the negated error
/// number if reading fails. Only one thread may call this function.
[[nodiscard]] std::ptrdiff_t read_or_cancel(int descriptor, char* to, std::size_t most);

/// Ends a waiting read, and all later ones.
void cancel_reads();

}  // namespace edsc
