/// A device in a git revision.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "load/load_device.hpp"
#include "shared/git_file.hpp"

namespace edsc {

inline constexpr std::string_view git_prefix = "git:";

/// Whether an argument has the form `git:REF`.
[[nodiscard]] inline bool names_git_revision(std::string_view argument) {
  return argument.starts_with(git_prefix) && argument.size() > git_prefix.size();
}

/// The device of a file of a revision, whose source was read, with the options file beside it in the same revision.
/// `settings.path` is that of the file in the working tree.
[[nodiscard]] std::unique_ptr<LoadedDevice> load_git_device(GitFile committed, const std::string& revision,
                                                            const LoadSettings& settings, Diagnostics& diagnostics);

}  // namespace edsc
