/// An EDS or DCF that is edited, also by an overlay.
#pragma once

#include <memory>
#include <string>

#include "edit/edited_file.hpp"

namespace edsc::edit {

/// As open_edited_file().
[[nodiscard]] std::unique_ptr<const EditedFile> open_edited_sheet(EditedFileSettings settings, const std::string& bytes,
                                                                  std::string& problem);

}  // namespace edsc::edit
