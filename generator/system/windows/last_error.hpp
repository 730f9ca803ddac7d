/// Errors of Windows as error numbers of C, whose texts are the same on all systems.
#pragma once

namespace edsc {

/// The error number for GetLastError().
[[nodiscard]] int last_error_number();

/// Sets errno to it. Returns false.
bool fail_with_last_error();

}  // namespace edsc
