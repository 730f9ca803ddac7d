#include "edit/edited_file.hpp"

#include <string_view>
#include <utility>

#include "edit/edited_network.hpp"
#include "edit/edited_sheet.hpp"
#include "json/json_ranges.hpp"
#include "network/network_members.hpp"
#include "text/ascii.hpp"

namespace edsc::edit {

std::unique_ptr<const EditedFile> open_edited_file(EditedFileSettings settings, const std::string& bytes,
                                                   std::string& problem) {
  const SourceFile source{settings.path, bytes};
  const std::string_view text = source.text();
  const std::size_t first = after_json_blanks(text, 0);
  const bool is_json = ends_with_ignoring_case(settings.path, ".json") || text.substr(first).starts_with('{');
  if (is_json && is_network_text(text)) return open_edited_network(settings, bytes);
  return open_edited_sheet(std::move(settings), bytes, problem);
}

}  // namespace edsc::edit
