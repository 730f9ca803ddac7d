/// Diagnostics as compiler messages and as JSON. Both count columns in code points.
#pragma once

#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// Every finding with its line, then a summary for each file; `with_allowed` adds the number of allowed findings. The
/// source files must still exist.
void print_text(std::string& out, const Diagnostics& diagnostics, bool colour, bool with_allowed = false);
void print_text(std::FILE* out, const Diagnostics& diagnostics, bool colour, bool with_allowed = false);

/// {"version":1, "diagnostics":[...], "allowed_diagnostics":[...], "suppressed":[...], "errors":n, "warnings":n,
/// "notes":n, "allowed":n}. File names may contain bytes that are not UTF-8: dump it with
/// nlohmann::json::error_handler_t::replace.
[[nodiscard]] nlohmann::json print_json(const Diagnostics& diagnostics);

}  // namespace edsc
