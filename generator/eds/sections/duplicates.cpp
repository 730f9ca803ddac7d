#include "eds/sections/duplicates.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "diagnostics/quote.hpp"

namespace edsc {
namespace {

bool have_same_content(const IniSection& a, const IniSection& b) {
  const auto same = [](const IniEntry& x, const IniEntry& y) {
    return equal_ignoring_case(x.key, y.key) && x.value == y.value;
  };
  return std::equal(a.entries.begin(), a.entries.end(), b.entries.begin(), b.entries.end(), same);
}

}  // namespace

void report_duplicate_section(const SourceFile& source, const IniSection& section, const IniSection& first,
                              Diagnostics& diagnostics) {
  const std::string_view content = have_same_content(section, first) ? "the same" : "different";
  diagnostics.warning(
      "duplicate-section", section_position(source, section),
      fmt::format("duplicate section {} with {} content; using the first", quote(section.name), content),
      {{section_position(source, first), "the first one"}}, std::string{content});
}

void report_duplicate_key(const SourceFile& source, const IniEntry& entry, const Position& first,
                          Diagnostics& diagnostics) {
  diagnostics.warning("duplicate-key", key_position(source, entry),
                      fmt::format("duplicate key {} in this section; using the first", quote(entry.key)),
                      {{first, "the first one"}});
}

}  // namespace edsc
