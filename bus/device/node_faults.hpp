/// Faults of a simulated node, as a port between the node and its bus: the services of the node do not know of them.
#pragma once

#include <canopen/can/frame.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/command_arguments.hpp"

namespace edsc {

enum class NodeFaultKind : std::uint8_t {
  silent,
  no_boot_up,
  no_heartbeat,
  no_sdo,
  sdo_delay,
  sdo_drop,
  sdo_toggle,
  abort,
  pdo_short,
  no_pdo,
  babbling,
  stuck,
  twin,
  lost_node_id,
};

struct NodeFaultRow {
  NodeFaultKind kind;
  std::string_view name;
  std::string_view arguments;  ///< a pattern of read_arguments()
  std::string_view help;
};

[[nodiscard]] std::span<const NodeFaultRow> node_fault_rows();

struct NodeFault {
  const NodeFaultRow* row = nullptr;
  CommandArguments arguments;
  std::optional<std::uint64_t> span_us;  ///< until it is cleared without one
};

/// Reads `NAME [ARGS] [for TIME]`. Returns what is wrong; empty on success.
[[nodiscard]] std::string read_fault(std::span<const std::string> words, EntryFinder& names, NodeFault& fault);

/// The faults that a node has, and what they do with its frames. Times are microseconds since its start.
class NodeFaults {
 public:
  /// What the faults must know of the node.
  struct Node {
    std::function<unsigned()> node_id;
    /// Returns the COB-ID of a TPDO; nothing if the node does not have it.
    std::function<std::optional<std::uint32_t>(unsigned number)> cob_id_of_tpdo;
  };
  explicit NodeFaults(Node node);

  /// A fault with the same name and the same object or number is replaced.
  void start(NodeFault fault, std::uint64_t now_us);
  void clear();
  /// Removes the faults whose time has elapsed, and sends what they add to the bus.
  void on_time(std::uint64_t now_us);
  [[nodiscard]] std::optional<std::uint64_t> next_us() const;

  [[nodiscard]] bool has(NodeFaultKind kind) const;
  /// Whether an entry has a fault.
  [[nodiscard]] bool has(NodeFaultKind kind, std::uint16_t index, std::uint8_t sub_index) const;
  /// The names of the present faults, with commas; empty without one.
  [[nodiscard]] std::string text() const;

  /// A frame of the bus. Returns false if the node must not receive it.
  [[nodiscard]] bool receive(const canopen::Frame& frame, std::uint64_t now_us);
  /// A frame that the node sends: it is queued as the faults change it, or dropped.
  void send(const canopen::Frame& frame, std::uint64_t now_us);

  /// The first frame that is due at this time; null if there is none.
  [[nodiscard]] const canopen::Frame* first_due(std::uint64_t now_us) const;
  /// Removes it.
  void sent();

 private:
  struct Active {
    NodeFault fault;
    std::optional<std::uint64_t> end_us;
    std::uint64_t next_us = 0;  ///< of frames that the fault adds
    unsigned frames = 0;        ///< that the fault has seen
  };
  struct Queued {
    canopen::Frame frame;
    std::uint64_t due_us;
  };

  /// Applies a fault to a frame that is sent; false: it is dropped.
  [[nodiscard]] bool change(Active& active, canopen::Frame& frame, std::uint64_t& due_us) const;
  [[nodiscard]] bool is_tpdo(const Active& active, const canopen::Frame& frame) const;
  void queue(const canopen::Frame& frame, std::uint64_t due_us);

  Node node_;
  std::vector<Active> active_;
  std::vector<Queued> queue_;  ///< ascending by time
};

}  // namespace edsc
