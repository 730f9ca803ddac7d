#include "shared/documents.hpp"

#include <filesystem>
#include <system_error>

#include "system/environment.hpp"
#include "system/path.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

/// The URL of the folder of the documents, with a slash at its end; empty if there are none.
std::string find_documents() {
  std::error_code error;
  for (fs::path folder = program_file().parent_path(); folder.has_relative_path(); folder = folder.parent_path()) {
    for (const char* const documents : {"share/doc/edsc/docs", "docs"}) {  // installed; beside the sources
      if (fs::exists(folder / documents / "rules.md", error)) return uri_of_path(from_native(folder / documents)) + "/";
    }
  }
  return {};
}

}  // namespace

std::string url_of_document(std::string_view page) {
  static const std::string folder = std::string_view{EDSC_DOCS_URL}.empty() ? find_documents() : EDSC_DOCS_URL;
  return folder.empty() ? folder : folder + std::string{page};
}

}  // namespace edsc
