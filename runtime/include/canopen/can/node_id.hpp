/// Node-ID of a device.
#pragma once

#include <cstdint>

namespace canopen {

/// 1..127 (CiA 301, 7.2.2). 0 is all nodes if a service allows it, 255 a device without node-ID (CiA 305).
class NodeId {
 public:
  constexpr NodeId() = default;
  constexpr explicit NodeId(std::uint8_t value) : value_{value} {}

  [[nodiscard]] constexpr std::uint8_t value() const { return value_; }
  [[nodiscard]] constexpr bool valid() const { return value_ >= 1 && value_ <= 127; }

  friend constexpr bool operator==(NodeId, NodeId) = default;

 private:
  std::uint8_t value_ = 0;
};

}  // namespace canopen
