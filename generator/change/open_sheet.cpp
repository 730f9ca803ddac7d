#include "change/open_sheet.hpp"

#include <utility>

#include "device/pdo/locked_parameters.hpp"
#include "device/resolve.hpp"
#include "format/canonical_form.hpp"
#include "lint/allow_findings.hpp"
#include "lint/check_device.hpp"

namespace edsc {

std::unique_ptr<OpenSheet> open_sheet(std::string name, std::string bytes, const Options& options, SheetChecks checks) {
  auto open = std::make_unique<OpenSheet>();
  open->options = options;
  open->checks = checks;
  open->source = std::make_shared<SourceFile>(std::move(name), bytes, Packing::none, options.reading);
  open->bytes = std::move(bytes);
  if (checks == SheetChecks::all) {
    open->diagnostics.collect_remedies();
    silence_by_options(options, open->diagnostics);
    allow_by_options(options, open->diagnostics);
    allow_by_comments(*open->source, options, open->diagnostics);
  }
  open->ini = parse_ini(*open->source, open->diagnostics);
  open->sheet = read_data_sheet(open->ini, open->diagnostics);
  if (open->sheet.objects.empty()) return open;
  open->device = resolve_device(open->sheet, open->options, {}, open->diagnostics);
  imply_options(*open->device, open->options, open->diagnostics);
  open->names.emplace(*open->device, open->options);
  if (checks == SheetChecks::all) {
    check_device(NamedDevice{*open->device, *open->names}, open->sheet, open->options, open->diagnostics);
  }
  return open;
}

bool is_canonical(const OpenSheet& sheet) {
  return sheet.device && sheet.source->is_verbatim() &&
         is_canonical_form(sheet.source->text(), sheet.ini, sheet.sheet, *sheet.device);
}

std::string canonical_text(const OpenSheet& sheet) {
  return to_text(canonical_form(sheet.ini, sheet.sheet, *sheet.device));
}

}  // namespace edsc
