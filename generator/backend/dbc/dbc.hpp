/// The PDOs of a device as a DBC file, the format in which CAN tools describe messages and signals.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "backend/identifiers.hpp"

namespace edsc {

struct Dbc {
  std::string text;                ///< in code page 1252, which tools expect; other characters are `?`
  std::vector<std::string> notes;  ///< PDOs that are ignored, and why: `TPDO 3 to TPDO 8: disabled by default`
};

/// A device of a network, which has a node-ID and the identifiers of its objects.
struct DbcNode {
  std::string name;  ///< an identifier
  const Device* device = nullptr;
  const Identifiers* names = nullptr;
  const std::map<EntryKey, std::string>* signal_names = nullptr;  ///< in place of those of `names`; may be null
};

/// Returns a message for each default PDO that is enabled. `device` has a node-ID and the identifiers of its objects.
///
/// Signals are little-endian, at the bits of the mapping; dummy entries are gaps. Factor, offset, unit and names of
/// values are those of the meaning; a word with fields has a signal for each field (dbc_signals.hpp). Limits are those
/// of the EDS. An entry that is neither a number nor a BOOLEAN is an unsigned number of the same bits. Names have up to
/// 32 characters, as the format requires; longer ones are also in the attributes SystemMessageLongSymbol and
/// SystemSignalLongSymbol. GenMsgCycleTime is the event timer of a TPDO with transmission type 254 or 255, in
/// milliseconds.
///
/// MPDOs and PDOs with an invalid mapping are ignored, and those whose CAN-ID another PDO of the device already has.
[[nodiscard]] Dbc dbc_of(const Device& device, const Identifiers& names);

/// The same for several devices. The RPDOs with the CAN-ID of a TPDO are not messages; their nodes receive the signals
/// that they map. An RPDO without a TPDO is a message without a sender.
[[nodiscard]] Dbc dbc_of(const std::vector<DbcNode>& nodes);

}  // namespace edsc
