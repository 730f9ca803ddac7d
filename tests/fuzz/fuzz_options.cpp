/// An options file for one EDS -> device, findings and the view of the generated code.
#include "backend/cpp/cpp_view.hpp"
#include "backend/cpp/identifier.hpp"
#include "fuzz.hpp"
#include "lint/allow_findings.hpp"
#include "load/load_device.hpp"

namespace edsc::fuzz {
namespace {

const std::string& sheet() {
  static const std::string text = [] {
    std::string problem;
    const auto file = read_source_file(EDSC_SOURCE_DIR "/tests/fixtures/encoder.eds", problem);
    require(file != nullptr, "the EDS is there");
    return std::string{file->text()};
  }();
  return text;
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc;
  LoadedDevice loaded;
  Diagnostics diagnostics;
  loaded.options_source = std::make_unique<SourceFile>("fuzz.options.json", fuzz::text_of(data, size));
  loaded.options = read_options(*loaded.options_source, is_identifier, diagnostics);
  silence_by_options(loaded.options, diagnostics);
  loaded.source = std::make_unique<SourceFile>("fuzz.eds", fuzz::sheet());
  LoadSettings settings;
  settings.name = "device";
  if (size % 2 == 1) settings.node_id = static_cast<std::uint8_t>(size / 2 % 127 + 1);
  resolve_and_check(loaded, settings, diagnostics);
  if (loaded.device && diagnostics.errors() == 0) {
    static_cast<void>(cpp_view(loaded.named(), loaded.options, diagnostics)
                          .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::strict));
  }
  fuzz::print(diagnostics);
  return 0;
}
