/// The complete path: EDS and options -> device -> findings, JSON and generated files, with or without errors.
///
/// An input is an EDS; one that begins with `{` is an options file, a line `%%` and an EDS. Each odd length means a
/// node-ID. Every fourth input is rendered: rendering takes most of the time and finds the least.
#include "backend/cpp/cpp_view.hpp"
#include "backend/cpp/identifier.hpp"
#include "backend/json/device_view.hpp"
#include "backend/render.hpp"
#include "fuzz.hpp"
#include "lint/allow_findings.hpp"
#include "load/load_device.hpp"

namespace edsc::fuzz {
namespace {

constexpr std::string_view options_end = "\n%%\n";

/// Sets the source, and the options if the input has some.
void split(const std::string& input, LoadedDevice& loaded, Diagnostics& diagnostics) {
  const std::size_t end = input.starts_with('{') ? input.find(options_end) : std::string::npos;
  if (end == std::string::npos) {
    loaded.source = std::make_unique<SourceFile>("fuzz.eds", input);
    return;
  }
  loaded.options_source = std::make_unique<SourceFile>("fuzz.options.json", input.substr(0, end));
  loaded.options = read_options(*loaded.options_source, is_identifier, diagnostics);
  silence_by_options(loaded.options, diagnostics);
  loaded.source = std::make_unique<SourceFile>("fuzz.eds", input.substr(end + options_end.size()));
}

void generate(const LoadedDevice& loaded, bool rendered, Diagnostics& diagnostics) {
  static_cast<void>(device_view(*loaded.device, loaded.names->identifiers())
                        .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::strict));
  const nlohmann::ordered_json view = cpp_view(loaded.named(), loaded.options, diagnostics);
  if (!rendered) return;
  for (const Template& one : built_in_templates()) {
    require(render(one.text, view).ends_with("\n"), "a generated file ends with a line end");
  }
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc;
  LoadedDevice loaded;
  Diagnostics diagnostics;
  fuzz::split(fuzz::text_of(data, size), loaded, diagnostics);
  LoadSettings settings;
  settings.name = "device";
  if (size % 2 == 1) settings.node_id = static_cast<std::uint8_t>(size / 2 % 127 + 1);
  resolve_and_check(loaded, settings, diagnostics);
  if (loaded.device) fuzz::generate(loaded, size / 2 % 4 == 0, diagnostics);
  fuzz::print(diagnostics);
  return 0;
}
