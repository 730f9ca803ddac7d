/// An overlay of a fixed EDS -> the composed text, its data sheet, and an overlay that is derived from the result. An
/// overlay whose base is an overlay has a line `%%` and the second one after it.
#include "eds/data_sheet.hpp"
#include "fuzz.hpp"
#include "overlay/compose_overlay.hpp"
#include "overlay/derive_overlay.hpp"
#include "overlay/overlay_file.hpp"

namespace edsc::fuzz {
namespace {

constexpr std::string_view between = "\n%%\n";

std::string base_text() {
  static const std::string text = [] {
    std::string problem;
    const auto file = read_source_file(EDSC_SOURCE_DIR "/tests/fuzz/overlay_seeds/base.eds", problem);
    require(file != nullptr, "the base is there");
    return std::string{file->text()};
  }();
  return text;
}

/// Each line of a composed text is the line of a file that was read, or a part of it.
void check_origins(const ComposedOverlay& composed) {
  for (std::uint32_t line = 1; line <= composed.text->lines(); ++line) {
    const LineOrigin origin = composed.text->origin(line);
    require(origin.file != nullptr && origin.line >= 1 && origin.line <= origin.file->lines(), "a line has an origin");
  }
}

/// The overlay from the base to the composed text makes the composed text of the base.
void check_derived(const ComposedOverlay& composed) {
  const auto base = std::make_shared<const SourceFile>("base.eds", base_text());
  const DerivedOverlay derived = derive_overlay(base, *composed.text, "base.eds");
  if (!derived.problem.empty()) return;
  const auto overlay = std::make_shared<const SourceFile>("derived.overlay", derived.text);
  const ReadBase read = [](const std::string&, const ReadingChoices&, std::string&) {
    return std::make_unique<SourceFile>("base.eds", base_text());
  };
  Diagnostics diagnostics;
  const ComposedOverlay again = compose_overlay(overlay, {read}, diagnostics);
  require(again.text != nullptr && diagnostics.errors() == 0, "a derived overlay applies");
  require(derive_overlay(std::make_shared<const SourceFile>("a.eds", std::string{again.text->text()}), *composed.text,
                         "a.eds")
                  .text.find("=>") == std::string::npos,
          "a derived overlay makes the edited copy");
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc;
  const std::string input = fuzz::text_of(data, size);
  const std::size_t end = input.find(fuzz::between);
  const auto overlay = std::make_shared<const SourceFile>("fuzz.overlay", input.substr(0, end));
  if (!is_overlay(*overlay)) return 0;
  bool is_second = end != std::string::npos;
  const ReadBase read = [&](const std::string&, const ReadingChoices& choices, std::string&) {
    std::string text = std::exchange(is_second, false) ? input.substr(end + fuzz::between.size()) : fuzz::base_text();
    return std::make_unique<SourceFile>("base.eds", std::move(text), Packing::none, choices);
  };
  Diagnostics diagnostics;
  const ComposedOverlay composed = compose_overlay(overlay, {read, size % 2 == 1}, diagnostics);
  if (composed.text) {
    fuzz::check_origins(composed);
    const std::size_t errors = diagnostics.errors();
    static_cast<void>(read_data_sheet(parse_ini(*composed.text, diagnostics), diagnostics));
    if (errors == 0) fuzz::check_derived(composed);
  }
  fuzz::print(diagnostics);
  return 0;
}
