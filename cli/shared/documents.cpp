#include "shared/documents.hpp"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <system_error>

#include "system/path.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

std::string file_url(std::string_view path) {
  std::string url = "file://";
  for (const char byte : path) {
    const auto code = static_cast<unsigned char>(byte);
    const bool is_plain = std::isalnum(code) != 0 || std::string_view{"/-._~"}.find(byte) != std::string_view::npos;
    url += is_plain ? std::string{byte} : fmt::format("%{:02X}", code);
  }
  return url;
}

/// The URL of the folder of the documents, with a slash at its end; empty if there are none.
std::string find_documents() {
  std::error_code error;
  for (fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path(); !error && folder.has_relative_path();
       folder = folder.parent_path()) {
    for (const char* const documents : {"share/doc/edsc/docs", "docs"}) {  // installed; beside the sources
      if (fs::exists(folder / documents / "rules.md", error)) return file_url(from_native(folder / documents)) + "/";
    }
    error.clear();
  }
  return {};
}

}  // namespace

std::string url_of_document(std::string_view page) {
  static const std::string folder = std::string_view{EDSC_DOCS_URL}.empty() ? find_documents() : EDSC_DOCS_URL;
  return folder.empty() ? folder : folder + std::string{page};
}

}  // namespace edsc
