#include "system/windows/cancelled_read.hpp"

#include <windows.h>

#include <io.h>

#include <algorithm>
#include <atomic>

#include "system/windows/last_error.hpp"

namespace edsc {
namespace {

constexpr std::size_t read_at_once = std::size_t{1} << 20;
constexpr DWORD until_next_try_ms = 10;

std::atomic<bool> is_cancelled = false;
std::atomic<HANDLE> reading_thread = nullptr;

/// A handle of this thread for other threads.
HANDLE handle_of_this_thread() {
  HANDLE handle = nullptr;
  DuplicateHandle(GetCurrentProcess(), GetCurrentThread(), GetCurrentProcess(), &handle, THREAD_TERMINATE, FALSE, 0);
  return handle;
}

/// Whether the error is the end of the input, and not a problem.
bool is_end(DWORD error) { return error == ERROR_BROKEN_PIPE || error == ERROR_OPERATION_ABORTED; }

}  // namespace

std::ptrdiff_t read_or_cancel(int descriptor, char* to, std::size_t most) {
  static const HANDLE self = handle_of_this_thread();
  reading_thread = self;
  DWORD count = 0;
  BOOL done = TRUE;
  if (!is_cancelled) {
    done = ReadFile(reinterpret_cast<HANDLE>(_get_osfhandle(descriptor)), to,
                    static_cast<DWORD>(std::min(most, read_at_once)), &count, nullptr);
  }
  const bool has_failed = done == FALSE && !is_end(GetLastError());
  const int error = has_failed ? last_error_number() : 0;
  reading_thread = nullptr;
  return has_failed ? -error : static_cast<std::ptrdiff_t>(is_cancelled ? 0 : count);
}

// A read that begins after this function has looked at it is not cancelled at once.
void cancel_reads() {
  is_cancelled = true;
  while (const HANDLE thread = reading_thread) {
    CancelSynchronousIo(thread);
    Sleep(until_next_try_ms);
  }
}

}  // namespace edsc
