#include "device/meaning/profiles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "device/meaning/built_in_profiles.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

constexpr std::uint16_t first_profile_index = 0x6000, last_profile_index = 0x9FFF;

struct BuiltInProfiles {
  std::deque<SourceFile> sources;  ///< positions point to them
  std::vector<MeaningProfile> profiles;

  BuiltInProfiles() {
    for (const BuiltInProfile& file : built_in_profiles()) {
      Diagnostics diagnostics;
      const SourceFile& source = sources.emplace_back(std::string{file.name}, std::string{file.text});
      profiles.push_back(read_meaning_profile(source, diagnostics));
    }
    std::ranges::sort(profiles, {}, &MeaningProfile::number);
  }
};

}  // namespace

MeaningProfile::Place MeaningProfile::place_of(std::uint16_t index) const {
  if (repeat_offset == 0 || index < first_profile_index || index > last_profile_index) return {index, 0};
  const unsigned axis = static_cast<unsigned>(index - first_profile_index) / repeat_offset;
  if (axis >= repeat_count) return {index, 0};
  const auto offset = static_cast<std::uint16_t>(axis * repeat_offset);
  return {static_cast<std::uint16_t>(index - offset), offset};
}

std::span<const MeaningProfile> meaning_profiles() {
  static const BuiltInProfiles built_in;
  return built_in.profiles;
}

MeaningProfile read_meaning_profile(const SourceFile& source, Diagnostics& diagnostics) {
  MeaningProfile profile;
  const JsonFile json_file{source};
  json_file.report_faults("options-syntax", diagnostics);
  const auto& root = json_file.root();
  if (!root.is_object()) return profile;
  OptionFile file{json_file, diagnostics};
  for (const auto& [name, value] : json_file.members(root)) {
    if (name == "profile" && value->is_number_unsigned()) {
      profile.number = value->get<std::uint16_t>();
    } else if (name == "title" && value->is_string()) {
      profile.title = value->get<std::string>();
    } else if (name == "repeat" && value->is_object()) {
      profile.repeat_offset = parse_index(value->value("offset", "")).value_or(0);
      profile.repeat_count = value->value("count", std::uint16_t{1});
    } else if (name == "meaning") {
      profile.meanings.entries = read_meaning(*value, name, MeaningSource::profile, file).entries;
    } else if (name == "emcy") {
      profile.meanings.error_codes = read_error_codes(*value, name, MeaningSource::profile, file);
    } else {
      file.error(*value, name, "unknown member of a profile");
    }
  }
  return profile;
}

}  // namespace edsc
