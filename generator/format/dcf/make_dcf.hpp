/// Converts an EDS to the DCF of one node: CiA 306-1, clause 5.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "device/device.hpp"
#include "eds/data_sheet.hpp"
#include "format/document.hpp"

namespace edsc {

/// The entries that get a ParameterValue.
enum class DcfValues : std::uint8_t {
  different,  ///< value differs from the default value for this node; a PDO mapping then as a whole
  all,        ///< all writable ones
};

/// Adds [DeviceComissioning] to a document in canonical form, and a ParameterValue for the node-ID of `device` to
/// writable entries: that of a DCF with its formula resolved, otherwise the default value. The ParameterValues of an
/// EDS have no meaning and are removed. Commands such as 1010h never have one.
void make_dcf(Document& document, const DataSheet& sheet, const Device& device, DcfValues values);

/// ParameterValues in EDS spelling, by entry. Of the elements of a compact form, all are present or none.
using ParameterValues = std::map<const Entry*, std::string>;

/// ParameterValues read from a node.
struct GivenValues {
  ParameterValues values;
  std::set<const Entry*> known;  ///< entries of `values`, and entries that do not get a ParameterValue
};

/// The same with the values of a node, and with a bit rate in kbit/s if known. A DCF keeps its ParameterValues of
/// entries that are not known.
void make_dcf(Document& document, const DataSheet& sheet, const Device& device, const GivenValues& given,
              std::optional<unsigned> bit_rate);

}  // namespace edsc
