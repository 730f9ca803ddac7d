/// Faults that a simulation injects: `lost:axis1@10s`.
#pragma once

#include <canopen_sim/network_simulation/simulation_protocol.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "network/network.hpp"

namespace edsc {

using FaultKind = canopen::network_simulation::PlannedFault::Kind;

struct SimulationFault {
  FaultKind kind = FaultKind::lost;
  std::size_t node = 0;       ///< place in Network::nodes, unless the fault is of the bus
  std::uint64_t time_us = 0;  ///< after the start of the nodes; of errors: the interval
  std::string text;           ///< as written
};

struct FaultRow {
  FaultKind kind;
  std::string_view name;
  std::string_view form;  ///< of what follows `name:`
  std::string_view meaning;
};

inline constexpr FaultRow fault_rows[] = {
    {FaultKind::lost, "lost", "NODE@TIME", "the node loses its power"},
    {FaultKind::babbling, "babbling", "NODE@TIME", "the node sends its PDO of highest priority without a pause"},
    {FaultKind::errors, "errors", "COUNT/TIME", "error frames at equal intervals destroy what is on the bus"},
};

/// The longest simulated time, 1000 hours.
inline constexpr std::uint64_t max_simulated_us = 1000 * 3'600'000'000ULL;

/// Returns the microseconds of a duration; nothing if the text is not a duration from 1 us to 1000 h.
[[nodiscard]] std::optional<std::uint64_t> parse_simulated_time(std::string_view text);

/// Reads a fault. Returns an error message; empty on success.
[[nodiscard]] std::string parse_fault(std::string_view text, const Network& network, SimulationFault& fault);

/// `lost:NODE@TIME, ...`
[[nodiscard]] std::string fault_forms();

}  // namespace edsc
