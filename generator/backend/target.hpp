/// The targets of `edsc generate`: the languages in which it writes files of a device.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "backend/cpp/cpp_names.hpp"
#include "backend/render.hpp"
#include "device/options/options.hpp"
#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// A target: a folder with its view, and its templates.
struct Target {
  std::string_view name;     ///< of `--target`
  std::string_view summary;  ///< for the help
  /// All data of a device that the templates use.
  nlohmann::ordered_json (*view)(const NamedDevice& named, const Options& options, Diagnostics& diagnostics);
};

/// The first is that without `--target`.
[[nodiscard]] std::span<const Target> targets();

/// An unknown name is a fault of the caller.
[[nodiscard]] const Target& target_of(std::string_view name);

/// The templates of a target, in the order of writing their files.
[[nodiscard]] const std::vector<Template>& templates_of(const Target& target);

}  // namespace edsc
