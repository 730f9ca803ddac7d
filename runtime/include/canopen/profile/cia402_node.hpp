/// A drive of CiA 402-2 as one object: a node, device control, and the axis that the user writes.
///
///     struct Motor { ... };  // an Axis: profile/cia402_axis.hpp
///     canopen::cia402::DriveNode<cpc_tc1::Device, Bus, Motor> drive{bus, canopen::NodeId{5}};
///     drive.start(now);                                   // then like a node: on_frame, on_time, next_deadline
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/emcy/emcy_producer.hpp"
#include "canopen/emcy/error_register.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/node.hpp"
#include "canopen/od/object.hpp"
#include "canopen/profile/cia402.hpp"
#include "canopen/profile/cia402_axis.hpp"
#include "canopen/profile/cia402_options.hpp"
#include "canopen/profile/profile_node.hpp"

namespace canopen::cia402 {

/// The axis is a member. It may also have the functions of NoApplication, profile/cia402.hpp, for what is specific to
/// the manufacturer. `Parts`: a device or a composition. `Handlers`: further parts of the node, such as an application
/// class or a storage.
template <class Parts, Bus BusType, Axis AxisType, Options options = Options{}, class... Handlers>
class DriveNode : public ProfileNode<DriveNode<Parts, BusType, AxisType, options, Handlers...>> {
  friend ProfileNode<DriveNode>;
  using Device = composition_detail::DeviceOf<Parts>;

 public:
  constexpr DriveNode(BusType& bus, NodeId node_id, Handlers... handlers)
      : node_{bus, node_id, drive_.error_handler(), restart(), std::move(handlers)...} {}

  /// Moves the axis and sends what is due. Call it at `next_deadline`, and after the axis has changed by itself.
  void on_time(TimePoint now) {
    drive_.on_time(node_, now, axis_);
    node_.on_time(now);
  }
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    const std::optional<TimePoint> of_node = node_.next_deadline();
    const std::optional<TimePoint> of_drive = drive_.next_deadline();
    return of_node && of_drive ? std::min(*of_node, *of_drive) : of_node ? of_node : of_drive;
  }

  /// Reports an error of the drive, like Drive::fault.
  void fault(EmergencyCode code, ErrorRegister bits, TimePoint now, const EmergencyInfo& info = {}) {
    drive_.fault(node_, code, bits, info);
    on_time(now);
  }

  [[nodiscard]] AxisType& axis() { return axis_; }
  [[nodiscard]] const AxisType& axis() const { return axis_; }
  [[nodiscard]] auto& drive() { return drive_; }
  [[nodiscard]] const auto& drive() const { return drive_; }
  [[nodiscard]] auto& node() { return node_; }
  [[nodiscard]] const auto& node() const { return node_; }

 private:
  void after_event(TimePoint now) { on_time(now); }

  using Control = Drive<Device, AxisType, options>;

  /// Starts device control again at power-on and at each NMT reset.
  struct Restarting {
    Control* drive;
    void on_state(NmtState state) {
      if (state == NmtState::initialisation) drive->start();
    }
  };

  // Interpolated position mode: data records, and SYNC as the clock.

  struct Interpolating : Restarting {
    template <DictionaryObject Object>
    requires(Object::index == 0x60C1 + options.axis * axis_distance && Object::sub_index == 1) AbortCode
        write(Object, const typename Object::type& value, auto& node) {
      return this->drive->offer_set_point(node, static_cast<std::int32_t>(value));
    }
  };
  struct Synchronous : Interpolating {
    void on_sync(std::uint8_t, auto& node) { this->drive->on_sync(node); }
  };
  using Restart = std::conditional_t<!Control::has_interpolation, Restarting,
                                     std::conditional_t<Device::dictionary.has(0x1005, 0), Synchronous, Interpolating>>;

  [[nodiscard]] constexpr Restart restart() {
    Restart application{};
    application.drive = &drive_;
    return application;
  }

  AxisType axis_{};
  Control drive_{axis_};
  composition_detail::NodeWith<
      Parts, BusType, composition_detail::Types<ErrorHandler<typename Control::ErrorTaker>, Restart>, Handlers...>
      node_;
};

}  // namespace canopen::cia402
