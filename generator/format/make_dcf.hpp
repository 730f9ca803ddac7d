/// An EDS becomes the DCF of one node: CiA 306-1, clause 5.
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

/// Which entries get a ParameterValue.
enum class DcfValues : std::uint8_t {
  different,  ///< whose value differs from the default for this node; of a PDO mapping then the whole object
  all,        ///< all writable ones
};

/// Gives a document in canonical form its [DeviceComissioning], and writable entries the ParameterValue for the node-ID
/// of `device`: that of a DCF with its formula resolved, else the default. The ParameterValues of an EDS, which have no
/// meaning there, are dropped. Commands such as 1010h never have one.
void make_dcf(Document& document, const DataSheet& sheet, const Device& device, DcfValues values);

/// ParameterValues as an EDS spells them, by entry. Of the elements of a compact form either all are there or none.
using ParameterValues = std::map<const Entry*, std::string>;

/// What a node says its ParameterValues are.
struct GivenValues {
  ParameterValues values;
  std::set<const Entry*> known;  ///< those of `values` and others, which get no ParameterValue
};

/// The same with the values of a node, and with a bit rate in kbit/s where it is known. A DCF keeps its ParameterValues
/// of entries that are not known.
void make_dcf(Document& document, const DataSheet& sheet, const Device& device, const GivenValues& given,
              std::optional<unsigned> bit_rate);

}  // namespace edsc
