/// The page of edsc edit.
#pragma once

#include <string>

namespace edsc {

/// The page, without a server and without data of a file: it reads the file from `state` beside it. It has the
/// placeholder `{{{nonce}}}` for its script and its style.
[[nodiscard]] std::string edit_page();

}  // namespace edsc
