/// The meaning of entries and error codes in the JSON view of a device.
#pragma once

#include <canopen/od/data_type.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "device/meaning/meaning.hpp"

namespace edsc {

/// All that is known about the values of an entry of this type, with the source of each part.
[[nodiscard]] nlohmann::ordered_json meaning_view(const Meaning& meaning, const canopen::DataTypeRow& type);

[[nodiscard]] nlohmann::ordered_json error_codes_view(const std::vector<ErrorCodeName>& codes);

}  // namespace edsc
