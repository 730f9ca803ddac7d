/// What a node on a host finds around it: its settings, its storage and a log.
#pragma once

#include <canopen/node_id.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "node_storage.hpp"

namespace nodes {

/// It outlives the node, so that what is stored comes back when the node is switched on again.
class Surroundings {
 public:
  using Log = std::function<void(std::string_view line)>;

  /// `store` is the path of the file that parameters are stored in, FILE.lss beside it that of LSS; empty: no files.
  Surroundings(std::optional<canopen::NodeId> chosen_node_id, std::uint32_t serial, const std::string& store,
               Log log_to)
      : node_id{chosen_node_id},
        serial_number{serial},
        parameters{store},
        lss{store.empty() ? store : store + ".lss"},
        log{std::move(log_to)} {}
  explicit Surroundings(canopen::NodeId chosen_node_id)
      : Surroundings{chosen_node_id, 1, {}, [](std::string_view) {}} {}

  std::optional<canopen::NodeId> node_id;  ///< what the switches say; nothing: the device's own
  std::uint32_t serial_number;             ///< 1018h:04, where the device has it settable
  NodeStorage parameters;                  ///< for 1010h and 1011h
  NodeStorage lss;                         ///< node-ID and bit rate
  Log log;
};

}  // namespace nodes
