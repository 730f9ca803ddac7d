/// Files written whole or not at all, and not touched when unchanged.
#pragma once

#include <string>
#include <vector>

namespace edsc {

struct OutputFile {
  std::string path;
  std::string content;
};

/// Writes all files or none: each goes to a temporary file beside its target first, and the targets change only when all of
/// those are complete. A file with the same content keeps its time stamp. Returns what went wrong; empty when nothing did.
[[nodiscard]] std::string write_files(const std::vector<OutputFile>& files);

}  // namespace edsc
