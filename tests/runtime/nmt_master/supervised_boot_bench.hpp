/// Slaves with faults on a virtual bus, their network list, and what a master does with each fault.
#pragma once

#include <canopen/nmt_master/network_list.hpp>
#include <canopen_sim/virtual_bus.hpp>

#include <cstdint>
#include <list>
#include <optional>
#include <utility>
#include <vector>

#include "support/faulty_slave.hpp"

namespace supervised {

using canopen::Duration;
using canopen::Frame;
using canopen::NmtSlave;
using canopen::NodeId;
using canopen::TimePoint;
using canopen::VirtualBus;
using faulty::Fault;
namespace assignment = canopen::slave_assignment;

inline constexpr std::uint32_t device_type = 0x000F'0191;

/// 2001h:00 = 42, 1800h:01 = C0000185h and then 40000185h, 200Ch:00 = "hello", 2002h:00 = 1234h
inline constexpr std::uint8_t dcf[] = {5,    0,    0, 0,                                        //
                                       0x01, 0x20, 0, 1, 0, 0, 0, 0x2A,                         //
                                       0x00, 0x18, 1, 4, 0, 0, 0, 0x85, 0x01, 0x00, 0xC0,       //
                                       0x0C, 0x20, 0, 5, 0, 0, 0, 'h',  'e',  'l',  'l',  'o',  //
                                       0x02, 0x20, 0, 2, 0, 0, 0, 0x34, 0x12,                   //
                                       0x00, 0x18, 1, 4, 0, 0, 0, 0x85, 0x01, 0x00, 0x40};

inline const faulty::Values configured{{0x200100, {0x2A}},
                                       {0x180001, {0x85, 0x01, 0x00, 0x40}},
                                       {0x200C00, {'h', 'e', 'l', 'l', 'o'}},
                                       {0x200200, {0x34, 0x12}}};

inline faulty::Values default_values() {
  return {{0x100000, {0x91, 0x01, 0x0F, 0x00}}, {0x101700, {0, 0}}, {0x102001, {0, 0, 0, 0}}, {0x102002, {0, 0, 0, 0}},
          {0x180001, {0x85, 0x01, 0x00, 0x80}}, {0x200100, {0}},    {0x200200, {0, 0}},       {0x200C00, {'-'}}};
}

constexpr NmtSlave listed(std::uint8_t node_id, std::uint16_t heartbeat_time, bool mandatory = true) {
  NmtSlave slave{NodeId{node_id}, assignment::listed | assignment::boot | (mandatory ? assignment::mandatory : 0u)};
  slave.device_type = device_type;
  slave.heartbeat_time = heartbeat_time;
  slave.concise_dcf = dcf;
  return slave;
}

/// A fault of node 5, and what the master does: the letters of the boot results, and whether the slave is Operational
/// at the end.
struct Row {
  const char* name;
  Fault fault;
  faulty::Entry entry;
  unsigned times;
  const char* letters;
  bool started;
};

inline constexpr unsigned always = 1'000'000;

inline constexpr Row rows[] = {
    {"good slave", Fault::none, 0, 0, "0", true},
    {"starts twice", Fault::starts_twice, 0, always, "r0", true},
    {"answers twice, once", Fault::answers_twice, 0, 1, "x0", true},
    {"answers twice", Fault::answers_twice, 0, always, "xxx", false},
    {"late abort of the first value", Fault::late_abort, 0x200100, always, "xxx", false},
    {"late abort of the last value", Fault::late_abort, 0x200200, always, "xxx", false},
    {"late abort, once", Fault::late_abort, 0x200C00, 1, "x0", true},
    {"loses power once", Fault::loses_power, 0x200C00, 1, "r0", true},
    {"loses power in each configuration", Fault::loses_power, 0x200C00, always, "rrr", false},
    {"ignores a value", Fault::ignores_write, 0x200100, always, "www", false},
    {"ignores a text", Fault::ignores_write, 0x200C00, always, "www", false},
    {"ignores a value once", Fault::ignores_write, 0x200200, 1, "w0", true},
    {"rejects a value", Fault::rejects_write, 0x200200, always, "J", false},
    {"aborts with code 0", Fault::aborts_with_zero, 0x200200, always, "J", false},
};

/// A virtual bus with slaves.
struct SlaveBus {
  faulty::Slave& add(faulty::Settings settings) {
    VirtualBus::Endpoint& port = bus.attach();
    if (settings.values.empty()) settings.values = default_values();
    faulty::Slave& slave =
        devices.emplace_back(std::move(settings), [&port](const Frame& frame) { static_cast<void>(port.send(frame)); });
    slave.expected = configured;
    port.queue_limit = 1000;
    port.on_frame = [this, &slave](const Frame& frame, TimePoint) { slave.on_frame(frame, bus.elapsed()); };
    port.on_time = [this, &slave](TimePoint) { slave.on_time(bus.elapsed()); };
    port.next_deadline = [&slave]() -> std::optional<TimePoint> {
      const auto next = slave.next_deadline();
      return next ? std::optional{TimePoint{Duration{static_cast<std::uint32_t>(*next)}}} : std::nullopt;
    };
    ports.push_back(&port);
    slave.power_on(bus.elapsed());
    return slave;
  }

  VirtualBus bus;
  std::list<faulty::Slave> devices;
  std::vector<VirtualBus::Endpoint*> ports;
};

}  // namespace supervised
