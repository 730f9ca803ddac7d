#include "conform/drive.hpp"

#include <fmt/format.h>

#include <canopen/profile/cia402_words.hpp>

#include "conform/dut/dut.hpp"

namespace edsc::conform {
namespace {

constexpr std::uint32_t drive_profile = 402;
constexpr std::uint16_t statusword = 0x6041;
constexpr std::uint16_t axis_distance = 0x800;  // between the objects of two axes
constexpr unsigned max_axes = 8;

/// Set in Operation enabled, Quick stop active and Fault reaction active.
constexpr std::uint64_t power_is_on = canopen::cia402::statusword::operation_enabled;

bool is_drive(const Identity& identity) {
  return identity.device_type && (*identity.device_type & 0xFFFF) == drive_profile;
}

std::string why_axis_may_move(SdoAccess& node, std::uint16_t index) {
  const SdoOutcome read = node.upload(index, 0);
  if (!read.done() || read.bytes.empty())
    return fmt::format("{} cannot be read: {}", label(index, 0), outcome_text(read));
  const std::uint64_t status = number_of(read.bytes);
  if ((status & power_is_on) == 0) return {};
  return fmt::format("{} is {:04X}h (enabled)", label(index, 0), status);
}

}  // namespace

std::string why_drive_may_move(SdoAccess& node, const Device& sheet, const Identity& found) {
  if (!is_drive(found) && !is_drive(identity_of(sheet))) return {};
  for (unsigned axis = 0; axis != max_axes; ++axis) {
    const auto index = static_cast<std::uint16_t>(statusword + axis * axis_distance);
    if (axis != 0 && sheet.find(index) == nullptr) continue;
    if (std::string reason = why_axis_may_move(node, index); !reason.empty()) return reason;
  }
  return {};
}

}  // namespace edsc::conform
