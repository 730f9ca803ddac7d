/// The errors that a change of a file adds.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// The errors that a file has after a change and not before, by rule and message. `is_renamed`: the change renames
/// something, which changes the text of its errors; those of a rule are then new only as far as there are more of them.
/// `calculated`: rules whose messages have results, such as a bus load; numbers before a unit are not compared.
[[nodiscard]] std::vector<Diagnostic> new_errors(const Diagnostics& after, const Diagnostics& before, bool is_renamed,
                                                 std::span<const std::string_view> calculated = {});

}  // namespace edsc
