/// A file as a git revision has it.
#pragma once

#include <memory>
#include <string>

#include "text/source_file.hpp"

namespace edsc {

struct GitFile {
  std::unique_ptr<SourceFile> source;  ///< null when it cannot be read
  bool is_missing = false;             ///< the revision is known and does not have the file
  std::string error;                   ///< message for the user; empty if there is a source
};

/// Reads `path`, which need not exist now, from `revision` of the repository that its folder is in.
[[nodiscard]] GitFile read_git_file(const std::string& revision, const std::string& path);

}  // namespace edsc
