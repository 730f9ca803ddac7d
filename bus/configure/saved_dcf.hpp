/// The DCF of a node: its EDS with the values read from it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "configure/read_configuration.hpp"
#include "eds/data_sheet.hpp"
#include "format/dcf/make_dcf.hpp"
#include "text/source_file.hpp"

namespace edsc {

/// What the DCF is made from. All must outlive the call.
struct SavedDcfInput {
  const SourceFile& source;  ///< the EDS, or a DCF, of the node
  const DataSheet& sheet;    ///< of `source`
  const Device& device;      ///< of `sheet`, with the node-ID
  const NodeConfiguration& found;
  std::uint8_t node = 0;
  std::optional<unsigned> bit_rate;  ///< kbit/s, for [DeviceComissioning]
  bool all = false;                  ///< all values, not only those that differ from the EDS
};

/// An entry that is not in the DCF, with the reason.
struct NotSaved {
  LiveEntry entry;
  std::string what;
};

struct SavedDcf {
  std::string text;
  ParameterValues values;         ///< of `text`
  std::vector<NotSaved> missing;  ///< also the entries that could not be read
};

/// Reads the DCF back: values that it does not preserve are ignored and reported in `missing`. Of a PDO mapping or a
/// compact form, all values are saved if one differs.
[[nodiscard]] SavedDcf make_saved_dcf(const SavedDcfInput& input);

}  // namespace edsc
