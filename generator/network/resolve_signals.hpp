/// The signals of a network file, with the entries that they connect.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "network/network.hpp"

namespace edsc {

/// One end of a signal. Of a master without a file, the entry is that of the other end, which it copies.
struct SignalEnd {
  const NetworkNode* node = nullptr;
  const Entry* entry = nullptr;
  const NetworkNode* owner = nullptr;  ///< the node that has `entry`
};

/// A signal whose names were found.
struct Signal {
  SignalEnd from;
  std::vector<SignalEnd> to;
  const SignalDescription* description = nullptr;
  std::optional<Quantity> quantity;  ///< that the signal states
};

/// Finds nodes and entries. A signal with an unknown name, an entry that cannot be mapped in its direction, or ends of
/// different data types is reported and ignored; an invalid name or unit is reported.
[[nodiscard]] std::vector<Signal> resolve_signals(const Network& network, Diagnostics& diagnostics);

}  // namespace edsc
