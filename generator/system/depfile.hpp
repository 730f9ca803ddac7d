/// Dependencies of generated files, for make and ninja.
#pragma once

#include <string>
#include <vector>

#include "system/write_files.hpp"

namespace edsc {

/// A make rule: `target`, or the outputs if it is empty, depend on the inputs. Throws
/// std::runtime_error for a path that make and ninja do not read alike, such as one with a line end.
[[nodiscard]] std::string depfile_text(const std::string& target, const std::vector<OutputFile>& outputs,
                                       const std::vector<std::string>& inputs);

}  // namespace edsc
