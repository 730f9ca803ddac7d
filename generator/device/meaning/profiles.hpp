/// Meanings that CiA 301 and the device profiles define: the files in generator/profiles, built into edsc.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "device/meaning/description.hpp"

namespace edsc {

/// A device profile, or with the number 301 the communication profile of all devices.
struct MeaningProfile {
  std::uint16_t number = 0;
  std::string title;                ///< document and version
  std::uint16_t repeat_offset = 0;  ///< objects 6000h.. are repeated at this distance for further axes; 0: they are not
  std::uint16_t repeat_count = 1;
  MeaningDescriptions meanings;

  /// The index of the object in the first axis, and the distance to it.
  struct Place {
    std::uint16_t index;
    std::uint16_t offset;
  };
  [[nodiscard]] Place place_of(std::uint16_t index) const;
};

/// The profiles of edsc, in the order of their numbers.
[[nodiscard]] std::span<const MeaningProfile> meaning_profiles();

/// Reads a profile; faults are added to `diagnostics`.
[[nodiscard]] MeaningProfile read_meaning_profile(const SourceFile& source, Diagnostics& diagnostics);

}  // namespace edsc
