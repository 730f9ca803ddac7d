/// The entries that the text of a failure names.
#pragma once

#include <string_view>
#include <vector>

#include "device/entry_address.hpp"

namespace edsc::conform {

/// The entries that a text names as `1800h:02`, in its order.
[[nodiscard]] std::vector<EntryAddress> entries_in(std::string_view text);

}  // namespace edsc::conform
