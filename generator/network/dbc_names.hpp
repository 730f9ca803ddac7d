/// Names of signals from the DBC file of a network.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "network/network.hpp"

namespace edsc {

/// Reads the DBC file that the network file names; false if it cannot be read.
[[nodiscard]] bool load_dbc(Network& network, const std::string& path, Diagnostics& diagnostics);

/// The signal with this CAN-ID at exactly these bits, as an identifier; empty if the file has none.
[[nodiscard]] std::string dbc_signal_name(const std::vector<DbcFileMessage>& messages, std::uint32_t cob_id,
                                          unsigned first_bit, unsigned bits);

/// Names the values of all PDOs with a CAN-ID of the DBC file, except those that a signal names. Reports messages
/// whose CAN-ID no PDO has, and signals whose bits are not an entry of a PDO, at their lines.
void apply_dbc_names(Network& network, Diagnostics& diagnostics);

}  // namespace edsc
