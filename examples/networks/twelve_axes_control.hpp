/// The master of twelve_axes.json: each axis follows the position of the one before it, and the first one a target.
#pragma once

#include <canopen_plant/plant.hpp>
#include <cstdint>
#include <twelve_axes.hpp>

template <canopen::Bus B>
class TwelveAxes {
 public:
  explicit TwelveAxes(B& bus) : plant{bus} {
    follow(plant.axis2, twelve_axes::signals::axis1::position_actual_value{});
    follow(plant.axis3, twelve_axes::signals::axis2::position_actual_value{});
    follow(plant.axis4, twelve_axes::signals::axis3::position_actual_value{});
    follow(plant.axis5, twelve_axes::signals::axis4::position_actual_value{});
    follow(plant.axis6, twelve_axes::signals::axis5::position_actual_value{});
    follow(plant.axis7, twelve_axes::signals::axis6::position_actual_value{});
    follow(plant.axis8, twelve_axes::signals::axis7::position_actual_value{});
    follow(plant.axis9, twelve_axes::signals::axis8::position_actual_value{});
    follow(plant.axis10, twelve_axes::signals::axis9::position_actual_value{});
    follow(plant.axis11, twelve_axes::signals::axis10::position_actual_value{});
    follow(plant.axis12, twelve_axes::signals::axis11::position_actual_value{});
  }

  /// The target of the first axis and the profile velocity of all, in the units of the drives.
  void move_to(std::int32_t target, std::uint32_t velocity) {
    plant.axis1.target_position(canopen::raw(target));
    for_each_axis([velocity](auto& axis) { axis.profile_velocity(canopen::raw(velocity)); });
  }

  canopen::Plant<twelve_axes::Network, B> plant;

 private:
  template <class Axis, class Leader>
  void follow(Axis& axis, Leader leader) {
    plant.on(leader, [&axis](auto position) { axis.target_position(position); });
  }

  template <class Visit>
  void for_each_axis(Visit visit) {
    visit(plant.axis1), visit(plant.axis2), visit(plant.axis3), visit(plant.axis4);
    visit(plant.axis5), visit(plant.axis6), visit(plant.axis7), visit(plant.axis8);
    visit(plant.axis9), visit(plant.axis10), visit(plant.axis11), visit(plant.axis12);
  }
};
