#include "conform/dut/sdo_transfers.hpp"

#include <algorithm>
#include <canopen/base/abort_code.hpp>
#include <canopen/sdo/sdo_protocol.hpp>
#include <canopen/sdo/sdo_transfer.hpp>

namespace edsc::conform {
namespace {

namespace sdo = canopen::sdo;

enum class Initiate : std::uint8_t { none, upload, download };

/// The default SDO of the node.
class DefaultSdo {
 public:
  explicit DefaultSdo(canopen::NodeId node) : sdo_{canopen::default_sdo(node)} {}

  [[nodiscard]] bool is_request(const SeenFrame& seen) const {
    return seen.sent && has_id(seen, sdo_.request.can_id());
  }
  [[nodiscard]] bool is_response(const SeenFrame& seen) const {
    return !seen.sent && has_id(seen, sdo_.response.can_id());
  }
  /// Whether the frame begins a transfer (CiA 301, 7.2.4.3).
  [[nodiscard]] Initiate initiates(const SeenFrame& seen) const {
    if (!is_request(seen)) return Initiate::none;
    const std::uint8_t command = seen.frame.data[0];
    switch (command >> 5) {
      case 1: return Initiate::download;
      case 2: return Initiate::upload;
      case 5: return (command & 3) == 0 ? Initiate::upload : Initiate::none;
      case 6: return (command & 1) == 0 ? Initiate::download : Initiate::none;
      default: return Initiate::none;
    }
  }

 private:
  static bool has_id(const SeenFrame& seen, std::uint32_t can_id) {
    return seen.frame.id == can_id && !seen.frame.extended && !seen.frame.remote && seen.frame.size == 8;
  }

  canopen::SdoChannel sdo_;
};

std::uint16_t index_of(const SeenFrame& seen) {
  return static_cast<std::uint16_t>(seen.frame.data[1] | seen.frame.data[2] << 8);
}

bool is_abort(const SeenFrame& seen) { return seen.frame.data[0] == sdo::abort_command; }

}  // namespace

std::vector<std::size_t> last_transfer(std::span<const SeenFrame> frames, canopen::NodeId node, std::uint16_t index,
                                       std::uint8_t sub_index) {
  const DefaultSdo server{node};
  const auto begins = [&](const SeenFrame& seen) {
    return server.initiates(seen) != Initiate::none && index_of(seen) == index && seen.frame.data[3] == sub_index;
  };
  std::size_t first = frames.size();
  while (first != 0 && !begins(frames[first - 1])) --first;
  if (first == 0) return {};
  std::vector<std::size_t> positions = {first - 1};
  for (std::size_t i = first; i != frames.size() && server.initiates(frames[i]) == Initiate::none; ++i) {
    if (server.is_request(frames[i]) || server.is_response(frames[i])) positions.push_back(i);
    if (server.is_response(frames[i]) && is_abort(frames[i])) break;
  }
  constexpr std::size_t at_each_end = 2;
  if (positions.size() > 2 * at_each_end)
    positions.erase(positions.begin() + at_each_end, positions.end() - at_each_end);
  return positions;
}

std::vector<RefusedWrite> refused_writes(std::span<const SeenFrame> frames, canopen::NodeId node,
                                         std::span<const std::size_t> positions) {
  const DefaultSdo server{node};
  std::vector<RefusedWrite> writes;
  const SeenFrame* open = nullptr;
  for (const std::size_t position : positions) {
    const SeenFrame& seen = frames[position];
    if (const Initiate initiate = server.initiates(seen); initiate != Initiate::none) {
      if (open != nullptr || initiate != Initiate::download) return {};
      open = &seen;
    } else if (open != nullptr && server.is_response(seen) && is_abort(seen)) {
      const canopen::AbortCode code = canopen::abort_code_from(sdo::word_of(seen.frame.data));
      const RefusedWrite write{index_of(*open), open->frame.data[3], code};
      if (std::ranges::find(writes, write) == writes.end()) writes.push_back(write);
      open = nullptr;
    }
  }
  if (open != nullptr) return {};
  return writes;
}

}  // namespace edsc::conform
