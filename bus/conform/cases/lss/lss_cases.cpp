/// LSS (CiA 305): node-ID and bit timing over the bus.
#include <fmt/format.h>

#include "conform/case.hpp"
#include "conform/cases/lss/lss_slave.hpp"

namespace edsc::conform {
namespace {

using canopen::NmtCommand;
using canopen::NmtState;

constexpr Duration to_store = milliseconds{2000};

void select(Dut& dut) {
  const Slave slave{dut};
  for (std::uint8_t i = 0; i < 4; ++i) {
    auto other = slave.numbers();
    other[i] ^= 1;
    dut.expect(!slave.try_select(other),
               fmt::format("no answer to a number other than the number of {}",
                           label(identity, static_cast<std::uint8_t>(i + 1))),
               "one");
    dut.expect(!slave.ask(Command::inquire_node_id), "no answer to inquire node-ID in the waiting state", "one");
  }
  with_slave(dut, [&dut](const Slave& selected) {
    selected.expect_says(Command::inquire_node_id, dut.node().value(), "the node-ID");
  });
}

void switch_global(Dut& dut) {
  need_silent_bus(dut);
  const Slave slave{dut};
  const Dut::Mark since = dut.mark();
  slave.send(Command::switch_state_global, static_cast<std::uint32_t>(LssState::configuration));
  slave.expect_says(Command::inquire_node_id, dut.node().value(), "the node-ID");
  slave.wait();
  dut.expect(!slave.answer(Command::switch_state_global, since, milliseconds{1}), "no answer to switch state global",
             "one");
  dut.expect(!slave.ask(Command::inquire_node_id), "no answer to inquire node-ID in the waiting state", "one");
}

void inquire_identity(Dut& dut) {
  with_slave(dut, [](const Slave& slave) {
    constexpr std::string_view names[] = {"the vendor-ID", "the product code", "the revision number",
                                          "the serial number"};
    for (std::uint8_t i = 0; i < 4; ++i) {
      const auto command = static_cast<Command>(static_cast<std::uint8_t>(Command::inquire_vendor_id) + i);
      slave.expect_says(command, slave.numbers()[i], std::string{names[i]});
    }
  });
}

void inquire_node_id(Dut& dut) {
  with_slave(dut, [&dut](const Slave& slave) {
    slave.expect_says(Command::inquire_node_id, dut.node().value(), "the node-ID");
  });
}

void waiting(Dut& dut) {
  const Slave slave{dut};
  for (const Command command : {Command::inquire_vendor_id, Command::inquire_node_id, Command::configure_node_id,
                                Command::configure_bit_timing}) {
    // Invalid values, so that a slave that is not waiting does not change its configuration.
    const std::uint32_t word = command == Command::configure_bit_timing ? 0xFF7F : 0;
    dut.expect(!slave.ask(command, word),
               fmt::format("no answer to {:02X}h in the waiting state", static_cast<unsigned>(command)), "one");
  }
}

void identify(Dut& dut) {
  const Slave slave{dut};
  const auto [vendor, product, revision, serial] = slave.numbers();
  constexpr std::uint32_t major = 0x1'0000;
  const auto expect_identified = [&](bool expected, bool got, const std::string& what) {
    dut.expect(got == expected, (expected ? "an answer (4Fh) to " : "no answer to ") + what, got ? "one" : "none");
  };
  constexpr std::pair<std::uint32_t, std::uint32_t> each{0, 0xFFFF'FFFF};
  const std::pair own_revision{revision, revision}, own_serial{serial, serial};
  expect_identified(true, slave.identifies(product, each, each), "all revision and serial numbers");
  expect_identified(true, slave.identifies(product, own_revision, own_serial), "its revision and serial number");
  expect_identified(false, slave.identifies(product ^ 1, each, each), "another product code");
  if (serial != 0xFFFF'FFFF) {
    expect_identified(false, slave.identifies(product, each, {serial + 1, 0xFFFF'FFFF}), "higher serial numbers");
  }
  if (serial != 0) expect_identified(false, slave.identifies(product, each, {0, serial - 1}), "lower serial numbers");
  if (revision < 0xFFFF'0000) {
    expect_identified(false, slave.identifies(product, {revision + major, 0xFFFF'FFFF}, each),
                      "higher revision numbers");
  }
  if (revision >= major) {
    expect_identified(false, slave.identifies(product, {0, revision - major}, each), "lower revision numbers");
  }
}

void identify_non_configured(Dut& dut) {
  const Slave slave{dut};
  const Dut::Mark since = dut.mark();
  slave.send(Command::identify_non_configured);
  const auto answer = slave.answer(Command::identified_non_configured, since);
  dut.expect(!answer, "no answer to identify non-configured remote slave from a device with a node-ID", "one");
}

/// One step of Fastscan: compares bits 31 to `bit_check` of one number.
struct Scan {
  std::uint32_t number = 0;
  std::uint8_t bit_check = 0, sub = 0, next = 0;
};

/// Returns whether a slave answers a step of Fastscan.
bool scan(Dut& dut, const Slave& slave, const Scan& step) {
  Frame frame = lss::make_frame(lss::request_id, Command::fastscan, step.number);
  frame.data[5] = step.bit_check;
  frame.data[6] = step.sub;
  frame.data[7] = step.next;
  const Dut::Mark since = dut.mark();
  dut.send(frame);
  return slave.answer(Command::identified, since).has_value();
}

void fastscan_configured(Dut& dut) {
  const Slave slave{dut};
  dut.expect(!scan(dut, slave, {0, lss::fastscan_reset, 0, 0}), "no answer to Fastscan from a device with a node-ID",
             "one");
}

/// Resets all nodes on a bus on which the device is alone: a slave without node-ID may ignore its own.
void reset_all(Dut& dut) {
  constexpr std::uint8_t all_nodes = 0;
  dut.send(0, Bytes{static_cast<std::uint8_t>(NmtCommand::reset_communication), all_nodes});
  (void)dut.wait_for(dut.boot_up(), milliseconds{5000});
}

/// Configures the node-ID of a slave without one and expects its boot-up message. If it is missing, the device is reset
/// so that the following cases find it.
void give_node_id(Dut& dut, const Slave& slave) {
  slave.configure(dut.node());
  const Dut::Mark since = dut.mark();
  slave.wait();
  const bool is_booted = dut.wait_for(dut.boot_up(), milliseconds{5000}, since).has_value();
  if (!is_booted) reset_all(dut);
  dut.expect(is_booted, "a boot-up message with the new node-ID", "none");
  dut.pass_time(milliseconds{50});
}

/// Runs a case while the device does not have a node-ID. Only if no other node is on the bus.
template <class Check>
void without_node_id(Dut& dut, Check check) {
  need_silent_bus(dut);
  const Slave slave{dut};
  const Dut::Mark before = dut.mark();
  slave.send(Command::identify_non_configured);
  if (slave.answer(Command::identified_non_configured, before))
    dut.inconclusive(Condition::alone, "another LSS slave without a node-ID is on the bus");
  slave.select();
  const auto taken = slave.ask(Command::configure_node_id, canopen::unconfigured_node_id.value());
  dut.expect(taken.has_value(), "an answer to configure node-ID 255", "none");
  slave.wait();
  if (taken->data[1] != 0) dut.not_applicable("the node-ID of the device cannot be removed: it refuses 255");
  dut.enter(NmtState::pre_operational);
  const auto unconfigured = [&] {
    const Dut::Mark since = dut.mark();
    dut.nmt(NmtCommand::reset_communication);
    dut.pass_time(milliseconds{500});
    dut.expect(dut.received_since(since, dut.boot_up()).empty(), "no boot-up message without a node-ID", "one");
    check(slave);
  };
  const auto configure = [&] {
    slave.send(Command::switch_state_global, static_cast<std::uint32_t>(LssState::configuration));
    give_node_id(dut, slave);
  };
  and_undo(unconfigured, configure);
}

void unconfigured(Dut& dut) {
  without_node_id(dut, [&dut](const Slave& slave) {
    const Dut::Mark since = dut.mark();
    slave.send(Command::identify_non_configured);
    const auto answer = slave.answer(Command::identified_non_configured, since);
    dut.expect(answer.has_value(), "an answer (50h) to identify non-configured remote slave", "none");
    slave.select();
    slave.expect_says(Command::inquire_node_id, canopen::unconfigured_node_id.value(), "the node-ID");
  });
}

void fastscan(Dut& dut) {
  without_node_id(dut, [&dut](const Slave& slave) {
    const auto expect_answer = [&](const Scan& step, bool expected) {
      const bool got = scan(dut, slave, step);
      dut.expect(got == expected,
                 fmt::format("{} to Fastscan for {:08X}h from bit {} on (LSSSub {})",
                             expected ? "an answer" : "no answer", step.number, step.bit_check, step.sub),
                 got ? "one" : "none");
    };
    expect_answer({0, lss::fastscan_reset, 0, 0}, true);
    for (std::uint8_t sub = 0; sub < 4; ++sub) {
      const std::uint32_t number = slave.numbers()[sub];
      for (const std::uint8_t bit : std::initializer_list<std::uint8_t>{31, 16, 8}) {
        const std::uint32_t above = number & ~((std::uint32_t{1} << bit) - 1);
        expect_answer({above, bit, sub, sub}, true);
        expect_answer({above ^ std::uint32_t{1} << bit, bit, sub, sub}, false);
      }
      const auto next = static_cast<std::uint8_t>((sub + 1) % 4);
      expect_answer({number ^ 1, 0, sub, next}, false);
      expect_answer({number, 0, sub, next}, true);
    }
    slave.expect_says(Command::inquire_node_id, canopen::unconfigured_node_id.value(),
                      "the node-ID in the configuration state after Fastscan");
  });
}

void wrong_node_id(Dut& dut) {
  with_slave(dut, [&dut](const Slave& slave) {
    for (const std::uint8_t node : {std::uint8_t{0}, std::uint8_t{128}, std::uint8_t{254}}) {
      slave.expect_error(Command::configure_node_id, node, 1, fmt::format("configure node-ID {}", node));
    }
    slave.expect_says(Command::inquire_node_id, dut.node().value(), "the node-ID");
    slave.configure(dut.node());
  });
}

/// A new node-ID takes effect with the next reset communication. The old one is restored in the same way.
void new_node_id(Dut& dut) {
  const NodeId own = dut.node(), other = free_node_id(dut);
  const Slave slave{dut};
  const auto starts = [&dut](NodeId node, Dut::Mark since) {
    const auto boot_up = dut.wait_for(Dut::with_id(0x700U + node.value()), milliseconds{5000}, since);
    dut.pass_time(milliseconds{50});
    return boot_up && boot_up->frame.size == 1 && boot_up->frame.data[0] == 0;
  };
  const auto configure = [&slave](NodeId node) {
    slave.select();
    slave.configure(node);
    slave.wait();
  };
  bool moved = false;
  const auto move_back = [&] {
    configure(own);
    const Dut::Mark since = dut.mark();
    dut.send(0, Bytes{static_cast<std::uint8_t>(NmtCommand::reset_communication), other.value()});
    if (!moved) return;
    dut.expect(starts(own, since), fmt::format("a boot-up message of node {}, the former node-ID", own.value()),
               "none");
  };
  const auto move = [&] {
    configure(other);
    slave.select();
    slave.expect_says(Command::inquire_node_id, own.value(), "the node-ID before reset communication");
    slave.wait();
    dut.enter(NmtState::pre_operational);
    const Dut::Mark since = dut.mark();
    dut.nmt(NmtCommand::reset_communication);
    moved = starts(other, since);
    dut.expect(moved, fmt::format("a boot-up message of node {}, as configured by LSS", other.value()), "none");
    slave.select();
    slave.expect_says(Command::inquire_node_id, other.value(), "the node-ID after reset communication");
    slave.wait();
  };
  and_undo(move, move_back);
}

/// Not applicable if the device does not have the service, which is optional.
void need_bit_timing(Dut& dut, const Slave& slave) {
  constexpr std::uint32_t reserved = 10U << 8;
  if (!slave.ask(Command::configure_bit_timing, reserved)) {
    dut.not_applicable("the device does not answer configure bit timing parameters");
  }
}

/// Reserved indices of table 0, and reserved tables.
void wrong_bit_timing(Dut& dut) {
  with_slave(dut, [&dut](const Slave& slave) {
    need_bit_timing(dut, slave);
    for (const auto& [table, index] :
         {std::pair{0, 5}, std::pair{0, 10}, std::pair{0, 255}, std::pair{1, 0}, std::pair{127, 0}}) {
      slave.expect_error(Command::configure_bit_timing, static_cast<std::uint32_t>(table | index << 8), 1,
                         fmt::format("configure bit timing of table {}, index {}", table, index));
    }
  });
}

/// Stores the present node-ID.
void store(Dut& dut) {
  with_slave(dut, [&dut](const Slave& slave) {
    slave.configure(dut.node());
    const auto stored = slave.ask(Command::store_configuration, 0, to_store);
    dut.expect(stored.has_value(), "an answer to store configuration", "none");
    if (stored->data[1] == 1) dut.not_applicable("the device does not store its node-ID and bit rate: error code 1");
    dut.expect_equal(stored->data[1], 0, "the error code for store configuration");
    slave.wait();
    dut.enter(NmtState::pre_operational);
    const Dut::Mark since = dut.mark();
    if (dut.stimuli().power_cycle()) {
      dut.expect(dut.wait_for(dut.boot_up(), milliseconds{5000}, since).has_value(), "a boot-up message after power-on",
                 "none");
      dut.pass_time(milliseconds{50});
    } else {
      dut.reset(NmtCommand::reset_node);
    }
    slave.select();
    slave.expect_says(Command::inquire_node_id, dut.node().value(), "the stored node-ID");
  });
}

/// Whether the bit rate to be activated is known: in simulated time each is, because no frame depends on it. On a bus
/// the present one cannot be read, and another one would separate the device from it.
bool configures_bit_rate(Dut& dut, const Slave& slave) {
  need_bit_timing(dut, slave);
  constexpr std::uint32_t any = 0;
  if (!dut.simulated()) return false;
  const auto configured = slave.ask(Command::configure_bit_timing, any);
  return configured && configured->data[1] == 0;
}

/// The bit rate does not change. The device is silent during the second delay, then answers again.
void activate(Dut& dut) {
  if (dut.sheet().information.capabilities.baud_rates.size() < 2) {
    dut.not_applicable("the EDS does not have two bit rates");
  }
  constexpr Duration delay = milliseconds{200};
  const auto from_device = [](const Frame& frame) { return frame.id != 0; };
  with_slave(dut, [&](const Slave& slave) {
    const bool is_configured = configures_bit_rate(dut, slave);
    const Dut::Mark since = dut.mark();
    slave.send(Command::activate_bit_timing, delay.count() / 1000);
    dut.pass_time(delay / 2);
    dut.expect(!slave.answer(Command::activate_bit_timing, since, Duration{0}), "no answer to activate bit timing",
               "one");
    dut.pass_time(delay - delay / 4);
    const Dut::Mark silent = dut.mark();
    slave.send(Command::inquire_node_id);
    dut.pass_time(delay / 2);
    const bool is_silent = dut.received_since(silent, from_device).empty();
    if (!is_silent && !is_configured) {
      dut.inconclusive(
          Condition::usable_value,
          "the present bit rate is not known, so that none could be configured before activate bit timing");
    }
    dut.expect(is_silent, "no frame during the second delay", "one");
    dut.pass_time(delay);
    slave.wait();
    dut.enter(NmtState::pre_operational);
    const SdoOutcome outcome = dut.upload(device_type);
    dut.expect(outcome.end != SdoEnd::no_answer, "an answer to an SDO request afterwards", outcome_text(outcome));
  });
}

constexpr CaseRow lss_rows[] = {
    {"11.1", "Switch state selective selects a device by all four numbers of 1018h", "CiA 305, switch state selective",
     Level::communication, Permission::none, select},
    {"11.2", "Switch state global leads to the configuration state and back, without an answer",
     "CiA 305, switch state global", Level::communication, Permission::none, switch_global, Condition::none, "11.1"},
    {"11.3", "Inquire identity answers with the numbers of 1018h", "CiA 305, inquire identity", Level::communication,
     Permission::none, inquire_identity, Condition::none, "11.1"},
    {"11.4", "Inquire node-ID answers with the node-ID", "CiA 305, inquire node-ID", Level::communication,
     Permission::none, inquire_node_id, Condition::none, "11.1"},
    {"11.5", "In the waiting state configuration and inquiry are not answered", "CiA 305, LSS states",
     Level::communication, Permission::none, waiting, Condition::none, "11.1"},
    {"11.6", "Identify remote slave is answered by devices within the ranges", "CiA 305, identify remote slave",
     Level::communication, Permission::none, identify, Condition::none, "11.1"},
    {"11.7", "A device with node-ID does not answer identify non-configured remote slave",
     "CiA 305, identify non-configured remote slave", Level::communication, Permission::none, identify_non_configured,
     Condition::alone, "11.1"},
    {"11.8", "A device with node-ID does not answer Fastscan", "CiA 305, Fastscan", Level::communication,
     Permission::none, fastscan_configured, Condition::alone, "11.1"},
    {"11.9", "A device without node-ID answers identify non-configured remote slave, and boots with a new node-ID",
     "CiA 305, identify non-configured remote slave", Level::communication, Permission::none, unconfigured,
     Condition::alone, "11.1"},
    {"11.10", "Fastscan finds a device without node-ID by the numbers of 1018h", "CiA 305, Fastscan",
     Level::communication, Permission::none, fastscan, Condition::alone, "11.1"},
    {"11.11", "Configure node-ID refuses 0 and 128 with error code 1", "CiA 305, configure node-ID",
     Level::communication, Permission::none, wrong_node_id, Condition::none, "11.1"},
    {"11.12", "A new node-ID takes effect with reset communication", "CiA 305, configure node-ID", Level::communication,
     Permission::none, new_node_id, Condition::alone, "11.1"},
    {"11.13", "Configure bit timing refuses reserved tables and indices with error code 1",
     "CiA 305, configure bit timing parameters", Level::communication, Permission::none, wrong_bit_timing,
     Condition::none, "11.1"},
    {"11.14", "Store configuration keeps the node-ID", "CiA 305, store configuration", Level::communication,
     Permission::store, store, Condition::none, "11.1"},
    {"11.15", "After activate bit timing the device is silent for the second delay", "CiA 305, activate bit timing",
     Level::communication, Permission::store, activate, Condition::punctual, "11.1"},
};

}  // namespace

std::span<const CaseRow> lss_cases() { return lss_rows; }

}  // namespace edsc::conform
