/// A file in a git revision.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "text/source_file.hpp"

namespace edsc {

struct GitFile {
  std::unique_ptr<SourceFile> source;  ///< null if it cannot be read
  bool is_missing = false;             ///< the revision exists, but does not contain the file
  std::string error;                   ///< message for the user; empty if there is a source
};

/// Reads `path`, which need not exist in the working tree, from `revision` of the repository of its folder.
[[nodiscard]] GitFile read_git_file(const std::string& revision, const std::string& path,
                                    const ReadingChoices& choices = {});

/// The bytes of a file in a git revision; nothing if it cannot be read.
[[nodiscard]] std::optional<std::string> read_git_bytes(const std::string& revision, const std::string& path);

}  // namespace edsc
