/// The meaning of an entry as lines of its doc comment.
#pragma once

#include <nlohmann/json.hpp>

#include "device/device.hpp"

namespace edsc {

/// Unit, scale, limits and default value as physical values; the names of values, bits and masked values; the text and
/// the place in the manual. Empty without a meaning.
[[nodiscard]] nlohmann::ordered_json meaning_lines(const Entry& entry);

}  // namespace edsc
