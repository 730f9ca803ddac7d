/// An XDD or XDC -> data sheet -> EDS or DCF as `edsc format` writes it, which can be read again without new errors.
#include "device/resolve.hpp"
#include "eds/data_sheet.hpp"
#include "format/canonical_form.hpp"
#include "format/document.hpp"
#include "format/sheet_document.hpp"
#include "fuzz.hpp"
#include "text/source_file.hpp"
#include "xdd/read_xdd.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc;
  const SourceFile source{"fuzz.xdd", fuzz::text_of(data, size)};
  if (!is_xml(source)) return 0;
  Diagnostics diagnostics;
  const DataSheet sheet = read_xdd(source, diagnostics);
  fuzz::print(diagnostics);
  if (sheet.objects.empty()) return 0;
  const Device device = resolve_device(sheet, {}, std::nullopt, diagnostics);
  fuzz::print(diagnostics);

  const std::string text = to_text(document_of(sheet, "fuzz.eds"));
  const SourceFile written{"fuzz.eds", text};
  Diagnostics of_written;
  const IniFile ini = parse_ini(written, of_written);
  const DataSheet again = read_data_sheet(ini, of_written);
  fuzz::require(again.objects.size() == sheet.objects.size(), "the EDS of an XDD has all its objects");
  if (diagnostics.errors() > 0) return 0;
  const Device of_again = resolve_device(again, {}, std::nullopt, of_written);
  if (of_written.errors() > 0) {
    std::string findings;
    print_text(findings, of_written, {});
    fuzz::require(false, findings.c_str());
  }
  const std::string canonical = to_text(canonical_form(ini, again, of_again));
  fuzz::require(device.objects.size() == of_again.objects.size(), "the EDS of an XDD describes the same objects");
  const SourceFile formatted{"fuzz.eds", canonical};
  Diagnostics of_formatted;
  const IniFile formatted_ini = parse_ini(formatted, of_formatted);
  const DataSheet formatted_sheet = read_data_sheet(formatted_ini, of_formatted);
  const Device formatted_device = resolve_device(formatted_sheet, {}, std::nullopt, of_formatted);
  fuzz::require(to_text(canonical_form(formatted_ini, formatted_sheet, formatted_device)) == canonical,
                "the canonical form of a canonical form is itself");
  return 0;
}
