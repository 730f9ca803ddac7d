/// A file in a git revision.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "text/source_file.hpp"

namespace edsc {

/// The bytes of a file in a git revision.
struct GitBytes {
  std::optional<std::string> bytes;  ///< nothing if they cannot be read
  bool is_missing = false;           ///< the tree of the revision does not have this path
  std::string error;                 ///< message for the user; empty if there are bytes
};

/// Reads `path`, which need not exist in the working tree, from `revision` of the repository of its folder. Does not
/// fetch objects that the repository does not have, and does not run programs that its configuration names.
[[nodiscard]] GitBytes read_git_bytes(const std::string& revision, const std::string& path);

struct GitFile {
  std::unique_ptr<SourceFile> source;  ///< null if it cannot be read
  bool is_missing = false;             ///< as in GitBytes
  std::string error;                   ///< message for the user; empty if there is a source
};

/// As read_git_bytes(), unpacked if it is a gzip file.
[[nodiscard]] GitFile read_git_file(const std::string& revision, const std::string& path,
                                    const ReadingChoices& choices = {});

}  // namespace edsc
