/// A servo drive with device profile 402 whose EDS has six objects of the profile: no mode of operation, no ramps.
#pragma once

#include <canopen/base/abort_code.hpp>
#include <canopen/lss/lss_handler.hpp>
#include <canopen/lss/lss_protocol.hpp>
#include <canopen/node.hpp>
#include <cpc_tc1/device.hpp>
#include <cstdint>

#include "shared/description.hpp"
#include "shared/drive_node.hpp"
#include "shared/lss_settings.hpp"

namespace cpc_tc1_node {

namespace od = cpc_tc1::od;
namespace mode = canopen::cia402::mode;

/// Positions are increments, velocities increments per second.
inline constexpr nodes::AxisData axis{.increments_per_turn = 8'192,
                                      .velocity_unit = 1,
                                      .acceleration_unit = 1,
                                      .highest_velocity = 8'192 * 80,
                                      .highest_acceleration = 8'192 * 1'000};

/// The vendor's program sets mode and ramps.
inline constexpr canopen::cia402::Options options = [] {
  canopen::cia402::Options result;
  result.modes = canopen::cia402::bit_of_mode(mode::profile_position) |
                 canopen::cia402::bit_of_mode(mode::profile_velocity) |
                 canopen::cia402::bit_of_mode(mode::cyclic_synchronous_position);
  result.initial_mode = mode::profile_position;
  result.actual_values = 10'000;
  result.profile = {.velocity = 8'192 * 20, .acceleration = 8'192 * 100, .deceleration = 8'192 * 100};
  return result;
}();

/// Parameters are not stored or restored while the motor is on.
struct RefusesWithMotorOn {
  const bool* motor_on;
  canopen::AbortCode operator()(std::uint32_t) const {
    return *motor_on ? canopen::AbortCode::device_state : canopen::ok;
  }
};

template <std::uint8_t SubIndex>
using Store = canopen::WriteHandler<od::store_parameters<SubIndex>, RefusesWithMotorOn>;
template <std::uint8_t SubIndex>
using Restore = canopen::WriteHandler<od::restore_default_parameters<SubIndex>, RefusesWithMotorOn>;

template <class Self, canopen::Bus B>
using Base = nodes::DriveNode<Self, cpc_tc1::Device, B, options, canopen::StoredIn<nodes::NodeStorage>,
                              canopen::ConfiguredByLss<nodes::LssSettings>, Store<1>, Store<2>, Store<3>, Restore<1>,
                              Restore<2>, Restore<3>>;

/// Initialized before the node, which starts with the node-ID that LSS has stored.
struct ConfiguredByLss {
  explicit ConfiguredByLss(nodes::Surroundings& around) : lss{around, canopen::NodeId{1}, bit_rate_1000} {}
  static constexpr canopen::LssBitTiming bit_rate_1000{0, 0};
  nodes::LssSettings lss;
};

/// Bits of 1002h above those of the statusword.
namespace status {
inline constexpr std::uint32_t external_enable = 1u << 16;
inline constexpr std::uint32_t motor_on = 1u << 17;
inline constexpr std::uint32_t phase_found = 1u << 18;
inline constexpr std::uint32_t stationary = 1u << 24;
}  // namespace status

template <canopen::Bus B>
class CpcTc1 : private ConfiguredByLss, public Base<CpcTc1<B>, B> {
  using Node = Base<CpcTc1<B>, B>;
  using Node::axis_;
  using Node::drive_;
  using Node::node_;

 public:
  static constexpr nodes::Description description{
      "cpc_tc1", "A servo drive of CiA 402 that LSS configures.", "the one that LSS has stored, or 1",
      "  mode N                           1 position, 3 velocity, 8 cyclic position: there is no 6060h\n"
      "  enable on|off                    the input External Enable\n"
      "  fault CODE [BITS]                an error of the drive: 603Fh, EMCY; BITS of 1001h\n"
      "  limit negative|positive on|off   a limit switch\n"
      "  block on|off                     something keeps the shaft from turning\n"
      "  position N                       the shaft is turned by hand, without power\n"};

  CpcTc1(B& bus, nodes::Surroundings& around)
      : ConfiguredByLss{around},
        Node{bus,
             around,
             lss.node_id(),
             axis,
             canopen::stored_in(around.parameters),
             canopen::configured_by_lss(lss),
             {{&motor_on_}},
             {{&motor_on_}},
             {{&motor_on_}},
             {{&motor_on_}},
             {{&motor_on_}},
             {{&motor_on_}}} {}

  void restarted() {
    static_cast<void>(node_.set(od::identity_object::serial_number{}, this->around_.serial_number));
    phase_found_ = false;
  }

  /// Updates 1002h; bits 0 to 15 are the statusword.
  void watch() {
    motor_on_ = canopen::cia402::has_power(drive_.state());
    phase_found_ = phase_found_ || motor_on_;
    std::uint32_t bits = node_.get(od::statusword{});
    if (external_enable_) bits |= status::external_enable;
    if (motor_on_) bits |= status::motor_on;
    if (phase_found_) bits |= status::phase_found;
    if (axis_.velocity() == 0) bits |= status::stationary;
    static_cast<void>(node_.set(od::manufacturer_status_register{}, bits));
  }

  bool take_line(const nodes::InputLine& line) {
    if (line.is("mode", 1)) {
      const auto wanted = line.number<std::int8_t>(1);
      if (wanted) drive_.select(*wanted);
      return wanted && drive_.supports(*wanted);
    }
    if (line.is("enable", 1)) {
      const auto on = line.on_or_off(1);
      if (!on) return false;
      external_enable_ = *on;
      if (!external_enable_) drive_.quick_stop(node_);
      return true;
    }
    return false;
  }

 private:
  bool motor_on_ = false;
  bool external_enable_ = true;
  bool phase_found_ = false;
};

}  // namespace cpc_tc1_node
