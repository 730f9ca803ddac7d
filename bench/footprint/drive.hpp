/// An application as a user has it: a class in a header, with a function for a written object and an error that is
/// reported.
#pragma once

#include <canopen/node.hpp>
#include <cstdint>
#include <device/device.hpp>

class Drive {
 public:
  void written(device::od::drive_6083, std::uint32_t acceleration) { ramp() = acceleration; }

  /// Reports an error while the output stage has one.
  void check(auto& node) {
    const bool faulty = fault() != 0;
    if (faulty == faulty_) return;
    faulty_ = faulty;
    if (faulty) {
      node.emergency(short_circuit, canopen::ErrorRegister::current);
    } else {
      node.emergency_over(canopen::ErrorRegister::current);
    }
  }

 private:
  static constexpr std::uint16_t short_circuit = 0x2320;

  // Registers of the output stage
  static volatile std::uint32_t& ramp() { return *reinterpret_cast<volatile std::uint32_t*>(0x4001'0000); }
  static volatile std::uint32_t& fault() { return *reinterpret_cast<volatile std::uint32_t*>(0x4001'0004); }

  bool faulty_ = false;
};
