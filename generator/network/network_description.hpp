/// The network file as written: nodes, their files and settings, and the signals between them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "text/source_file.hpp"

namespace edsc {

/// A value of the file, with its position.
template <class T>
struct Written {
  T value{};
  Position position = {};
};

using WrittenNumber = std::optional<Written<std::uint32_t>>;
using WrittenText = std::optional<Written<std::string>>;
using WrittenFlag = std::optional<Written<bool>>;

/// A value for an entry of a node: `"6083h": 2000`. The value is text in the notation of an EDS, a number with a unit,
/// or a name.
struct WrittenValue {
  Written<std::string> entry;
  Written<std::string> value;
};

struct SyncDescription {
  WrittenText producer;  ///< name of a node
  WrittenNumber period_us;
  WrittenNumber window_us;
  WrittenNumber overflow;
};

/// The shortest interval between frames that nothing limits, for load and response times.
struct AssumedIntervals {
  WrittenNumber sdo_ms, event_ms, emcy_ms, nmt_ms, time_ms;
};

struct NodeDescription {
  Written<std::string> name;
  WrittenNumber node_id;
  WrittenText eds, dcf, options;
  WrittenFlag master, keep_going;
  WrittenNumber heartbeat_ms, heartbeat_timeout_ms, master_timeout_ms;
  WrittenNumber sdo_timeout_ms;
  WrittenNumber serial_number;
  std::vector<WrittenValue> set;
};

/// Values that one node sends to others.
struct SignalDescription {
  Position position;
  WrittenText from;
  WrittenText object;
  std::vector<Written<std::string>> to;
  WrittenNumber every_ms;
  WrittenNumber every_sync;
  WrittenFlag event;
  WrittenNumber inhibit_time_us;
  WrittenText name, unit;
};

struct NetworkDescription {
  const SourceFile* source = nullptr;
  WrittenNumber bit_rate;
  WrittenNumber length_m;
  WrittenNumber max_load;
  WrittenNumber error_interval_ms;
  WrittenNumber sdo_timeout_ms;
  WrittenText dbc;
  WrittenFlag disable_unused_pdos;
  SyncDescription sync;
  AssumedIntervals assume;
  std::vector<NodeDescription> nodes;  ///< in the order of the file
  std::vector<SignalDescription> signals;
};

/// The form of a member with more than one value.
enum class MemberForm : std::uint8_t { text, number, flag, texts, values };

/// A member of an object of the file, and its destination.
template <class Owner>
struct MemberRow {
  using Number = WrittenNumber Owner::*;
  using Text = WrittenText Owner::*;
  using Flag = WrittenFlag Owner::*;
  using Texts = std::vector<Written<std::string>> Owner::*;
  using Values = std::vector<WrittenValue> Owner::*;

  std::string_view name;
  std::variant<Number, Text, Flag, Texts, Values> member;
  std::string_view meaning;
  std::uint32_t min = 0;  ///< of a number
  std::uint32_t max = 0;

  [[nodiscard]] constexpr MemberForm form() const {
    constexpr MemberForm forms[] = {MemberForm::number, MemberForm::text, MemberForm::flag, MemberForm::texts,
                                    MemberForm::values};
    return forms[member.index()];
  }
};

inline constexpr MemberRow<NetworkDescription> network_members[] = {
    {"bit_rate", &NetworkDescription::bit_rate, "bit rate in kbit/s", 10, 1000},
    {"length_m", &NetworkDescription::length_m, "length of the bus in m", 0, 10000},
    {"max_load", &NetworkDescription::max_load, "highest bus load in percent without a warning; 80 if missing", 1, 100},
    {"error_interval_ms", &NetworkDescription::error_interval_ms,
     "shortest time between two errors on the bus in ms, for response times; without errors if missing", 1, 3'600'000},
    {"sdo_timeout_ms", &NetworkDescription::sdo_timeout_ms,
     "time in ms in which each node responds to an SDO request; 500 if missing", 1, 65535},
    {"dbc", &NetworkDescription::dbc, "DBC file with names of signals, relative to the network file"},
    {"disable_unused_pdos", &NetworkDescription::disable_unused_pdos,
     "TPDOs that are as in the EDS and that no node receives are disabled: bit 31 of their COB-ID"},
};

inline constexpr MemberRow<SyncDescription> sync_members[] = {
    {"producer", &SyncDescription::producer, "name of the node that produces SYNC"},
    {"period_us", &SyncDescription::period_us, "communication cycle period in us: 1006h", 1, 0xFFFF'FFFF},
    {"window_us", &SyncDescription::window_us, "synchronous window length in us: 1007h of all nodes", 0, 0xFFFF'FFFF},
    {"overflow", &SyncDescription::overflow, "overflow value of the SYNC counter: 1019h of all nodes", 0, 240},
};

inline constexpr MemberRow<AssumedIntervals> assume_members[] = {
    {"sdo_ms", &AssumedIntervals::sdo_ms, "one SDO request and response of each client in this time; 10 if missing", 1,
     3'600'000},
    {"event_ms", &AssumedIntervals::event_ms,
     "interval of an event-driven TPDO without inhibit time and event timer; 100 if missing", 1, 3'600'000},
    {"emcy_ms", &AssumedIntervals::emcy_ms, "interval of EMCY without inhibit time; 1000 if missing", 1, 3'600'000},
    {"nmt_ms", &AssumedIntervals::nmt_ms, "interval of NMT commands; 1000 if missing", 1, 3'600'000},
    {"time_ms", &AssumedIntervals::time_ms, "interval of TIME; 1000 if missing", 1, 3'600'000},
};

inline constexpr MemberRow<NodeDescription> node_members[] = {
    {"node_id", &NodeDescription::node_id, "node-ID; of a DCF its NodeID if missing", 1, 127},
    {"eds", &NodeDescription::eds, "EDS, XDD or XDC file, relative to the network file"},
    {"dcf", &NodeDescription::dcf, "DCF with the configuration of the node, instead of `eds`"},
    {"options", &NodeDescription::options, "options file of the device; `NAME.options.json` beside the EDS if missing"},
    {"keep_going", &NodeDescription::keep_going, "errors in the EDS are warnings, and invalid objects are skipped"},
    {"master", &NodeDescription::master, "the NMT master; it needs neither `eds` nor `dcf`"},
    {"heartbeat_ms", &NodeDescription::heartbeat_ms, "producer heartbeat time in ms: 1017h", 0, 65535},
    {"heartbeat_timeout_ms", &NodeDescription::heartbeat_timeout_ms,
     "consumer heartbeat time of the master for this node in ms; twice `heartbeat_ms` if missing", 1, 65535},
    {"master_timeout_ms", &NodeDescription::master_timeout_ms,
     "consumer heartbeat time of the node for the master in ms, in a free entry of its 1016h; none if missing", 1,
     65535},
    {"sdo_timeout_ms", &NodeDescription::sdo_timeout_ms,
     "time in ms in which the node responds to an SDO request; default: the time of the network", 1, 65535},
    {"serial_number", &NodeDescription::serial_number, "serial number of the device: 1018h:04", 0, 0xFFFF'FFFF},
    {"set", &NodeDescription::set,
     "values of entries that differ from the file: `{\"6083h\": 2000}`, with a unit `\"100 rpm/s\"`, or by a name"},
};

inline constexpr MemberRow<SignalDescription> signal_members[] = {
    {"from", &SignalDescription::from, "name of the node that sends"},
    {"object", &SignalDescription::object,
     "entry that is sent; from a master without a file `NODE.ENTRY`, the receiver"},
    {"to", &SignalDescription::to, "receivers: `NODE.ENTRY`, or the name of a master without a file"},
    {"every_ms", &SignalDescription::every_ms, "sent in this interval in ms (event timer)", 1, 65535},
    {"every_sync", &SignalDescription::every_sync, "sent at each SYNC with this distance (transmission type)", 1, 240},
    {"event", &SignalDescription::event, "sent when the value changes (transmission type 255)"},
    {"inhibit_time_us", &SignalDescription::inhibit_time_us,
     "shortest time between two PDOs in us, a multiple of 100 (inhibit time)", 100, 6'553'500},
    {"name", &SignalDescription::name,
     "name in snake_case, in C++, in the DBC file and in the EDS of a master without a file; that of the object if missing"},
    {"unit", &SignalDescription::unit,
     "unit of a raw value of 1: `rpm`, `0.1 degC`; for objects whose EDS and options file do not state one"},
};

/// The time in ms in which a node responds to an SDO request: its own, or that of the network; empty if neither is
/// written.
[[nodiscard]] std::optional<std::uint32_t> sdo_timeout_ms(const NetworkDescription& network,
                                                          const NodeDescription& node);

/// Reads a network file. Unknown members, missing ones and invalid values are reported.
[[nodiscard]] NetworkDescription read_network_file(const SourceFile& source, Diagnostics& diagnostics);

}  // namespace edsc
