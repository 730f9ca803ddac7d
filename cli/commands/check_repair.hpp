/// `edsc check --repair`: an overlay from the findings that have a certain remedy, and its proof.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "shared/common_options.hpp"

namespace edsc {

struct RepairSettings {
  std::string path;          ///< of the file to repair
  std::string options_path;  ///< of its options; empty: beside it
  std::string output;        ///< of the overlay
  std::optional<std::uint8_t> node_id;
  std::vector<std::string> silence;  ///< rules whose findings are not repaired
  ColorOption color;
};

/// Writes the overlay, prints what is left, and tries the device that it describes in simulated time. Returns an exit
/// code: whether the repaired device has no error and conforms.
[[nodiscard]] int repair(const RepairSettings& settings);

}  // namespace edsc
