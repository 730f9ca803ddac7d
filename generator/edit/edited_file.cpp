#include "edit/edited_file.hpp"

#include <utility>

#include "edit/edited_sheet.hpp"

namespace edsc::edit {

std::unique_ptr<const EditedFile> open_edited_file(EditedFileSettings settings, const std::string& bytes,
                                                   std::string& problem) {
  return open_edited_sheet(std::move(settings), bytes, problem);
}

}  // namespace edsc::edit
