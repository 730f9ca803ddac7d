/// Units and scales that other objects of a node state, by their values on the device (CiA 402, CiA 404).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/device.hpp"
#include "online/live_entry.hpp"
#include "online/sdo_access.hpp"

namespace edsc {

class LiveScales {
 public:
  explicit LiveScales(SdoAccess& node) : node_{node} {}

  /// Gives the entry the unit and scale that the device states, if objects of the profile state them. Reads each of
  /// these objects once. If one cannot be read, values of the entry are raw numbers. The entry refers to this object.
  void apply(LiveEntry& entry);

  /// `608Fh:01 Encoder increments = 1000 (EDS: 4000)`: the numbers since the last call that are not those of the EDS.
  [[nodiscard]] std::vector<std::string> take_differences();

  /// Why an object that states a scale could not be read since the last call; empty if all could.
  [[nodiscard]] std::string take_failure();

 private:
  std::optional<std::uint64_t> number_of(const Device& device, const Entry& entry);

  SdoAccess& node_;
  std::map<EntryKey, std::optional<std::uint64_t>> numbers_;
  std::map<EntryKey, std::unique_ptr<const Entry>> scaled_;
  std::vector<std::string> differences_;
  std::string failure_;
};

}  // namespace edsc
