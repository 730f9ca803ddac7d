/// The demo: five of the reference devices, one of each manual, and a small master on a simulated bus of 500 kbit/s.
/// The master boots the network, reads each identity, starts the nodes and exchanges PDOs with them. Every frame is
/// shown with the names of the EDS files.
#include <fmt/format.h>

#include <array>
#include <can_2017c/description.hpp>
#include <can_2017c/device.hpp>
#include <can_2024c/description.hpp>
#include <can_2024c/device.hpp>
#include <can_2053c/description.hpp>
#include <can_2053c/device.hpp>
#include <can_2057c/description.hpp>
#include <can_2057c/device.hpp>
#include <canopen/node.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <cpc_tc1/description.hpp>
#include <cpc_tc1/device.hpp>
#include <cpd/description.hpp>
#include <cpd/device.hpp>
#include <ezd_1136/description.hpp>
#include <ezd_1136/device.hpp>
#include <rk5c/description.hpp>
#include <rk5c/device.hpp>
#include <string_view>

#include "candump_log.hpp"
#include "layout_table.hpp"
#include "master.hpp"
#include "trace.hpp"

namespace {

using canopen::NodeId;
using namespace canopen::literals;
using namespace std::chrono_literals;

constexpr NodeId drive_id{3};
constexpr NodeId stepper_id{1};
constexpr NodeId spindle_id{2};
constexpr NodeId inputs_id{4};
constexpr NodeId sensor_id{5};

void heading(const char* text) { fmt::print("\n-- {}\n", text); }

/// The statusword of a drive after a command of CiA 402, from any state.
template <class Statusword, class Controlword>
Statusword statusword_after(Controlword word) {
  using command = typename Controlword::command_value;
  using state = typename Statusword::state_value;
  const state reached = word.is(command::shutdown)           ? state::ready_to_switch_on
                        : word.is(command::switch_on)        ? state::switched_on
                        : word.is(command::enable_operation) ? state::operation_enabled
                                                             : state::switch_on_disabled;
  return Statusword{}.state(reached).voltage_enabled(true).remote(true);
}

// What two of the drives do when they get a controlword.
struct Spindle {
  void write(cpd::od::controlword, cpd::od::controlword::type word, auto& node) {
    node.set(cpd::od::statusword{}, statusword_after<cpd::od::statusword::type>(word));
  }
};
struct Drive {
  void write(cpc_tc1::od::controlword, cpc_tc1::od::controlword::type word, auto& node) {
    node.set(cpc_tc1::od::statusword{}, statusword_after<cpc_tc1::od::statusword::type>(word));
  }
  void write(cpc_tc1::od::target_velocity, std::int32_t velocity, auto& node) {
    node.set(cpc_tc1::od::velocity_actual_value{}, velocity);
  }
};

// The devices of the demo store nothing.
using canopen::Composition;
using WithoutStorage = canopen::without<canopen::part::storage>;
using WithoutStorageAndLss = canopen::without<canopen::part::storage, canopen::part::lss>;
using StepperParts = Composition<ezd_1136::Device>;
using SpindleParts = Composition<cpd::Device, Spindle, WithoutStorage>;
using DriveParts = Composition<cpc_tc1::Device, Drive, WithoutStorageAndLss>;
using InputsParts = Composition<can_2053c::Device, WithoutStorage>;
using SensorParts = Composition<rk5c::Device, WithoutStorageAndLss>;

template <class VendorId, class ProductCode, class RevisionNumber, class DeviceName>
void show_identity(demo::Master& master, NodeId node) {
  const auto vendor = master.read<VendorId>(node);
  const auto product = master.read<ProductCode>(node);
  const auto revision = master.read<RevisionNumber>(node);
  const std::string name = master.read_text<DeviceName>(node);
  fmt::print("   => node {}: \"{}\", vendor {:08X}h, product {:08X}h, revision {:08X}h\n", node.value(), name,
             vendor.value_or(0), product.value_or(0), revision ? canopen::to_raw(*revision) : 0);
}

void show_identities(demo::Master& master) {
  {
    namespace id = ezd_1136::od::identity_object;
    show_identity<id::vendor_id, id::product_code, id::revision_number, ezd_1136::od::manufacturer_device_name>(
        master, stepper_id);
  }
  {
    namespace id = cpd::od::identity_object;
    show_identity<id::vendor_id, id::product_code, id::revision_number, cpd::od::manufacturer_device_name>(master,
                                                                                                           spindle_id);
  }
  {
    namespace id = cpc_tc1::od::identity_object;
    show_identity<id::vendor_id, id::product_code, id::revision_number, cpc_tc1::od::manufacturer_device_name>(
        master, drive_id);
  }
  {
    namespace id = can_2053c::od::identity_object;
    show_identity<id::vendor_id, id::product_code, id::revision_number, can_2053c::od::manufacturer_device_name>(
        master, inputs_id);
  }
  {
    namespace id = rk5c::od::identity_object;
    show_identity<id::vendor_id, id::product_code, id::revision_number, rk5c::od::manufacturer_device_name>(master,
                                                                                                            sensor_id);
  }
}

/// Configures the nodes before they start, with one write that a node refuses.
void configure(demo::Master& master) {
  master.write<ezd_1136::od::producer_heartbeat_time>(stepper_id, 50_ms);
  master.write<rk5c::od::tpdo_communication_parameter_1::event_timer>(sensor_id, 5_ms);
  if (!master.write<rk5c::od::position_values_for_multi_sensor_devices<1>>(sensor_id, 0_um)) {
    const auto code = static_cast<std::uint32_t>(master.last_abort());
    fmt::print("   => refused: {:08X}h {}\n", code, canopen::to_text(master.last_abort()));
  }
}

template <class Device>
void add_to_trace(demo::Trace& trace, NodeId node, const char* name, std::span<const canopen::EntryDescription> names) {
  trace.add(node, {name, names, demo::describe_pdos<Device>()});
}

void print_all_layouts() {
  const auto print = []<class Device>(Device, std::span<const canopen::EntryDescription> names) {
    demo::print_layouts(Device::name, demo::describe_pdos<Device>(), names);
  };
  print(cpc_tc1::Device{}, cpc_tc1::descriptions);
  print(ezd_1136::Device{}, ezd_1136::descriptions);
  print(cpd::Device{}, cpd::descriptions);
  print(can_2053c::Device{}, can_2053c::descriptions);
  print(can_2057c::Device{}, can_2057c::descriptions);
  print(can_2017c::Device{}, can_2017c::descriptions);
  print(can_2024c::Device{}, can_2024c::descriptions);
  print(rk5c::Device{}, rk5c::descriptions);
}

int run_demo(demo::CandumpLog& log) {
  canopen::VirtualBus bus{500'000};
  demo::Trace trace;
  add_to_trace<ezd_1136::Device>(trace, stepper_id, "stepper", ezd_1136::descriptions);
  add_to_trace<cpd::Device>(trace, spindle_id, "spindle", cpd::descriptions);
  add_to_trace<cpc_tc1::Device>(trace, drive_id, "drive", cpc_tc1::descriptions);
  add_to_trace<can_2053c::Device>(trace, inputs_id, "inputs", can_2053c::descriptions);
  add_to_trace<rk5c::Device>(trace, sensor_id, "sensor", rk5c::descriptions);
  bus.listen([&](const canopen::Frame& frame, canopen::TimePoint now) {
    trace.print(frame, now);
    log.write(frame, now);
  });
  demo::Master master{bus};

  auto& stepper_port = bus.attach();
  auto stepper = canopen::make_node<StepperParts>(stepper_port, stepper_id);
  auto& spindle_port = bus.attach();
  auto spindle = canopen::make_node<SpindleParts>(spindle_port, spindle_id);
  auto& drive_port = bus.attach();
  auto drive = canopen::make_node<DriveParts>(drive_port, drive_id);
  auto& inputs_port = bus.attach();
  auto inputs = canopen::make_node<InputsParts>(inputs_port, inputs_id);
  auto& sensor_port = bus.attach();
  auto sensor = canopen::make_node<SensorParts>(sensor_port, sensor_id);
  canopen::VirtualBus::connect(stepper_port, stepper);
  canopen::VirtualBus::connect(spindle_port, spindle);
  canopen::VirtualBus::connect(drive_port, drive);
  canopen::VirtualBus::connect(inputs_port, inputs);
  canopen::VirtualBus::connect(sensor_port, sensor);

  heading("power on: each node sends its boot-up message");
  stepper.start(bus.now());
  spindle.start(bus.now());
  drive.start(bus.now());
  inputs.start(bus.now());
  sensor.start(bus.now());
  bus.run_for(5ms);

  heading("the master reads each identity");
  show_identities(master);

  heading("the master configures; a read-only object answers with an abort");
  configure(master);

  heading("the master starts all nodes");
  master.command(canopen::NmtCommand::start);
  bus.run_for(2ms);

  heading("PDOs: the master enables the drives, an input changes, the sensor moves, the drive turns");
  using Position = rk5c::od::position_values_for_multi_sensor_devices<1>;
  Position::type position{};
  master.on_tpdo(sensor_id, 1,
                 [&position](const canopen::Frame& frame) { position = rk5c::Tpdo1::get<Position>(frame.data); });
  using Word = cpc_tc1::od::controlword::type;
  using command = Word::command_value;
  for (const command step : {command::shutdown, command::switch_on, command::enable_operation}) {
    const auto word = canopen::raw(Word{}.command(step).raw());  // of both drives
    master.send_rpdo<cpd::Rpdo1>(spindle_id, 1, cpd::Rpdo1::pack(word));
    master.send_rpdo<cpc_tc1::Rpdo1>(drive_id, 1, cpc_tc1::Rpdo1::pack(word));
    bus.run_for(2ms);
  }
  inputs.modify(can_2053c::od::read_input_8_bit<1>{}, [](auto& lines) { lines.di0(true).di2(true); });
  sensor.set<rk5c::od::speed_value<1>>(-0.25_m_per_s);
  for (int step = 1; step <= 8; ++step) {  // to 12.3456 m
    sensor.set<Position>(canopen::raw(15'432 * step));
    bus.run_for(5ms);
  }
  bus.run_for(5ms);
  fmt::print("   => the master has got the position {} m\n", position.in<canopen::unit::metre>());
  master.send_rpdo<ezd_1136::Rpdo2>(stepper_id, 2, ezd_1136::Rpdo2::pack(canopen::raw(position.raw()), 40_rev_per_s));
  bus.run_for(10ms);

  heading("the master stops all nodes: heartbeats go on, PDOs do not");
  master.command(canopen::NmtCommand::stop);
  bus.run_for(60ms);
  fmt::print("\n{} frames, {} nodes booted, bus time {:.1f} ms\n", trace.frames(), master.booted().size(),
             bus.now().since_start().count() / 1000.0);

  const bool as_wanted = master.booted().size() == 5 && position == 12.3456_m &&
                         stepper.get<ezd_1136::od::target_position>() == 123'456_inc &&
                         drive.get<cpc_tc1::od::statusword>().operation_enabled() &&
                         spindle.get<cpd::od::statusword>().operation_enabled();
  heading("PDO layouts of the eight devices");
  print_all_layouts();
  if (!as_wanted) fmt::print(stderr, "demo: the network did not end as it should\n");
  return as_wanted ? 0 : 1;
}

}  // namespace

/// demo [--log FILE]: also writes all frames to a candump log.
int main(int argc, char** argv) {
  demo::CandumpLog log;
  const bool logs = argc == 3 && std::string_view{argv[1]} == "--log";
  if (argc != 1 && !logs) {
    fmt::print(stderr, "usage: demo [--log FILE]\n");
    return 2;
  }
  if (logs && !log.open(argv[2])) {
    fmt::print(stderr, "demo: {} cannot be written\n", argv[2]);
    return 2;
  }
  const int result = run_demo(log);
  if (log.close()) return result;
  fmt::print(stderr, "demo: {} could not be written to the end\n", argv[2]);
  return 2;
}
