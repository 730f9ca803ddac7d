/// Touch probes: the positions at edges of two inputs or of the index pulse, 60B8h to 60BDh (CiA 402-2, touch probe).
#pragma once

#include <cstdint>

#include "canopen/profile/cia402_axis.hpp"
#include "canopen/profile/cia402_objects.hpp"
#include "canopen/profile/cia402_parameters.hpp"

namespace canopen::cia402 {

/// Bits of 60B8h and 60B9h for touch probe 1; those of touch probe 2 are 8 bits higher.
namespace touch_probe {
inline constexpr std::uint16_t enable = 0x01;
inline constexpr std::uint16_t continuous = 0x02;  ///< 0: the first event only
inline constexpr std::uint16_t source = 0x0C;      ///< of the signal
inline constexpr std::uint16_t positive_edge = 0x10;
inline constexpr std::uint16_t negative_edge = 0x20;

inline constexpr std::uint16_t is_enabled = 0x01;
inline constexpr std::uint16_t positive_stored = 0x02;
inline constexpr std::uint16_t negative_stored = 0x04;

inline constexpr std::int16_t zero_impulse = 5;  ///< of the position encoder, a value of 60D0h
}  // namespace touch_probe

/// Edges before the function has been enabled or changed are ignored. After the first event, disable and enable the
/// function for the next one.
template <class DriveParameters>
class TouchProbes {
 public:
  void clear() { *this = TouchProbes{}; }

  /// Whether the axis is to be asked for edges, with or without power.
  [[nodiscard]] bool enabled() const { return ((function_ | function_ >> 8) & touch_probe::enable) != 0; }

  /// Processes 60B8h.
  template <class Node, class AxisType>
  void take(Node& node, AxisType& axis) {
    const auto function = DriveParameters::template value<object::TouchProbeFunction>(node, 0);
    if (function == function_) return;
    const auto changed = static_cast<std::uint16_t>(function ^ function_);
    function_ = function;
    for (unsigned probe = 0; probe < 2; ++probe) {
      const unsigned shift = probe * 8;
      if (((changed >> shift) & 0xFF) == 0) continue;
      const bool on = (function >> shift & touch_probe::enable) != 0;
      status_ = static_cast<std::uint16_t>(status_ & ~(0xFFu << shift));
      if (!on) continue;
      status_ = static_cast<std::uint16_t>(status_ | touch_probe::is_enabled << shift);
      for (const bool positive : {true, false}) static_cast<void>(axis.latched(edge_of(node, probe, positive)));
    }
    DriveParameters::template set<object::TouchProbeStatus>(node, status_);
  }

  /// Stores the positions of new edges.
  template <class Node, class AxisType>
  void step(Node& node, AxisType& axis) {
    if (!enabled()) return;
    store<object::TouchProbe1Positive>(node, axis, 0, true);
    store<object::TouchProbe1Negative>(node, axis, 0, false);
    store<object::TouchProbe2Positive>(node, axis, 1, true);
    store<object::TouchProbe2Negative>(node, axis, 1, false);
    DriveParameters::template set<object::TouchProbeStatus>(node, status_);
  }

 private:
  /// Where the signal of a touch probe comes from.
  template <class Node>
  [[nodiscard]] ProbeEdge edge_of(const Node& node, unsigned probe, bool positive) const {
    const auto number = static_cast<std::uint8_t>(probe + 1);
    std::int16_t source = number;
    switch (function_ >> probe * 8 & touch_probe::source) {
      case 0x04: source = touch_probe::zero_impulse; break;
      case 0x08:
        source = probe == 0 ? DriveParameters::template value<object::TouchProbe1Source>(node, source)
                            : DriveParameters::template value<object::TouchProbe2Source>(node, source);
        break;
      default: break;
    }
    return {number, source, positive};
  }

  template <class Position, class Node, class AxisType>
  void store(Node& node, AxisType& axis, unsigned probe, bool positive) {
    const unsigned bits = unsigned{function_} >> probe * 8;
    const unsigned wanted = positive ? touch_probe::positive_edge : touch_probe::negative_edge;
    if ((bits & touch_probe::enable) == 0 || (bits & wanted) == 0) return;
    const unsigned stored = unsigned{positive ? touch_probe::positive_stored : touch_probe::negative_stored}
                            << probe * 8;
    if ((status_ & stored) != 0 && (bits & touch_probe::continuous) == 0) return;
    const auto position = axis.latched(edge_of(node, probe, positive));
    if (!position) return;
    DriveParameters::template set<Position>(node, *position);
    status_ = static_cast<std::uint16_t>(status_ | stored);
  }

  std::uint16_t function_ = 0;  ///< 60B8h as processed last
  std::uint16_t status_ = 0;    ///< 60B9h
};

}  // namespace canopen::cia402
