/// Compares the object dictionary of a device on the bus with its EDS. Reads only.
#pragma once

#include <array>
#include <canopen/can/node_id.hpp>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "accept/dictionary_reader.hpp"
#include "accept/difference.hpp"
#include "conform/dut/case_frames.hpp"
#include "conform/verdict.hpp"
#include "device/device.hpp"
#include "eds/data_sheet.hpp"
#include "online/identity.hpp"
#include "online/live_bus.hpp"
#include "online/sdo_access.hpp"

namespace edsc::accept {

struct Comparison {
  Identity in_eds, in_device;
  /// For each of `identity_numbers`, the reason in the file of deviations; empty: not declared.
  std::array<std::string, std::size(identity_numbers)> identity_deviations;
  std::vector<ComparedEntry> entries;  ///< ascending
  std::vector<Difference> differences;
  std::vector<std::string> unstable;       ///< differences of a first read that a second read did not show
  std::vector<conform::SeenFrame> frames;  ///< all, with times since the comparison began
  std::optional<conform::RunClock> clock;  ///< at the end of a complete comparison, for the rest of the run
  bool interrupted = false;
  std::string lost;  ///< why the comparison ended early; empty: it is complete

  [[nodiscard]] bool is_complete() const { return !interrupted && lost.empty(); }
  [[nodiscard]] std::size_t count(Mark mark) const;
  /// Differences that the file of deviations does not declare.
  [[nodiscard]] std::size_t undeclared() const;
  /// Whether both state the number of the identity, and another one.
  [[nodiscard]] bool differs(const IdentityNumber& number) const;
};

struct ComparisonSettings {
  canopen::NodeId node{1};
  SdoSettings sdo;
  /// The number of compared objects.
  DictionaryReader::Progress progress = [](std::size_t, std::size_t) {};
};

/// `data`: the EDS as written, from which `sheet` was resolved. Each difference is read twice. An interruption or a
/// lost bus ends the comparison.
[[nodiscard]] Comparison compare_dictionary(LiveBus& bus, const Device& sheet, const DataSheet& data,
                                            const ComparisonSettings& settings);

}  // namespace edsc::accept
