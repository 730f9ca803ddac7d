/// Bytes -> text -> INI lines.
#include <nlohmann/json.hpp>

#include "eds/ini.hpp"
#include "fuzz.hpp"
#include "text/source_file.hpp"
#include "text/utf8.hpp"

namespace edsc::fuzz {
namespace {

void check_part(const SourceFile& source, std::string_view part, std::uint32_t line, std::uint32_t column) {
  require(source.line(line).substr(column - 1, part.size()) == part, "a part of a line stands where it says");
}

void check(const SourceFile& source, const IniFile& ini) {
  std::uint32_t last_line = 0;
  for (const IniSection& section : ini.sections) {
    require(section.line > last_line, "sections stand in the order of the file");
    last_line = section.line;
    check_part(source, section.name, section.line, section.column);
    for (const IniEntry& entry : section.entries) {
      require(entry.line > last_line, "entries stand in the order of the file");
      last_line = entry.line;
      check_part(source, entry.key, entry.line, entry.key_column);
      check_part(source, entry.value, entry.line, entry.value_column);
    }
  }
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc;
  const SourceFile source{"fuzz.eds", fuzz::text_of(data, size)};
  fuzz::require(is_utf8(source.text()), "text is UTF-8");
  Diagnostics diagnostics;
  fuzz::check(source, parse_ini(source, diagnostics));
  fuzz::print(diagnostics);
  static_cast<void>(print_json(diagnostics).dump());
  return 0;
}
