/// Meanings that CiA 301 and the device profiles define: the files in generator/profiles, built into edsc.
#pragma once

#include <canopen/od/access.hpp>
#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/meaning/description.hpp"

namespace edsc {

/// Who gives an object of a profile its value. An access type that does not allow this is a mistake; a device may allow
/// less of the rest: a parameter that it does not let change is `ro` or `const`.
enum class ProfileUse : std::uint8_t {
  command,    ///< the master: it must be writable
  status,     ///< the device, again and again: readable, neither writable nor `const`
  parameter,  ///< whoever configures the device: readable
  constant,   ///< the manufacturer: readable
};

[[nodiscard]] constexpr bool fits(ProfileUse use, canopen::Access access) {
  switch (use) {
    case ProfileUse::command: return canopen::writable(access);
    case ProfileUse::status: return !canopen::writable(access) && access != canopen::Access::constant;
    case ProfileUse::parameter:
    case ProfileUse::constant: break;
  }
  return canopen::readable(access);
}

/// What a profile says about an object.
struct ProfileObject {
  std::uint16_t index = 0;
  std::string_view object_code;                ///< `VAR`, `ARRAY` or `RECORD`
  const canopen::DataTypeRow* type = nullptr;  ///< of the value or of each element; null if the elements differ
  canopen::Access access = canopen::Access::rw;
  ProfileUse use = ProfileUse::parameter;
  std::string source;  ///< the manuals and files that agree

  [[nodiscard]] bool has_sub_indices() const { return object_code != "VAR"; }
};

/// An entry of an ARRAY with fixed elements, or of a RECORD.
struct ProfileEntry {
  std::string name;
  const canopen::DataTypeRow* type = nullptr;  ///< null: the type of the object
  std::optional<canopen::Access> access = {};  ///< nothing: the access type of the object
};

/// A device profile, or with the number 301 the communication profile of all devices.
struct MeaningProfile {
  std::uint16_t number = 0;
  std::string title;                ///< document and version
  std::uint16_t repeat_offset = 0;  ///< objects 6000h.. are repeated at this distance for further axes; 0: they are not
  std::uint16_t repeat_count = 1;
  MeaningDescriptions meanings;
  std::vector<ProfileObject> objects;          ///< ascending
  std::map<std::uint16_t, std::string> names;  ///< of objects, as the profile spells them
  /// From sub-index 1 on, of RECORDs and of ARRAYs whose elements have names.
  std::map<std::uint16_t, std::vector<ProfileEntry>> entries;

  /// The row of an object of the first axis; null if there is none.
  [[nodiscard]] const ProfileObject* find(std::uint16_t index) const;

  /// The name of an object of the first axis; empty if edsc does not have it.
  [[nodiscard]] std::string name_of(std::uint16_t index) const;

  /// The entries of an object of the first axis; empty if the profile does not fix them, or edsc does not have them.
  [[nodiscard]] std::span<const ProfileEntry> entries_of(std::uint16_t index) const;

  /// The index of the object in the first axis, and the distance to it.
  struct Place {
    std::uint16_t index;
    std::uint16_t offset;
  };
  [[nodiscard]] Place place_of(std::uint16_t index) const;
};

/// The profile with this number; null if edsc does not have it.
[[nodiscard]] const MeaningProfile* find_profile(std::uint16_t number);

/// Reads a profile; faults are added to `diagnostics`.
[[nodiscard]] MeaningProfile read_meaning_profile(const SourceFile& source, Diagnostics& diagnostics);

}  // namespace edsc
