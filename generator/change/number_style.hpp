/// New values in the notation of those that they replace.
#pragma once

#include <string>
#include <string_view>

namespace edsc {

/// A number or formula with the notation of another one: base and digits, the operands of `$NODEID+0x180` in the same
/// order. `64h` is also a number. Other texts are unchanged, and so is a number in place of 0 or of another text.
[[nodiscard]] std::string restyled(std::string_view value, std::string_view like);

}  // namespace edsc
