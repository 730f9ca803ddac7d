/// Arguments and output of a program that simulates a network:
///
///     simulate DURATION SEED [lost NODE TIME | babbling NODE TIME | errors 0 INTERVAL]...
///
/// DURATION, TIME and INTERVAL are in us, the first two from the start of the nodes; NODE is a place in the plan. The
/// program prints lines of words; numbers are decimal:
///
///     edsc-network-simulation 1
///     progress TIME                            now and then
///     refused NODE INDEX SUB ABORT-CODE        an entry of the DCF
///     emergency TIME NODE CODE REGISTER        queued by a node
///     heartbeat TIME NODE OTHER lost|back      of the heartbeat consumer of a node; OTHER is a node-ID
///     state TIME NODE STATE                    as in a heartbeat
///     message PLACE COUNT WORST AT             of NetworkPlan::messages
///     frame CAN-ID EXTENDED REMOTE NODE COUNT WORST AT     not in the plan; NODE is that of the sender, -1 for SDO
///                                              requests and NMT commands
///     changes PLACE COUNT                      events of a message
///     node NODE CONDITION STATE                at the end; CONDITION as in Station::Condition
///     bus MEASURED BUSY BUSIEST FRAMES ERRORS  times in us; BUSIEST is that of one second
///     end
///
/// Host side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace canopen::network_simulation {

inline constexpr std::string_view greeting = "edsc-network-simulation 1";

/// A fault of a run.
struct PlannedFault {
  enum class Kind : std::uint8_t { lost, babbling, errors };
  Kind kind;
  std::size_t node;    ///< of `lost` and `babbling`
  std::uint64_t time;  ///< in us; of `errors`: the interval
};

/// Arguments, in the order of PlannedFault::Kind.
inline constexpr std::string_view fault_names[] = {"lost", "babbling", "errors"};

}  // namespace canopen::network_simulation
