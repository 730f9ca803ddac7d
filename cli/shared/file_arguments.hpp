/// FILE arguments that may be folders.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "load/sheet_extensions.hpp"

namespace edsc {

/// Whether files of a folder that edsc has written, such as the DCFs of a network, are among them.
enum class WrittenByEdsc : std::uint8_t { taken, skipped };

/// Replaces each folder by its files with one of these extensions (in any letter case), in its subfolders too,
/// ascending by path. Hidden folders are not searched. Ends the command if a folder has no such file or cannot be read.
[[nodiscard]] std::vector<std::string> expand_folders(const std::vector<std::string>& paths,
                                                      std::span<const std::string_view> extensions = sheet_extensions,
                                                      WrittenByEdsc written = WrittenByEdsc::taken);

}  // namespace edsc
