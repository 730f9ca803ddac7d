/// A node of a plant: its name in the network file, and what the master knows of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "canopen/can/cob_id.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/nmt/nmt.hpp"

namespace canopen {

/// A row of the network file.
struct PlantNode {
  std::string_view name;  ///< empty: a node that the network file does not list
  NodeId node_id;
  std::uint32_t emcy = CobId::invalid_bit;  ///< 1014h of the node as configured; bit 31: it does not send EMCY
};

/// Base of the typed nodes of a plant, such as `plant.axis1`: node `Position` of the network.
template <class Plant, std::size_t Position>
class PlantNodeAccess {
 public:
  constexpr explicit PlantNodeAccess(Plant& plant) : plant_{plant} {}
  PlantNodeAccess(const PlantNodeAccess&) = delete;
  PlantNodeAccess& operator=(const PlantNodeAccess&) = delete;

  [[nodiscard]] static constexpr std::string_view name() { return Plant::Network::nodes[Position].name; }
  [[nodiscard]] static constexpr NodeId node_id() { return Plant::Network::nodes[Position].node_id; }

  /// Returns the last state that the node reported; empty if it is unknown or the node is lost.
  [[nodiscard]] std::optional<NmtState> state() const { return plant_.state(node_id()); }

  /// Whether the node has been identified and configured since its last boot-up message, and is not lost.
  [[nodiscard]] bool booted() const { return plant_.booted(Position); }

  /// Resets the node and boots it again, for instance after a fault has been repaired.
  void boot() { plant_.boot(node_id()); }

 protected:
  [[nodiscard]] Plant& plant() { return plant_; }
  [[nodiscard]] const Plant& plant() const { return plant_; }

 private:
  Plant& plant_;
};

}  // namespace canopen
