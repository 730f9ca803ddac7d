/// Where the documents of edsc are.
#pragma once

#include <string>
#include <string_view>

namespace edsc {

/// The URL of `page`, such as `rules.md`, or of a heading, `rules.md#pdo-length`: below the build option EDSC_DOCS_URL;
/// without it, in share/doc/edsc of the prefix in which this program is installed. Empty if there are no documents.
std::string url_of_document(std::string_view page);

}  // namespace edsc
