/// The options file `NAME.options.json`: what a device does that an EDS has no words for.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "text/source_file.hpp"

namespace edsc {

using EntryKey = std::pair<std::uint16_t, std::uint8_t>;

struct Options {
  /// C++ names to use in place of the one made from ParameterName.
  std::map<EntryKey, std::string> names;
  /// Bytes that a string in RAM can hold.
  std::map<EntryKey, std::uint16_t> string_capacity;
  /// Constant or ro entries that the application sets at start-up: they live in RAM.
  std::vector<EntryKey> settable;
  /// Rules that are not reported for this device.
  std::vector<std::string> silence;
  /// What is plugged into a modular device: the numbers of the modules, by place. Empty: what the DCF says.
  std::vector<std::uint16_t> connected_modules;
  /// VISIBLE_STRINGs go out with a trailing 00h.
  bool zero_terminated_strings = false;
  /// Departures from CiA 301 that the runtime knows: member of canopen::DeviceOptions and its value in C++.
  std::vector<std::pair<std::string, std::string>> runtime;
};

/// Reads an options file. Unknown members and values of a wrong type are errors, with the member's path.
[[nodiscard]] Options read_options(const SourceFile& source, Diagnostics& diagnostics);

}  // namespace edsc
