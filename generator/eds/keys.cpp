#include "eds/keys.hpp"

#include <fmt/format.h>

#include "diagnostics/quote.hpp"

namespace edsc {

Field make_field(const SourceFile& source, const IniEntry& entry) {
  return {entry.value, value_position(source, entry), true};
}

void report_unknown_key(const SourceFile& source, const IniSection& section, const IniEntry& entry,
                        Diagnostics& diagnostics) {
  diagnostics.warning(
      "unknown-key", key_position(source, entry),
      fmt::format("CiA 306 knows no key {} in section {}; it is left out", quote(entry.key), quote(section.name)));
}

}  // namespace edsc
