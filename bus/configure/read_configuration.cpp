#include "configure/read_configuration.hpp"

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <map>
#include <optional>
#include <set>

#include "configure/configuration_plan.hpp"
#include "device/index_range.hpp"
#include "values/little_endian.hpp"

namespace edsc {
namespace {

constexpr unsigned max_silent = 3;  ///< consecutive entries without response, after which the node is lost
constexpr std::uint16_t axis_step = 0x800;
constexpr unsigned max_axes = 8;

using Key = std::pair<std::uint16_t, std::uint8_t>;

/// Commands of a profile: the controlword of CiA 402, for each axis; the outputs of CiA 401.
struct CommandsOfProfile {
  std::uint16_t profile;
  IndexRange objects;
  bool for_each_axis = false;
};

constexpr CommandsOfProfile profile_commands[] = {
    {402, {0x6040, 0x6040}, true}, {401, {0x6200, 0x6200}}, {401, {0x6220, 0x6227}},
    {401, {0x6300, 0x6300}},       {401, {0x6320, 0x6320}}, {401, {0x6410, 0x6414}},
};

bool is_profile_command(std::uint16_t profile, std::uint16_t index) {
  return std::ranges::any_of(profile_commands, [&](const CommandsOfProfile& row) {
    if (row.profile != profile) return false;
    for (unsigned axis = 0; axis < (row.for_each_axis ? max_axes : 1); ++axis) {
      const unsigned offset = axis * axis_step;
      if (index >= row.objects.first + offset && index <= row.objects.last + offset) return true;
    }
    return false;
  });
}

/// The values of the node; for entries that were not read, the default values of the EDS.
class Values {
 public:
  Values(const Device& device, const std::vector<ReadValue>& values) : device_{device} {
    for (const ReadValue& value : values) {
      if (value.bytes.size() > sizeof(std::uint32_t)) continue;
      numbers_[{value.entry.index, value.entry.sub_index}] = static_cast<std::uint32_t>(number_of(value.bytes));
    }
  }

  [[nodiscard]] std::optional<std::uint32_t> find(std::uint16_t index, std::uint8_t sub_index) const {
    const auto read = numbers_.find({index, sub_index});
    if (read != numbers_.end()) return read->second;
    const Entry* entry = device_.find(index, sub_index);
    if (entry == nullptr || !entry->default_value) return std::nullopt;
    return static_cast<std::uint32_t>(entry->default_value->bits);
  }

 private:
  const Device& device_;
  std::map<Key, std::uint32_t> numbers_;
};

/// The entries that the valid RPDOs of the node write.
std::set<Key> written_by_rpdos(const Device& device, const Values& values) {
  constexpr std::uint16_t first = 0x1400, last = 0x15FF;
  std::set<Key> written;
  for (const Object& object : device.objects) {
    if (object.index < first || object.index > last) continue;
    const std::uint16_t mapping = mapping_parameter_of(object.index);
    const bool valid =
        (values.find(object.index, 1).value_or(canopen::CobId::invalid_bit) & canopen::CobId::invalid_bit) == 0;
    const std::uint32_t count = valid ? values.find(mapping, 0).value_or(0) : 0;
    const auto value_of = [&](std::uint8_t sub_index) { return values.find(mapping, sub_index).value_or(0); };
    const auto used = static_cast<std::uint8_t>(std::min<std::uint32_t>(count, classical_can.objects));
    for (const MappingValue& mapped : read_mapping(used, value_of)) written.insert({mapped.index, mapped.sub_index});
  }
  return written;
}

void set_process_data_apart(const Device& device, NodeConfiguration& found) {
  const Values values{device, found.values};
  const std::set<Key> written = written_by_rpdos(device, values);
  const auto profile = static_cast<std::uint16_t>(values.find(0x1000, 0).value_or(0));
  std::erase_if(found.values, [&](const ReadValue& value) {
    const std::uint16_t index = value.entry.index;
    const bool is_process_data =
        index >= 0x2000 && (written.contains({index, value.entry.sub_index}) || is_profile_command(profile, index));
    if (is_process_data) found.process_data.push_back(value.entry);
    return is_process_data;
  });
}

}  // namespace

std::vector<LiveEntry> configuration_entries(const Device& device) {
  constexpr std::uint32_t no_read = 2;
  std::vector<LiveEntry> entries;
  for (const Object& object : device.objects) {
    for (const Entry& entry : object.entries) {
      const bool flagged = ((entry.obj_flags | object.obj_flags) & no_read) != 0;
      if (flagged || !canopen::readable(entry.access) || !canopen::writable(entry.access)) continue;
      if (entry.type == nullptr || entry.type->kind == canopen::DataClass::domain) continue;
      LiveEntry live = live_entry(device, object, entry);
      if (!is_left_out(live)) entries.push_back(std::move(live));
    }
  }
  return entries;
}

NodeConfiguration read_configuration(SdoAccess& node, const Device& device, const std::vector<LiveEntry>& entries,
                                     const std::function<void(std::size_t done)>& progress) {
  NodeConfiguration found;
  const unsigned boot_ups = node.boot_ups();
  unsigned silent = 0;
  std::uint16_t mapping = 0;
  std::uint8_t count = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const LiveEntry& entry = entries[i];
    progress(i);
    if (entry.sub_index != 0 && entry.index == mapping && entry.sub_index > count) continue;
    SdoOutcome outcome = upload(node, entry);
    found.restarted = node.boot_ups() != boot_ups;
    if (found.restarted) return found;
    silent = outcome.end == SdoEnd::no_answer ? silent + 1 : 0;
    if (silent == max_silent) {
      found.lost = true;
      return found;
    }
    if (!outcome.done()) {
      const bool no_value = outcome.end == SdoEnd::refused && outcome.code == canopen::AbortCode::no_data;
      if (!no_value) found.unread.push_back({entry, std::move(outcome)});
      continue;
    }
    if (entry.sub_index == 0 && contains(mapping_parameters, entry.index) && outcome.bytes.size() == 1) {
      mapping = entry.index;
      count = outcome.bytes.front();
    }
    found.values.push_back({entry, std::move(outcome.bytes)});
  }
  set_process_data_apart(device, found);
  return found;
}

}  // namespace edsc
