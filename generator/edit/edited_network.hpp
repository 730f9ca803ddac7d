/// A network file that is edited.
#pragma once

#include <memory>
#include <string>

#include "edit/edited_file.hpp"

namespace edsc::edit {

/// A text that is not JSON is read too: its findings say why, and it is not changed.
[[nodiscard]] std::unique_ptr<const EditedFile> open_edited_network(const EditedFileSettings& settings,
                                                                    const std::string& bytes);

}  // namespace edsc::edit
