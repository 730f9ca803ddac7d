/// Overlays of texts in memory.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "diagnostics/place.hpp"
#include "overlay/compose_overlay.hpp"

namespace edsc {

/// The result of the overlay `x.overlay`. Other files are those of `files`, by their name.
struct ComposedTexts {
  Diagnostics diagnostics;
  ComposedOverlay composed;

  ComposedTexts(const std::map<std::string, std::string>& files, std::string overlay, bool needs_reasons = false) {
    ComposeSettings settings;
    settings.read = [&files](const std::string& path, const ReadingChoices& choices,
                             std::string& error) -> std::unique_ptr<SourceFile> {
      const auto file = files.find(path);
      if (file != files.end()) return std::make_unique<SourceFile>(path, file->second, Packing::none, choices);
      error = "cannot read " + path;
      return nullptr;
    };
    settings.needs_reasons = needs_reasons;
    composed =
        compose_overlay(std::make_shared<const SourceFile>("x.overlay", std::move(overlay)), settings, diagnostics);
  }

  [[nodiscard]] std::string text() const { return composed.text ? std::string{composed.text->text()} : "(none)"; }

  /// `rule file:line:column` of each finding.
  [[nodiscard]] std::vector<std::string> findings() const {
    std::vector<std::string> found;
    for (const Diagnostic& one : diagnostics.all()) {
      const Place place = place_of(one.position);
      found.push_back(std::string{one.rule.text()} + " " + place.file + ":" + std::to_string(place.line) + ":" +
                      std::to_string(place.column));
    }
    return found;
  }

  [[nodiscard]] std::string message(std::size_t at = 0) const {
    return at < diagnostics.all().size() ? diagnostics.all()[at].message : "(no finding)";
  }
};

}  // namespace edsc
