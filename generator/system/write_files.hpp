/// Writes output files completely or not at all, and does not touch unchanged ones.
#pragma once

#include <string>
#include <vector>

namespace edsc {

struct OutputFile {
  std::string path;
  std::string content;
};

/// Writes all files or none: each goes to a new temporary file in the folder of its target first, and the targets
/// change only when all temporary files are complete and on the disk. If a later target cannot be replaced, the earlier
/// ones get their old content back, as far as the file system can exchange two files.
///
/// - A file with the same content keeps its time stamp. A replaced file keeps its mode, and its owner where possible.
/// - A symlink remains; its target is replaced.
/// - A device, FIFO or socket is not replaced; the content is written into it. The same holds for descriptors of this
///   process, such as /dev/stdout.
/// - A file that is also one of `inputs`, by whatever name, or that two outputs would be, is an error, and nothing is
///   written.
/// - Two processes that write several files into one folder wait for each other, so that the files match.
///
/// Returns an error message; empty on success.
[[nodiscard]] std::string write_files(const std::vector<OutputFile>& files,
                                      const std::vector<std::string>& inputs = {});

}  // namespace edsc
