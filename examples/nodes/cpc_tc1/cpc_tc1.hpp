/// A servo drive with device profile 402 whose EDS has six objects of the profile: no mode of operation, no ramps.
#pragma once

#include <algorithm>
#include <array>
#include <canopen/base/abort_code.hpp>
#include <canopen/base/clock.hpp>
#include <canopen/can/frame.hpp>
#include <canopen/emcy/emcy_producer.hpp>
#include <canopen/lss/lss_handler.hpp>
#include <canopen/lss/lss_protocol.hpp>
#include <canopen/nmt/nmt.hpp>
#include <canopen/node.hpp>
#include <cpc_tc1/device.hpp>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "shared/description.hpp"
#include "shared/drive_node.hpp"
#include "shared/lss_settings.hpp"
#include "vendor_data.hpp"

namespace cpc_tc1_node {

namespace od = cpc_tc1::od;
namespace mode = canopen::cia402::mode;

/// Positions are increments, velocities increments per second.
inline constexpr canopen::cia402::AxisData axis{.increments_per_turn = 8'192,
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

/// What the handlers of 1010h and 1011h need.
struct Memory {
  bool motor_on = false;
  VendorData data;
};

/// "save" to a sub-index of 1010h. Parameters are not stored or restored while the motor is on.
template <std::uint8_t SubIndex>
struct Saves {
  Memory* memory;
  canopen::AbortCode operator()(typename od::store_parameters<SubIndex>::type) const {
    if (memory->motor_on) return canopen::AbortCode::device_state;
    return memory->data.save(SubIndex);
  }
};
/// "load" to a sub-index of 1011h.
template <std::uint8_t SubIndex>
struct Loads {
  Memory* memory;
  canopen::AbortCode operator()(typename od::restore_default_parameters<SubIndex>::type) const {
    if (memory->motor_on) return canopen::AbortCode::device_state;
    return memory->data.restore(SubIndex);
  }
};

template <std::uint8_t SubIndex>
using Store = canopen::WriteHandler<od::store_parameters<SubIndex>, Saves<SubIndex>>;
template <std::uint8_t SubIndex>
using Restore = canopen::WriteHandler<od::restore_default_parameters<SubIndex>, Loads<SubIndex>>;

template <class Self, canopen::Bus B>
using Base =
    nodes::DriveNode<Self, cpc_tc1::Device, B, options, canopen::StoredIn<nodes::NodeStorage>,
                     canopen::ConfiguredByLss<nodes::LssSettings>, Store<1>, Store<2>, Store<3>, Store<4>, Store<5>,
                     Store<6>, Restore<1>, Restore<2>, Restore<3>, Restore<4>, Restore<5>, Restore<6>>;

/// Initialized before the node, which starts with the stored node-ID.
struct BeforeNode {
  explicit BeforeNode(nodes::Surroundings& around)
      : lss{around, canopen::NodeId{1}, bit_rate_1000}, memory{.data = VendorData{around.application}} {}
  static constexpr canopen::LssBitTiming bit_rate_1000{0, 0};
  nodes::LssSettings lss;
  Memory memory;
};

template <canopen::Bus B>
class CpcTc1 : private BeforeNode, public Base<CpcTc1<B>, B> {
  using Node = Base<CpcTc1<B>, B>;
  using Node::around_;
  using Node::axis_;
  using Node::drive_;
  using Node::node_;

 public:
  static constexpr nodes::Description description{
      "cpc_tc1", "A servo drive of CiA 402 that LSS configures.", "the one that LSS has stored, or 1",
      "  mode N                           1 position, 3 velocity, 8 cyclic position: there is no 6060h\n"
      "  enable on|off                    the input External Enable\n"
      "  home-position N|lost             the homing of the vendor's software: the shaft is at position N\n"
      "  error-mapping on|off             the function error mapping\n"
      "  error-mapping-table BYTE...      its table\n"
      "  auxiliary N|off                  the auxiliary command in increments per second, added to the internal one\n"
      "  program BYTE...                  the program of the virtual machine\n"
      "  rs232 N                          the bit rate of the RS-232 channel\n"
      "  node-id N                        the persistent node-ID, 1 to 127, valid after a power cycle\n"
      "  baud N                           the persistent bit rate, 10000 to 1000000 bit/s\n"
      "  memory good|bad                  whether the non-volatile memory can be written\n"
      "  nmt COMMAND                      by local control: start, stop, pre-operational, reset-node,\n"
      "                                   reset-communication\n"
      "  fault CODE [BITS [BYTE...]]      an error of the drive: EMCY, BITS of 1001h, up to five bytes\n"
      "  fault-over BITS                  the error with these bits is gone\n"
      "  limit negative|positive on|off   a limit switch\n"
      "  block on|off                     something keeps the shaft from turning\n"
      "  position N                       the shaft is turned by hand, without power\n"};

  CpcTc1(B& bus, nodes::Surroundings& around)
      : BeforeNode{around},
        Node{bus,
             around,
             lss.node_id(),
             axis,
             canopen::stored_in(around.parameters),
             canopen::configured_by_lss(lss),
             {{&memory}},
             {{&memory}},
             {{&memory}},
             {{&memory}},
             {{&memory}},
             {{&memory}},
             {{&memory}},
             {{&memory}},
             {{&memory}},
             {{&memory}},
             {{&memory}},
             {{&memory}}} {}

  void on_frame(const canopen::Frame& frame, canopen::TimePoint now) {
    resets_application_ = canopen::nmt_command(frame, node_.node_id()) == canopen::NmtCommand::reset_node;
    Node::on_frame(frame, now);
  }

  /// Power-on, or an NMT reset.
  void restarted() {
    static_cast<void>(node_.set(od::identity_object::serial_number{}, around_.serial_number));
    faults_.clear();
    phase_found_ = false;
    if (!resets_application_) return;
    home_established_ = false;
    auxiliary_.reset();
    memory.data.reset();
    const VendorValues& values = memory.data.values;
    around_.log("RS-232 " + std::to_string(values.rs232_rate) + " bit/s, program " +
                std::to_string(values.program.size()) + " bytes, error mapping " + (values.maps_errors ? "on" : "off") +
                ", " + std::to_string(values.error_mapping.size()) + " bytes");
  }

  /// Updates 1002h; bits 0 to 15 are the statusword.
  void watch() {
    memory.motor_on = canopen::cia402::has_power(drive_.state());
    phase_found_ = phase_found_ || memory.motor_on;
    add_auxiliary_command();
    using canopen::cia402::State;
    if (drive_.state() != State::fault && drive_.state() != State::fault_reaction_active) faults_.clear();
    const std::uint32_t statusword = node_.get(od::statusword{}).raw();
    od::manufacturer_status_register::type word{canopen::raw(statusword)};
    word.external_enable_digital_input(external_enable_)
        .motor_on(memory.motor_on)
        .phase_find_completed(phase_found_)
        .home_position_established(home_established_)
        .error_mapping_active(memory.data.values.maps_errors)
        .auxiliary_command_added(auxiliary_.has_value())
        .motor_stationary(axis_.velocity() == 0);
    static_cast<void>(node_.set(od::manufacturer_status_register{}, word));
  }

  // Inputs. Call `on_time` after them.

  /// The mode of the vendor's software: 1, 3 or 8. Returns false if the drive does not have it.
  [[nodiscard]] bool select_mode(std::int8_t wanted) {
    drive_.select(wanted);
    return drive_.supports(wanted);
  }
  /// The digital input External Enable.
  void set_external_enable(bool on) {
    external_enable_ = on;
    if (!on) drive_.quick_stop(node_);
  }
  /// The vendor's software has homed the axis: the shaft is at this position.
  void establish_home(std::int32_t position) {
    axis_.set_position(position);
    home_established_ = true;
  }
  void lose_home() { home_established_ = false; }
  /// Adds a command in increments per second to the internal one; empty: the auxiliary command is not used.
  void set_auxiliary_command(std::optional<std::int32_t> velocity) { auxiliary_ = velocity; }
  /// Bit rate of RS-232, program and error mapping.
  [[nodiscard]] VendorValues& vendor_values() { return memory.data.values; }
  /// Whether the non-volatile memory can be written.
  void set_memory(bool good) {
    around_.parameters.fail(!good);
    around_.application.fail(!good);
    around_.lss.fail(!good);
  }
  /// Reports an error with its manufacturer-specific bytes.
  void report(std::uint16_t code, canopen::ErrorRegister bits, const canopen::EmergencyInfo& info) {
    faults_.push_back({bits, info});
    this->fault(code, bits, info);
  }
  /// The errors with these bits are gone: EMCY 0000h has the bytes of the newest error that remains.
  void end_fault(canopen::ErrorRegister bits) {
    std::erase_if(faults_, [&](const Fault& fault) { return fault.bits == bits; });
    node_.emergency_over(bits, faults_.empty() ? canopen::no_emergency_info : faults_.back().info);
  }
  /// An NMT command by local control.
  void request(canopen::NmtCommand command, canopen::TimePoint now) {
    resets_application_ = command == canopen::NmtCommand::reset_node;
    node_.request(command, now);
  }
  /// Stores the node-ID for the next power-on.
  [[nodiscard]] bool set_persistent(canopen::NodeId node_id) {
    return lss.store(node_id, stored_settings().bit_timing()) == canopen::lss::success;
  }
  /// Stores the bit rate in bit/s for the next power-on. Returns false if the drive does not have it.
  [[nodiscard]] bool set_persistent_bit_rate(std::uint32_t rate) {
    for (const std::uint8_t index : bit_rates) {
      if (canopen::lss::bit_rates[index] * 1000u != rate) continue;
      return lss.store(stored_settings().node_id(), {0, index}) == canopen::lss::success;
    }
    return false;
  }

  bool take_line(const nodes::InputLine& line, canopen::TimePoint now) {
    return take_motion(line) || take_data(line) || take_setting(line) || take_fault(line) || take_command(line, now);
  }

 private:
  struct Fault {
    canopen::ErrorRegister bits;
    canopen::EmergencyInfo info;
  };

  /// Of table 0 of CiA 305: the rates that the manual lists.
  static constexpr std::uint8_t bit_rates[] = {0, 1, 2, 3, 4, 6, 7, 8};

  struct CommandName {
    std::string_view name;
    canopen::NmtCommand command;
  };
  static constexpr CommandName commands[] = {
      {"start", canopen::NmtCommand::start},
      {"stop", canopen::NmtCommand::stop},
      {"pre-operational", canopen::NmtCommand::enter_pre_operational},
      {"reset-node", canopen::NmtCommand::reset_node},
      {"reset-communication", canopen::NmtCommand::reset_communication},
  };

  [[nodiscard]] nodes::LssSettings stored_settings() { return {around_, lss.node_id(), lss.bit_timing()}; }

  /// A limit switch stops the auxiliary command, too.
  void add_auxiliary_command() {
    const std::int32_t wanted = drive_.operates() ? auxiliary_.value_or(0) : 0;
    axis_.add_velocity(canopen::cia402::limit_switch_blocks(axis_.inputs(), wanted) ? 0 : wanted);
  }

  [[nodiscard]] bool take_motion(const nodes::InputLine& line) {
    if (line.is("mode", 1)) {
      const auto wanted = line.number<std::int8_t>(1);
      return wanted && select_mode(*wanted);
    }
    if (line.is("enable", 1)) {
      const auto on = line.on_or_off(1);
      if (on) set_external_enable(*on);
      return on.has_value();
    }
    if (line.is("home-position", 1)) {
      const auto position = line.number<std::int32_t>(1);
      if (position) establish_home(*position);
      if (!position && line.word(1) == "lost") lose_home();
      return position || line.word(1) == "lost";
    }
    if (line.is("auxiliary", 1)) {
      const auto velocity = line.number<std::int32_t>(1);
      if (!velocity && line.word(1) != "off") return false;
      set_auxiliary_command(velocity);
      return true;
    }
    return false;
  }

  [[nodiscard]] bool take_data(const nodes::InputLine& line) {
    VendorValues& values = vendor_values();
    if (line.is("error-mapping", 1)) {
      const auto on = line.on_or_off(1);
      if (on) values.maps_errors = *on;
      return on.has_value();
    }
    if (line.is("rs232", 1)) {
      const auto rate = line.number<std::uint32_t>(1, 1);
      if (rate) values.rs232_rate = *rate;
      return rate.has_value();
    }
    const bool is_program = line.begins_with("program", 0);
    if (!is_program && !line.begins_with("error-mapping-table", 0)) return false;
    const auto bytes = bytes_of(line, 1);
    if (bytes) (is_program ? values.program : values.error_mapping) = *bytes;
    return bytes.has_value();
  }

  [[nodiscard]] bool take_setting(const nodes::InputLine& line) {
    if (line.is("node-id", 1)) {
      const auto node_id = line.number<std::uint8_t>(1, 1, 127);
      return node_id && set_persistent(canopen::NodeId{*node_id});
    }
    if (line.is("baud", 1)) {
      const auto rate = line.number<std::uint32_t>(1);
      return rate && set_persistent_bit_rate(*rate);
    }
    if (line.is("memory", 1) && (line.word(1) == "good" || line.word(1) == "bad")) {
      set_memory(line.word(1) == "good");
      return true;
    }
    return false;
  }

  [[nodiscard]] bool take_fault(const nodes::InputLine& line) {
    if (line.is("fault-over", 1)) {
      const auto bits = line.number<std::uint8_t>(1);
      if (bits) end_fault(static_cast<canopen::ErrorRegister>(*bits));
      return bits.has_value();
    }
    if (!line.begins_with("fault", 3)) return false;
    const auto code = line.number<std::uint16_t>(1);
    const auto bits = line.number<std::uint8_t>(2);
    const auto bytes = bytes_of(line, 3);
    canopen::EmergencyInfo info{};
    if (!code || !bits || !bytes || bytes->size() > info.size()) return false;
    std::ranges::copy(*bytes, info.begin());
    report(*code, static_cast<canopen::ErrorRegister>(*bits), info);
    return true;
  }

  [[nodiscard]] bool take_command(const nodes::InputLine& line, canopen::TimePoint now) {
    if (!line.is("nmt", 1)) return false;
    const auto* const row = std::ranges::find(commands, line.word(1), &CommandName::name);
    if (row != std::end(commands)) request(row->command, now);
    return row != std::end(commands);
  }

  /// Returns the arguments from a position on as bytes.
  [[nodiscard]] static std::optional<std::vector<std::uint8_t>> bytes_of(const nodes::InputLine& line,
                                                                         std::size_t first) {
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = first; line.begins_with(line.word(0), i); ++i) {
      const auto byte = line.number<std::uint8_t>(i);
      if (!byte) return std::nullopt;
      bytes.push_back(*byte);
    }
    return bytes;
  }

  bool external_enable_ = true;
  bool phase_found_ = false;
  bool home_established_ = false;
  bool resets_application_ = true;  ///< the next restart is power-on or a reset node
  std::optional<std::int32_t> auxiliary_;
  std::vector<Fault> faults_;  ///< with their bytes, the newest last
};

}  // namespace cpc_tc1_node
