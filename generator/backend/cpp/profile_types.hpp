/// C++ types of a device profile: words and enumerations that are the same for each device without own names. They are
/// in a header of the runtime, so that one function serves two devices.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace edsc {

/// Headers of the runtime, in canopen/profile, with the types of a profile.
struct ProfileHeaders {
  std::string_view name_space;
  std::string_view types_file;
  std::string_view text_file;  ///< the names of their values as text
};

inline constexpr ProfileHeaders cia402_types{"canopen::cia402", "cia402_types.hpp", "cia402_text.hpp"};

/// What makes a type another one: numbers and names of its view, without texts.
[[nodiscard]] std::string contents_of_type(const nlohmann::ordered_json& enumeration,
                                           const nlohmann::ordered_json& word);

/// Finds a type of CiA 402 by its contents: `canopen::cia402::Statusword`; empty if there is none.
[[nodiscard]] std::string_view find_profile_type(const std::string& contents);

/// The text of these headers, made from the data of the profile with the templates of generated headers.
[[nodiscard]] std::string cia402_types_header();
[[nodiscard]] std::string cia402_text_header();

}  // namespace edsc
