/// Area 12: frames that are not for the device, malformed or random ones, and many of them.
#include <fmt/format.h>

#include <canopen/can/cob_id.hpp>
#include <canopen/sdo/sdo_protocol.hpp>

#include "conform/case.hpp"
#include "conform/cases/hostile/unharmed.hpp"

namespace edsc::conform {
namespace {

using canopen::CobId;
using canopen::Frame;
using canopen::NmtCommand;
using canopen::NmtState;

constexpr NmtState every_state[] = {NmtState::pre_operational, NmtState::operational, NmtState::stopped};
constexpr NmtCommand every_nmt_command[] = {NmtCommand::start, NmtCommand::stop, NmtCommand::enter_pre_operational,
                                            NmtCommand::reset_node, NmtCommand::reset_communication};
constexpr std::uint8_t max_node = 127, max_size = 8;

Frame frame_of(std::uint32_t id, std::span<const std::uint8_t> data) {
  Frame frame;
  frame.id = CobId{id}.can_id();
  frame.extended = CobId{id}.extended();
  frame.size = static_cast<std::uint8_t>(data.size());
  std::ranges::copy(data, frame.data.begin());
  return frame;
}

/// Node-IDs that neither the device nor 1016h has: their frames do not cause a heartbeat event.
std::vector<std::uint8_t> foreign_nodes(Dut& dut) {
  std::set<std::uint8_t> watched{dut.node().value()};
  for (std::uint8_t sub_index = 1; sub_index <= max_node && dut.has(consumer_heartbeat, sub_index); ++sub_index) {
    watched.insert(static_cast<std::uint8_t>(dut.read_number(consumer_heartbeat, sub_index) >> 16 & 0x7F));
  }
  std::vector<std::uint8_t> nodes;
  for (std::uint8_t node = 1; node <= max_node; ++node) {
    if (!watched.contains(node)) nodes.push_back(node);
  }
  return nodes;
}

/// Each round lasts a few milliseconds at 1 Mbit/s.
void foreign_boot_ups(Dut& dut) {
  need_no_other_node(dut);
  const std::vector<std::uint8_t> nodes = foreign_nodes(dut);
  for (const NmtState state : every_state) {
    expect_unharmed(dut, state, "boot-up messages and heartbeats of other nodes", [&] {
      for (const std::uint8_t byte : {std::uint8_t{0}, std::uint8_t{5}, std::uint8_t{127}}) {
        for (const std::uint8_t node : nodes) dut.send(frame_of(0x700U + node, {{byte}}));
        dut.pass_time(milliseconds{1});
      }
    });
  }
}

void foreign_nmt(Dut& dut) {
  need_no_other_node(dut);
  for (const NmtState state : every_state) {
    expect_unharmed(dut, state, "NMT messages for other nodes", [&] {
      for (const NmtCommand command : every_nmt_command) {
        for (std::uint8_t node = 1; node <= max_node; ++node) {
          if (node == dut.node().value()) continue;
          dut.send(frame_of(0, {{static_cast<std::uint8_t>(command), node}}));
        }
        dut.pass_time(milliseconds{1});
      }
    });
  }
}

/// SDO requests and responses, EMCYs and PDOs with the CAN-IDs of other nodes.
void foreign_services(Dut& dut) {
  need_no_other_node(dut);
  const OwnCanIds own = own_can_ids(dut);
  const std::vector<std::uint8_t> nodes = foreign_nodes(dut);
  constexpr std::uint8_t request[] = {0x2F, 0x00, 0x20, 0, 1, 0, 0, 0};
  for (const NmtState state : {NmtState::pre_operational, NmtState::operational}) {
    expect_unharmed(dut, state, "SDO, EMCY and PDOs of other nodes", [&] {
      for (const std::uint32_t code : {0x080U, 0x180U, 0x200U, 0x280U, 0x300U, 0x580U, 0x600U}) {
        for (const std::uint8_t node : nodes) {
          const std::uint32_t id = code + node;
          if (!own.received.contains(id) && !own.transmitted.contains(id)) dut.send(frame_of(id, request));
        }
        dut.pass_time(milliseconds{1});
      }
    });
  }
}

/// A random size and random bytes. A request that could begin a download has an index that no device has.
Frame random_frame(Dut& dut, std::uint32_t id) {
  std::array<std::uint8_t, max_size> data{};
  for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(dut.random()());
  data[2] &= 0x0F;
  if (data[1] == 0 && data[2] == 0) data[1] = 1;
  return frame_of(id, std::span{data}.first(dut.random()() % (max_size + 1)));
}

/// Only in Pre-operational, in which RPDOs and SYNC have no effect on outputs.
void random_frames(Dut& dut) {
  need_no_other_node(dut);
  dut.enter(NmtState::pre_operational);
  const OwnCanIds own = own_can_ids(dut);
  constexpr unsigned rounds = 100;
  expect_unharmed(dut, NmtState::pre_operational, "random frames with the CAN-IDs of the device", [&] {
    for (unsigned round = 0; round < rounds; ++round) {
      for (const std::uint32_t id : own.received) dut.send(random_frame(dut, id));
      for (const std::uint32_t id : own.transmitted) dut.send(random_frame(dut, id));
      dut.pass_time(milliseconds{2});
    }
    dut.end_transfer();
  });
}

void remote_frames(Dut& dut) {
  need_no_other_node(dut);
  dut.enter(NmtState::pre_operational);
  const OwnCanIds own = own_can_ids(dut);
  for (const NmtState state : every_state) {
    expect_unharmed(dut, state, "remote frames with the CAN-IDs of the device", [&] {
      for (std::uint8_t size = 0; size <= max_size; ++size) {
        for (const auto& ids : {own.received, own.transmitted}) {
          for (const std::uint32_t id : ids) {
            Frame frame = frame_of(id, {});
            frame.remote = true;
            frame.size = size;
            dut.send(frame);
          }
        }
        Frame nmt = frame_of(0, {});
        nmt.remote = true;
        nmt.size = size;
        dut.send(nmt);
        dut.pass_time(milliseconds{2});
      }
    });
  }
}

/// 29-bit CAN-IDs with the same number are other CAN-IDs: neither SDO, NMT nor RPDO.
void extended_twins(Dut& dut) {
  need_no_other_node(dut);
  dut.enter(NmtState::pre_operational);
  const OwnCanIds own = own_can_ids(dut);
  const std::uint8_t node = dut.node().value();
  const auto twin = [](std::uint32_t id) { return CobId{id}.can_id() | CobId::extended_bit; };
  constexpr std::uint8_t write_heartbeat[] = {0x2B, 0x17, 0x10, 0, 0x39, 0x05, 0, 0};
  constexpr std::uint8_t read_device_type[] = {0x40, 0x00, 0x10, 0, 0, 0, 0, 0};
  for (const NmtState state : every_state) {
    const Dut::Match answer = Dut::with_id(0x580U + node);
    expect_unharmed(dut, state, "extended frames with the numbers of the CAN-IDs of the device", [&] {
      for (const std::uint32_t id : own.rpdos) {
        if (!own.received.contains(twin(id))) dut.send(frame_of(twin(id), write_heartbeat));
      }
      for (const NmtCommand command : every_nmt_command) {
        dut.send(frame_of(twin(0), {{static_cast<std::uint8_t>(command), node}}));
      }
      const Dut::Mark since = dut.mark();
      dut.send(frame_of(twin(0x600U + node), write_heartbeat));
      dut.send(frame_of(twin(0x600U + node), read_device_type));
      dut.pass_time(milliseconds{50});
      dut.expect(dut.received_since(since, answer).empty(),
                 fmt::format("no answer to the extended CAN-ID {:X}h", 0x600U + node), "one");
    });
  }
}

/// Frames without data, also with CAN-ID 0 (NMT).
void empty_frames(Dut& dut) {
  need_no_other_node(dut);
  dut.enter(NmtState::pre_operational);
  const OwnCanIds own = own_can_ids(dut);
  constexpr unsigned rounds = 20;
  for (const NmtState state : {NmtState::pre_operational, NmtState::stopped}) {
    expect_unharmed(dut, state, "frames without data", [&] {
      for (unsigned round = 0; round < rounds; ++round) {
        dut.send(frame_of(0, {}));
        for (const std::uint32_t id : own.received) dut.send(frame_of(id, {}));
        for (const std::uint32_t id : own.transmitted) dut.send(frame_of(id, {}));
        dut.pass_time(milliseconds{1});
      }
    });
  }
}

/// SYNC and TIME of each length.
void lengths_of_sync_and_time(Dut& dut) {
  need_no_other_node(dut);
  dut.enter(NmtState::pre_operational);
  const OwnCanIds own = own_can_ids(dut);
  constexpr std::array<std::uint8_t, max_size> data{1, 2, 3, 4, 5, 6, 7, 8};
  for (const NmtState state : {NmtState::pre_operational, NmtState::stopped}) {
    expect_unharmed(dut, state, "SYNC and TIME of each length", [&] {
      for (std::size_t size = 0; size <= max_size; ++size) {
        for (const std::uint32_t id : own.received) {
          const bool is_sdo = id == 0x600U + dut.node().value();
          if (!own.rpdos.contains(id) && !is_sdo) dut.send(frame_of(id, std::span{data}.first(size)));
        }
        dut.pass_time(milliseconds{2});
      }
    });
  }
}

constexpr CaseRow hostile_frame_rows[] = {
    {"12.1", "Boot-up messages and heartbeats of all other nodes have no effect", "CiA 301, 7.2.8.3.2.2",
     Level::hostile, Permission::none, foreign_boot_ups, on_own_bus},
    {"12.2", "NMT messages for all other nodes have no effect", "CiA 301, 7.2.8.3.1", Level::hostile, Permission::none,
     foreign_nmt, on_own_bus},
    {"12.3", "SDO, EMCY and PDOs of all other nodes have no effect", "CiA 301, 7.3.4", Level::hostile, Permission::none,
     foreign_services, on_own_bus},
    {"12.4", "Random frames with the CAN-IDs of the device have no effect in Pre-operational", "CiA 301, 7.3.2.2.5",
     Level::hostile, Permission::outputs, random_frames, on_own_bus},
    {"12.5", "Remote frames with the CAN-IDs of the device have no effect", "CiA 301, 7.2", Level::hostile,
     Permission::outputs, remote_frames, on_own_bus},
    {"12.6", "Extended frames with the numbers of the CAN-IDs of the device have no effect", "CiA 301, 7.3.4",
     Level::hostile, Permission::outputs, extended_twins, on_own_bus},
    {"12.7", "Frames without data have no effect", "CiA 301, 7.2", Level::hostile, Permission::outputs, empty_frames,
     on_own_bus},
    {"12.8", "SYNC and TIME of each length have no effect in Pre-operational and Stopped", "CiA 301, 7.2.5 and 7.2.6",
     Level::hostile, Permission::outputs, lengths_of_sync_and_time, on_own_bus},
};

}  // namespace

std::span<const CaseRow> hostile_frame_cases() { return hostile_frame_rows; }

}  // namespace edsc::conform
