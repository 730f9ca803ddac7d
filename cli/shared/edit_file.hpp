/// Changes of an EDS or DCF by a command: reads, changes, and writes the file.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "change/change.hpp"
#include "change/open_sheet.hpp"
#include "shared/common_options.hpp"

namespace edsc {

/// The options of commands that change a file.
struct EditSettings {
  std::string path;
  bool dry_run = false;
  bool force = false;
  bool utf8 = false;
  bool stamp = false;
  ColorOption color;

  void add_to(Command command);
};

/// The options of the file beside `path`, or none. Ends the command if they have errors.
[[nodiscard]] Options options_beside(const std::string& path);

/// Reads an EDS or DCF with the options beside it. Ends the command for another kind of file.
[[nodiscard]] std::unique_ptr<OpenSheet> open_file(const std::string& path);

/// Makes the changes of a file and writes it; with `--dry-run` prints them as a unified diff. Returns the exit code.
[[nodiscard]] int edit_file(const EditSettings& settings, const OpenSheet& file,
                            const std::vector<SheetChange>& changes);

}  // namespace edsc
