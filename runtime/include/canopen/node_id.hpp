/// Node-ID: a device's number on the bus.
#pragma once

#include <cstdint>

namespace canopen {

/// 1..127 (CiA 301, 7.2.2). 0 means all nodes where a service allows it, 255 a device that has none yet (CiA 305).
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
