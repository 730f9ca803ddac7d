/// The formatter and the comparison: the canonical form of a canonical form is itself and describes the same device; a
/// device does not differ from itself; a DCF and a concise DCF can be read again.
///
/// An input is an EDS, or two with a line `%%` between them.
#include "format/canonical_form.hpp"

#include "compare/compare_devices.hpp"
#include "compare/print_changes.hpp"
#include "device/resolve.hpp"
#include "eds/data_sheet.hpp"
#include "format/dcf/concise_dcf.hpp"
#include "format/dcf/make_dcf.hpp"
#include "format/document.hpp"
#include "fuzz.hpp"
#include "text/source_file.hpp"

namespace edsc::fuzz {
namespace {

/// A file as the commands read it; it owns the text that its parts refer to.
struct Read {
  explicit Read(std::string text, std::optional<std::uint8_t> node_id = {}) : source{"fuzz.eds", std::move(text)} {
    ini = parse_ini(source, diagnostics);
    if (!ini.sections.empty()) {
      sheet = read_data_sheet(ini, diagnostics);
      Diagnostics ignored;
      device = resolve_device(sheet, {}, node_id, ignored);
    }
    names.emplace(device, Options{}, "fuzz");
  }
  Read(const Read&) = delete;
  Read& operator=(const Read&) = delete;

  [[nodiscard]] bool good() const { return !ini.sections.empty() && diagnostics.errors() == 0; }
  [[nodiscard]] std::string canonical() const { return to_text(canonical_form(ini, sheet, device)); }
  [[nodiscard]] std::string dcf() const {
    Document document = canonical_form(ini, sheet, device);
    make_dcf(document, sheet, device, DcfValues::all);
    return to_text(document);
  }

  SourceFile source;
  Diagnostics diagnostics;
  IniFile ini;
  DataSheet sheet;
  Device device;
  std::optional<CppNames> names;

  [[nodiscard]] NamedDevice named() const { return {device, *names}; }
};

void check_concise_dcf(const Read& read) {
  Diagnostics diagnostics;
  const std::string stream = concise_dcf(read.sheet, read.device, diagnostics);
  const auto entries = read_concise_dcf(stream);
  require(entries.has_value(), "a concise DCF is read again");
  unsigned last = 0;
  for (const ConciseEntry& entry : *entries) {
    const unsigned key = (static_cast<unsigned>(entry.index) << 8 | entry.sub_index) + 1;
    require(key > last, "a concise DCF ascends");
    last = key;
  }
}

void check(const Read& read, std::uint8_t node_id) {
  require(compare_devices(read.named(), read.named()).all().empty(), "a device does not differ from itself");
  if (!read.good()) return;
  const std::string text = read.canonical();
  const Read again{text};
  require(again.good(), "a canonical form has no errors");
  require(again.canonical() == text, "the canonical form of a canonical form is itself");
  require(compare_devices(read.named(), again.named()).all().empty(), "a canonical form means the same device");

  const Read of_node{text, node_id};
  check_concise_dcf(of_node);
  const std::string dcf = of_node.dcf();
  const Read from_dcf{dcf};
  require(from_dcf.good(), "a DCF has no errors");
  require(from_dcf.canonical() == dcf, "a DCF is canonical");
  check_concise_dcf(from_dcf);
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc;
  constexpr std::string_view between = "\n%%\n";
  std::string input = fuzz::text_of(data, size);
  const auto node_id = static_cast<std::uint8_t>(size % 127 + 1);
  const std::size_t end = input.find(between);
  if (end == std::string::npos) {
    fuzz::check(fuzz::Read{std::move(input)}, node_id);
    return 0;
  }
  const fuzz::Read before{input.substr(0, end)};
  const fuzz::Read after{input.substr(end + between.size())};
  const Changes changes = compare_devices(before.named(), after.named());
  fuzz::require(changes.all().empty() == compare_devices(after.named(), before.named()).all().empty(),
                "a difference is one from both sides");
  return 0;
}
