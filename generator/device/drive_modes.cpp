#include "device/drive_modes.hpp"

#include <algorithm>

#include "device/options/option_table.hpp"

namespace edsc {
namespace {

constexpr std::uint16_t modes_of_operation = 0x6060;
constexpr std::uint16_t supported_drive_modes = 0x6502;
constexpr std::uint16_t axis_distance = 0x800;  ///< between the objects of two axes
constexpr unsigned max_axes = 8;
constexpr std::uint32_t manufacturer_modes = 0xFFFF'0000;  ///< in 6502h; their numbers in 6060h are negative
constexpr std::int8_t no_mode = 0;
constexpr std::int8_t last_mode = 16;
constexpr std::int8_t lowest_mode = -128;

/// The distance of the axis whose 6060h this is; -1 if it is another entry.
int distance_of_axis(const Entry& entry) {
  if (entry.sub_index != 0 || entry.type == nullptr || entry.type->bits != 8) return -1;
  const int distance = int{entry.index} - modes_of_operation;
  return distance >= 0 && distance % axis_distance == 0 && distance < int{axis_distance * max_axes} ? distance : -1;
}

std::uint32_t additional_modes(const Options& options) {
  const auto found = std::ranges::find_if(
      options.runtime, [](const RuntimeOption& one) { return one.row == find_option("drive", "additional_modes"); });
  return found == options.runtime.end() ? 0 : found->value;
}

void add(std::vector<ModeRange>& ranges, std::int8_t low, std::int8_t high) {
  if (!ranges.empty() && ranges.back().high == low - 1) {
    ranges.back().high = high;
  } else {
    ranges.push_back({low, high});
  }
}

}  // namespace

std::vector<ModeRange> accepted_modes(const Device& device, const Options& options, const Entry& entry) {
  const int distance = distance_of_axis(entry);
  if (distance < 0) return {};
  const Entry* const supported = device.find(static_cast<std::uint16_t>(supported_drive_modes + distance), 0);
  if (supported == nullptr || !supported->default_value || supported->default_value->bits == 0) return {};
  const std::uint32_t modes = static_cast<std::uint32_t>(supported->default_value->bits) | additional_modes(options);

  std::vector<ModeRange> ranges;
  const auto lowest = entry.low_limit ? static_cast<std::int64_t>(entry.low_limit->bits) : 0;
  if (lowest < 0) {
    add(ranges, static_cast<std::int8_t>(lowest), -1);
  } else if ((modes & manufacturer_modes) != 0) {
    add(ranges, lowest_mode, -1);
  }
  add(ranges, no_mode, no_mode);
  for (std::int8_t mode = 1; mode <= last_mode; ++mode) {
    if ((modes & (1U << (mode - 1))) != 0) add(ranges, mode, mode);
  }
  return ranges;
}

bool accepts_mode(const Device& device, const Options& options, const Entry& entry, std::uint64_t bits) {
  const std::vector<ModeRange> ranges = accepted_modes(device, options, entry);
  const auto value = static_cast<std::int64_t>(bits);
  return ranges.empty() ||
         std::ranges::any_of(ranges, [&](const ModeRange& range) { return value >= range.low && value <= range.high; });
}

}  // namespace edsc
