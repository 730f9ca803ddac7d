/// Files in folders.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edsc {

enum class Subfolders : std::uint8_t { searched, left_out };

struct FoundFiles {
  std::vector<std::string> paths;     ///< ascending; below `folder` as it was given, without "./"
  std::vector<std::string> problems;  ///< each folder that cannot be read, and why
};

/// The files in `folder` with one of these extensions, in any letter case. A hidden subfolder, such as that of git, is
/// not searched, and a link to a folder is not followed.
[[nodiscard]] FoundFiles find_files(const std::string& folder, std::span<const std::string_view> extensions,
                                    Subfolders subfolders = Subfolders::searched);

}  // namespace edsc
