/// The motor of a drive on own hardware: the functions that the CiA 402 profile calls. Here the hardware moves at once.
#pragma once

#include <canopen/profile/cia402_node.hpp>
#include <cpc_tc1/device.hpp>
#include <cstdint>

struct Motor {
  void enable(bool on) { powered = on; }
  void move_to(std::int32_t target, const canopen::cia402::Profile&) { demand = actual = powered ? target : actual; }
  void run_at(std::int32_t velocity, const canopen::cia402::Profile&) { speed = powered ? velocity : 0; }
  void stop(std::uint32_t /*deceleration*/) { speed = 0; }
  void follow(std::int32_t target) { demand = actual = target; }
  void set_position(std::int32_t position) { demand = actual = position; }
  void step(canopen::Duration) {}
  bool moving() const { return speed != 0; }
  std::int32_t position() const { return actual; }
  std::int32_t velocity() const { return speed; }
  std::int32_t position_demand() const { return demand; }
  std::int32_t velocity_demand() const { return speed; }
  std::uint32_t inputs() const { return 0; }  // limit and home switches
  bool index_pulse() { return false; }

  bool powered = false;
  std::int32_t actual = 0, demand = 0, speed = 0;
};

/// The drive has neither storage nor LSS.
using ServoParts = canopen::Composition<cpc_tc1::Device, canopen::without<canopen::part::lss, canopen::part::storage>>;
