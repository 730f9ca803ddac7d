/// Diagnostics as compiler messages and as JSON. Both count columns in code points.
#pragma once

#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

struct TextStyle {
  bool colour = false;
  bool of_check = false;  ///< the summary adds the number of allowed findings, and the effect on `edsc generate`
  bool all = false;       ///< findings that follow from others, and all places of a cause, are listed too
};

/// The findings in the order of report_order() with their lines, then a summary for each file. The source files must
/// still exist.
void print_text(std::string& out, const Diagnostics& diagnostics, const TextStyle& style);
void print_text(std::FILE* out, const Diagnostics& diagnostics, const TextStyle& style);

/// {"schema":2, "diagnostics":[...], "allowed_diagnostics":[...], "suppressed":[...], "causes":n, "errors":n,
/// "warnings":n, "notes":n, "allowed":n}. A finding that follows from another one has its index in "diagnostics" as
/// `follows_from`. File names may contain bytes that are not UTF-8: dump it with
/// nlohmann::json::error_handler_t::replace.
[[nodiscard]] nlohmann::json print_json(const Diagnostics& diagnostics);

}  // namespace edsc
