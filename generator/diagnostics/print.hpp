/// Diagnostics for people (like a compiler's) and for programs (JSON). Both count columns in code points.
#pragma once

#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// Every finding with its line, then a sum for each file, `with_allowed` with the number of those that are allowed. The
/// source files must still live.
void print_text(std::string& out, const Diagnostics& diagnostics, bool colour, bool with_allowed = false);
void print_text(std::FILE* out, const Diagnostics& diagnostics, bool colour, bool with_allowed = false);

/// {"version":1, "diagnostics":[...], "allowed_diagnostics":[...], "suppressed":[...], "errors":n, "warnings":n, "notes":n,
/// "allowed":n}. A file name may hold what is not
/// UTF-8: dump it with nlohmann::json::error_handler_t::replace.
[[nodiscard]] nlohmann::json print_json(const Diagnostics& diagnostics);

}  // namespace edsc
