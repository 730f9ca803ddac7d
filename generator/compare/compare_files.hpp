/// The files with the values of DOMAINs.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "compare/change.hpp"
#include "device/device.hpp"

namespace edsc {

/// The bytes of a file that the EDS of a device names; nothing if it cannot be read.
using FileReader = std::function<std::optional<std::string>(const Device& device, const std::string& name)>;

/// Adds a change for each DOMAIN in both devices whose UploadFile or DownloadFile has other bytes. Where a file cannot
/// be read, the names are compared.
void compare_files(const Device& before, const Device& after, const FileReader& read, Changes& changes);

}  // namespace edsc
