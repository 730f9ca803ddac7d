/// Sends the requests of a log to nodes again, and compares their responses with those of the log.
#pragma once

#include <bitset>
#include <canopen/can/frame.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "decode/decoder.hpp"
#include "decode/message.hpp"
#include "device/entry_address.hpp"
#include "online/live_bus.hpp"

namespace edsc::replay {

using NodeSet = std::bitset<128>;

/// A frame of the log.
struct RecordedFrame {
  canopen::Frame frame;
  std::size_t line = 0;  ///< or packet, from 1
  bool has_time = false;
  std::int64_t us = 0;  ///< since the first frame; does not decrease
  /// How much of this time is not waited for, see max_gap_us.
  std::int64_t skipped_us = 0;
};

/// A longer time without a frame takes only this time, such as one at which a clock was set. It is longer than the
/// longest heartbeat time, 65.535 s.
inline constexpr std::int64_t max_gap_us = 120'000'000;

struct Settings {
  NodeSet nodes;                      ///< whose responses are compared; frames of other nodes are sent in their place
  std::vector<EntryAddress> ignored;  ///< SDO transfers of these entries are not compared
  bool pdos = false;                  ///< compare TPDOs, too
  bool all_differences = false;       ///< continue after the first difference
  std::int64_t timeout_us = 1'000'000;
  unsigned speed = 100;  ///< in percent of the log
  /// Switches a simulated node off and on; empty for nodes of a bus.
  std::function<void(std::uint8_t node_id)> power_on;
};

enum class DifferenceKind : std::uint8_t {
  value,       ///< another SDO response, without an abort code that differs
  abort_code,  ///< a transfer was aborted in one of the two only, or for another reason
  content,     ///< another EMCY, LSS response, node guarding response or TPDO
  missing,     ///< the log has a frame that the node did not send
  additional,  ///< the node sent a frame that the log does not have
};

struct DifferenceKindRow {
  DifferenceKind kind;
  std::string_view name;     ///< in JSON
  std::string_view meaning;  ///< in text
};

inline constexpr DifferenceKindRow difference_kinds[] = {
    {DifferenceKind::value, "value", "the response differs"},
    {DifferenceKind::abort_code, "abort_code", "the transfer ends differently"},
    {DifferenceKind::content, "content", "the frame differs"},
    {DifferenceKind::missing, "missing", "the frame is missing"},
    {DifferenceKind::additional, "additional", "the log does not have the frame"},
};

[[nodiscard]] constexpr const DifferenceKindRow& row_of(DifferenceKind kind) {
  return difference_kinds[static_cast<std::size_t>(kind)];
}

/// A frame and its meaning.
struct DecodedFrame {
  canopen::Frame frame;
  std::string text;
};

struct Difference {
  DifferenceKind kind{};
  Service service{};
  std::uint8_t node_id = 0;  ///< 0: LSS
  std::size_t line = 0;      ///< of the log: of the expected frame, else of the last frame before the received one
  bool has_time = false;
  std::int64_t us = 0;                  ///< of this line, since the first frame of the log
  std::optional<EntryKey> entry;        ///< of an SDO transfer
  std::optional<DecodedFrame> request;  ///< the last one before it, of SDO and LSS
  std::optional<DecodedFrame> expected, received;
};

struct Result {
  std::uint64_t sent = 0;      ///< frames of the log
  std::uint64_t compared = 0;  ///< frames of the log that the nodes should have sent
  std::vector<Difference> differences;
};

/// The nodes that answer SDO requests in these frames.
[[nodiscard]] NodeSet answering_nodes(const std::vector<RecordedFrame>& frames);
/// The nodes that send frames with a fixed CAN-ID: SDO responses, EMCYs, boot-up messages and heartbeats.
[[nodiscard]] NodeSet sending_nodes(const std::vector<RecordedFrame>& frames);

/// `known`: nodes with an EDS, for names, PDOs and further SDO servers. Throws Interrupted, BusLost.
[[nodiscard]] Result replay(LiveBus& bus, const std::vector<RecordedFrame>& frames, const std::vector<KnownNode>& known,
                            const Settings& settings);

}  // namespace edsc::replay
