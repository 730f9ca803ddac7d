#include "backend/cpp/headers.hpp"

#include <fmt/format.h>

#include "backend/cpp/cpp_view.hpp"
#include "backend/render.hpp"

namespace edsc {

std::vector<OutputFile> headers_of(const Device& device, const Options& options, const std::string& space,
                                   Diagnostics& diagnostics) {
  const CppNames names{device, options, space};
  const nlohmann::ordered_json view = cpp_view({device, names}, options, diagnostics);
  std::vector<OutputFile> headers;
  for (const Template& header : built_in_templates()) {
    if (!is_needed(header, view)) continue;
    headers.push_back({fmt::format("{}/{}", space, header.file_name), render(header.text, view)});
  }
  return headers;
}

}  // namespace edsc
