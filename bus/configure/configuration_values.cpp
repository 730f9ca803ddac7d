#include "configure/configuration_values.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "format/dcf/concise_dcf.hpp"
#include "format/dcf/configured_values.hpp"

namespace edsc {
namespace {

/// The date of the file, unless the DCF has values for 1020h.
std::optional<ConfigurationTime> time_of(const Device& device, const std::vector<ConfiguredValue>& values) {
  ConfigurationTime time;
  for (const ConfiguredValue& value : values) {
    if (value.entry->index != 0x1020 || value.data.size() != sizeof(std::uint32_t)) continue;
    std::uint32_t word = 0;
    std::memcpy(&word, value.data.data(), sizeof word);
    (value.entry->sub_index == 1 ? time.date : time.time) = word;
  }
  if (time.date != 0) return time;
  if (device.find(0x1020, 1) == nullptr) return std::nullopt;
  const FileInformation& file = device.information.file;
  return parse_configuration_time(file.modification_date, file.modification_time);
}

/// Removes values that are never written.
void leave_out(Configuration& configuration) {
  configuration.left_out =
      std::erase_if(configuration.values, [](const ConfigurationValue& value) { return is_left_out(value.entry); });
}

}  // namespace

Configuration configuration_of(const DataSheet& dcf, const Device& device, Diagnostics& diagnostics) {
  const std::vector<ConfiguredValue> values = configured_values(dcf, device, diagnostics);
  Configuration configuration;
  for (const ConfiguredValue& value : values) {
    configuration.values.push_back({live_entry(&device, value.entry->index, value.entry->sub_index),
                                    {value.data.begin(), value.data.end()},
                                    value.position});
  }
  configuration.time = time_of(device, values);
  leave_out(configuration);
  return configuration;
}

std::optional<Configuration> configuration_of(std::string_view concise_dcf, const Device* device) {
  const auto entries = read_concise_dcf(concise_dcf);
  if (!entries) return std::nullopt;
  Configuration configuration;
  for (const ConciseEntry& entry : *entries) {
    auto value = std::ranges::find_if(configuration.values, [&](const ConfigurationValue& one) {
      return one.entry.index == entry.index && one.entry.sub_index == entry.sub_index;
    });
    if (value == configuration.values.end()) {
      value = configuration.values.insert(value, {live_entry(device, entry.index, entry.sub_index), {}, {}});
    }
    value->bytes.assign(entry.data.begin(), entry.data.end());
  }
  leave_out(configuration);
  return configuration;
}

}  // namespace edsc
