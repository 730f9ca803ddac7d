/// Node-ID of a device.
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>

namespace canopen {

namespace node_id_detail {

// A constant that is not a node-ID reads the element after the only one: the compiler's message has the name of the
// array.
inline constexpr bool node_id_is_not_1_to_127[1] = {};

}  // namespace node_id_detail

/// 1..127 (CiA 301, 7.2.2). A constant outside this range does not compile; `all_nodes` is 0, and
/// `unconfigured_node_id` a device without node-ID (CiA 305). A value of a `std::uint8_t` is not checked here: `from`
/// checks it. A node with an invalid node-ID remains in Initialisation.
class NodeId {
 public:
  constexpr NodeId() = default;
  /// A constant. Clang before 16 ends with a segmentation fault where such a constructor is consteval: there, a
  /// constant outside the range is an invalid node-ID, as a value at run time is.
#if defined(__clang__) && __clang_major__ < 16
  template <std::same_as<int> Constant>
  constexpr explicit NodeId(const Constant& constant)
      : value_{constant >= 1 && constant <= 127 ? static_cast<std::uint8_t>(constant) : std::uint8_t{0}} {}
#else
  template <std::same_as<int> Constant>
  consteval explicit NodeId(const Constant& constant) : value_{static_cast<std::uint8_t>(constant)} {
    if (node_id_detail::node_id_is_not_1_to_127[constant >= 1 && constant <= 127 ? 0 : 1]) value_ = 0;
  }
#endif
  constexpr explicit NodeId(std::uint8_t value) : value_{value} {}

  /// Returns the node-ID of a value that is known only at run time, such as that of a switch; empty if it is
  /// not 1..127.
  [[nodiscard]] static constexpr std::optional<NodeId> from(std::uint8_t value) {
    const NodeId node_id{value};
    return node_id.valid() ? std::optional{node_id} : std::nullopt;
  }

  [[nodiscard]] constexpr std::uint8_t value() const { return value_; }
  [[nodiscard]] constexpr bool valid() const { return value_ >= 1 && value_ <= 127; }

  friend constexpr bool operator==(NodeId, NodeId) = default;

 private:
  std::uint8_t value_ = 0;
};

/// All nodes, where a service allows it: NMT commands and DAM-MPDOs.
inline constexpr NodeId all_nodes{std::uint8_t{0}};

}  // namespace canopen
