/// An overlay that is edited: the device that it makes of its base, and its lines after a change of the device.
#pragma once

#include <memory>
#include <string>

#include "change/open_sheet.hpp"

namespace edsc::edit {

/// An overlay with its base, as one text.
struct OpenOverlay {
  std::shared_ptr<const OpenSheet> sheet;  ///< the base with the overlay; null with a problem
  std::shared_ptr<const OpenSheet> base;   ///< without it
  std::string base_path;                   ///< as the overlay has it
  std::string problem;                     ///< why the overlay cannot be applied
};

[[nodiscard]] OpenOverlay open_overlay(const std::string& path, const std::string& bytes, const Options& options);

struct ChangedOverlay {
  std::string bytes;
  std::string problem;  ///< what an overlay cannot express, or has in a range
};

/// The bytes of an overlay that makes `after` of its base instead of `before`. Other lines and their reasons remain.
[[nodiscard]] ChangedOverlay changed_overlay(const std::string& path, const std::string& bytes,
                                             const OpenOverlay& before, const OpenSheet& after);

}  // namespace edsc::edit
