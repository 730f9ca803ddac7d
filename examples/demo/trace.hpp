/// A readable trace of a bus: each frame with its time, CAN-ID, bytes, and meaning with the names of the EDS files.
#pragma once

#include <canopen/base/clock.hpp>
#include <canopen/can/frame.hpp>
#include <canopen/can/node_id.hpp>
#include <canopen/od/description.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "pdo_description.hpp"

namespace demo {

/// Names and PDOs of a node.
struct KnownNode {
  std::string name;
  std::span<const canopen::EntryDescription> names;
  std::vector<PdoDescription> pdos;
};

class Trace {
 public:
  void add(canopen::NodeId id, KnownNode node) { nodes_[id.value()] = std::move(node); }
  void print(const canopen::Frame& frame, canopen::TimePoint now);

  /// If disabled, frames are only counted.
  void enable(bool on) { on_ = on; }
  [[nodiscard]] std::size_t frames() const { return frames_; }

 private:
  [[nodiscard]] std::string meaning(const canopen::Frame& frame);
  [[nodiscard]] std::string sdo_request(const canopen::Frame& frame, const KnownNode& node, std::uint8_t id);
  [[nodiscard]] std::string sdo_response(const canopen::Frame& frame, const KnownNode& node, std::uint8_t id);
  [[nodiscard]] std::string pdo(const canopen::Frame& frame, const KnownNode& node, bool transmit,
                                std::uint16_t number) const;

  /// The entry of the last SDO request to a node, which segments do not repeat.
  struct Mux {
    std::uint16_t index = 0;
    std::uint8_t sub_index = 0;
  };

  std::map<std::uint8_t, KnownNode> nodes_;
  std::map<std::uint8_t, Mux> open_sdo_;
  std::size_t frames_ = 0;
  bool on_ = true;
};

}  // namespace demo
