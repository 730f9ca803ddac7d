/// What all modes of operation have in common, mode by mode, and drives with a part of the modes.
#include <gtest/gtest.h>

#include <random>
#include <servo/motor.hpp>

#include "every_mode_bench.hpp"

namespace {

using namespace std::chrono_literals;
namespace od = every_mode::od;
namespace mode = canopen::cia402::mode;

constexpr std::int8_t modes[] = {mode::profile_position,
                                 mode::velocity,
                                 mode::profile_velocity,
                                 mode::profile_torque,
                                 mode::homing,
                                 mode::interpolated_position,
                                 mode::cyclic_synchronous_position,
                                 mode::cyclic_synchronous_velocity,
                                 mode::cyclic_synchronous_torque};

/// A drive that moves in the positive direction in a mode.
struct Moving : bench::EveryMode<> {
  explicit Moving(std::int8_t wanted) : mode_{wanted} {
    write(0x6042, 0, 1'000, 2);
    write(0x60FF, 0, 1'000, 4);
    write(0x6071, 0, 50, 2);
    write(0x607A, 0, wanted == mode::cyclic_synchronous_position ? 1'000 : 100'000, 4);
    write(0x6081, 0, 1'000, 4);
    write(0x6098, 0, 18, 1);
    write(0x6099, 1, 1'000, 4);
    write(0x6099, 2, 100, 4);
    write(0x609A, 0, 10'000, 4);
    write(0x60C2, 1, 250, 1);
    enable(wanted);
    command(0);
    for (int i = 0; i < 4; ++i) write(0x60C1, 1, 1'000 * (i + 1), 4);
    pass(200ms);
    EXPECT_GT(axis().velocity(), 0) << int{wanted};
  }
  /// The controlword with the bits of the mode and others.
  void command(unsigned others) {
    control(0x0F | others);
    const bool has_bits = mode_ == mode::velocity;
    control((has_bits ? 0x7Fu : 0x1Fu) | others);
  }
  std::int8_t mode_;
};

struct EachMode : testing::TestWithParam<std::int8_t> {};
INSTANTIATE_TEST_SUITE_P(Modes, EachMode, testing::ValuesIn(modes),
                         [](const auto& tested) { return std::to_string(tested.param); });

TEST_P(EachMode, MovesInOperationEnabledOnly) {
  Moving drive{GetParam()};
  EXPECT_EQ(drive.status() & 0x6F, 0x27u);
  drive.control(0x00);  // disable voltage
  EXPECT_EQ(drive.status() & 0x4F, 0x40u);
  drive.pass(5s);
  EXPECT_EQ(drive.axis().velocity(), 0);
  EXPECT_EQ(drive.axis().torque(), 0);
}

TEST_P(EachMode, StopsInHaltAndGoesOn) {
  Moving drive{GetParam()};
  drive.command(0x100);
  drive.pass(1s);
  EXPECT_EQ(drive.axis().velocity(), 0);
  EXPECT_EQ(drive.axis().torque(), 0);
  EXPECT_TRUE(drive.bit(10)) << "halt: the velocity is 0";
  EXPECT_EQ(drive.status() & 0x6F, 0x27u);
  if (GetParam() == mode::interpolated_position) drive.write(0x60C1, 1, 90'000, 4);
  drive.command(0);
  drive.pass(100ms);
  EXPECT_GT(drive.axis().velocity(), 0);
}

TEST_P(EachMode, StopsWithAQuickStop) {
  Moving drive{GetParam()};
  drive.control(0x02);
  EXPECT_EQ(drive.status() & 0x6F, 0x07u) << "quick stop active";
  drive.pass(1s);
  EXPECT_EQ(drive.axis().velocity(), 0);
  EXPECT_EQ(drive.status() & 0x4F, 0x40u) << "switch on disabled";
  EXPECT_EQ(drive.axis().torque(), 0);
}

TEST_P(EachMode, StopsWithAFault) {
  Moving drive{GetParam()};
  drive.drive.fault(0x2310, canopen::ErrorRegister::current, drive.now);
  EXPECT_NE(drive.status() & 0x08, 0u);
  drive.pass(1s);
  EXPECT_EQ(drive.axis().velocity(), 0);
  EXPECT_EQ(drive.status() & 0x4F, 0x08u) << "fault";
  drive.command(0);
  drive.pass(1s);
  EXPECT_EQ(drive.axis().velocity(), 0) << "a fault is not left by enable operation";
}

TEST_P(EachMode, StopsAtALimitSwitch) {
  Moving drive{GetParam()};
  drive.axis().hold(canopen::cia402::input::positive_limit, true);
  drive.pass(2s);
  if (GetParam() == mode::homing) {
    EXPECT_LT(drive.axis().velocity(), 0) << "homing leaves the switch that it has found";
  } else {
    EXPECT_EQ(drive.axis().velocity(), 0);
    EXPECT_TRUE(drive.bit(11)) << "internal limit";
  }
}

TEST_P(EachMode, IsLeftForEachOtherModeAtStandstill) {
  for (const std::int8_t next : modes) {
    if (next == GetParam()) continue;
    Moving drive{GetParam()};
    EXPECT_EQ(drive.write(0x60FF, 0, 0, 4), 0u);
    EXPECT_EQ(drive.write(0x6042, 0, 0, 2), 0u);
    EXPECT_EQ(drive.write(0x6071, 0, 0, 2), 0u);
    EXPECT_EQ(drive.write(0x6060, 0, next, 1), 0u);
    drive.control(0x0F);
    for (int i = 0; i < 1'000 && drive.get<od::modes_of_operation_display>() != next; ++i) drive.pass(1ms);
    EXPECT_EQ(drive.get<od::modes_of_operation_display>(), next);
    EXPECT_EQ(drive.axis().velocity_demand(), 0) << int{next};
    EXPECT_EQ(drive.status() & 0x6F, 0x27u);
  }
}

// A part of the modes. An axis without the functions of other modes suffices: they are not called.

template <canopen::AcceptedRange... Rows>
struct Supporting : every_mode::Device {
  static constexpr canopen::AcceptedRange rows[] = {{0x6060, {0, 0}}, Rows...};
  static constexpr canopen::Dictionary dictionary = [] {
    canopen::Dictionary copy = every_mode::dictionary;
    copy.accepted = rows;
    return copy;
  }();
};

template <std::int8_t Low, std::int8_t High = Low>
inline constexpr canopen::AcceptedRange supported{0x6060, {Low, High}};

/// Of the functions of an axis for torque and touch probes, a drive with torque modes needs both.
struct PlainMotor : Motor {
  std::optional<std::int32_t> latched(const canopen::cia402::ProbeEdge&) { return std::nullopt; }
};

template <class Device, class Axis = PlainMotor>
using DriveWith = canopen::cia402::Drive<Device, Axis>;

static_assert(!canopen::cia402::TorqueAxis<PlainMotor>);
static_assert(DriveWith<Supporting<supported<1>>>::supports(mode::profile_position));
static_assert(!DriveWith<Supporting<supported<1>>>::supports(mode::profile_torque));
static_assert(!DriveWith<Supporting<supported<1>>>::has_interpolation);
static_assert(DriveWith<Supporting<supported<7>>>::has_interpolation);
static_assert(sizeof(DriveWith<Supporting<supported<1>>>) < sizeof(DriveWith<Supporting<supported<7>>>));
static_assert(sizeof(DriveWith<Supporting<supported<1>>, bench::Motor>) <
              sizeof(DriveWith<Supporting<supported<4>>, bench::Motor>));

template <class Device>
void expect_modes(std::uint32_t supported_modes) {
  bench::EveryMode<Device, PlainMotor> drive;
  for (int wanted = 1; wanted <= 11; ++wanted) {
    const bool is_supported = ((supported_modes >> (wanted - 1)) & 1) != 0;
    EXPECT_EQ(drive.write(0x6060, 0, wanted, 1), is_supported ? 0u : 0x0609'0030u) << wanted;
    if (is_supported) {
      EXPECT_EQ(canopen::to_raw(drive.drive.node().get(od::modes_of_operation_display{})), wanted);
    }
  }
}

TEST(SomeModes, AreTheOnesOf6502h) {
  expect_modes<Supporting<supported<1>>>(0x001);
  expect_modes<Supporting<supported<2, 3>>>(0x006);
  expect_modes<Supporting<supported<6, 9>>>(0x1E0);
  expect_modes<Supporting<supported<8>>>(0x080);
}

TEST(SecondAxis, HasItsOwnObjectsAndModes) {
  constexpr canopen::cia402::Options options = [] {
    canopen::cia402::Options result;
    result.axis = 1;
    return result;
  }();
  using Drive = canopen::cia402::Drive<every_mode::Device, bench::Motor, options>;
  static_assert(Drive::supports(mode::profile_velocity) && !Drive::supports(mode::profile_position));
  bench::RecordingBus bus;
  bench::Motor motor;
  Drive drive{motor};
  auto node = canopen::make_node<every_mode::Device>(bus, canopen::NodeId{5}, drive.error_handler());
  canopen::TimePoint now{};
  drive.start();
  node.start(now);
  const auto ask = [&](const char* request) {
    node.on_frame(bench::frame(request), now);
    drive.on_time(node, now);
    node.on_time(now);
  };
  ask("605 2F 60 68 00 03 00 00 00");
  ask("605 23 FF 68 00 E8 03 00 00");
  for (const char* word : {"605 2B 40 68 00 06 00 00 00", "605 2B 40 68 00 07 00 00 00", "605 2B 40 68 00 0F 00 00 00"})
    ask(word);
  for (int ms = 0; ms < 200; ++ms) {
    now = now + 1ms;
    drive.on_time(node, now);
  }
  EXPECT_EQ(motor.velocity(), 1'000);
  EXPECT_EQ(node.get<od::statusword_of_axis_2>().raw() & 0x6F, 0x27);
  EXPECT_EQ(canopen::to_raw(node.get<od::modes_of_operation_display_of_axis_2>()), 3);
  EXPECT_EQ(node.get<od::statusword>().raw(), 0) << "the first axis has none of it";
}

// Sequences of commands, modes and set-points

/// An axis that reports a command to move without power.
struct GuardedMotor : bench::Motor {
  void enable(bool on) {
    powered = on;
    bench::Motor::enable(on);
  }
  void move_to(std::int32_t position, const canopen::cia402::Profile& profile) {
    check();
    bench::Motor::move_to(position, profile);
  }
  void run_at(std::int32_t velocity, const canopen::cia402::Profile& profile) {
    check();
    bench::Motor::run_at(velocity, profile);
  }
  void follow(std::int32_t position) {
    check();
    bench::Motor::follow(position);
  }
  void apply_torque(std::int16_t torque) {
    check();
    bench::Motor::apply_torque(torque);
  }
  void check() { commanded_without_power = commanded_without_power || !powered; }
  bool powered = false;
  bool commanded_without_power = false;
};

/// Whether bits 0 to 3, 5 and 6 are those of a state (CiA 402-2, statusword).
bool is_state(unsigned status) {
  for (const auto& [mask, value] : {std::pair{0x4Fu, 0x00u},
                                    {0x4F, 0x40},
                                    {0x6F, 0x21},
                                    {0x6F, 0x23},
                                    {0x6F, 0x27},
                                    {0x6F, 0x07},
                                    {0x4F, 0x0F},
                                    {0x4F, 0x08}}) {
    if ((status & mask) == value) return true;
  }
  return false;
}

/// Bits 12 and 13 that a mode may set (CiA 402-2, 6041h of each mode).
unsigned bits_of_mode(std::int8_t present) {
  switch (present) {
    case mode::profile_position:
    case mode::homing:
    case mode::cyclic_synchronous_position: return 0x3000;
    case mode::profile_velocity:
    case mode::interpolated_position:
    case mode::cyclic_synchronous_velocity:
    case mode::cyclic_synchronous_torque: return 0x1000;
    default: return 0;
  }
}

TEST(AnySequence, MovesWithPowerOnlyAndHasAValidStatusword) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random{seed};
    const auto any = [&](int low, int high) { return std::uniform_int_distribution{low, high}(random); };
    bench::EveryMode<every_mode::Device, GuardedMotor> drive;
    for (int i = 0; i < 1'000; ++i) {
      switch (any(0, 11)) {
        case 0:
        case 1: drive.control(static_cast<unsigned>(any(0, 0x1FF))); break;
        case 2: drive.control(0x0F | static_cast<unsigned>(any(0, 7)) << 4); break;
        case 3:
          for (const unsigned word : {0x80u, 0x06u, 0x07u, 0x0Fu}) drive.control(word);
          break;
        case 4: drive.write(0x6060, 0, any(-2, 12), 1); break;
        case 5: drive.write(0x607A, 0, any(-100'000, 100'000), 4); break;
        case 6: drive.write(0x60FF, 0, any(-20'000, 20'000), 4); break;
        case 7: drive.write(0x6071, 0, any(-2'000, 2'000), 2); break;
        case 8: drive.write(0x6042, 0, any(-0x8000, 0x7FFF), 2); break;
        case 9: drive.write(0x60C1, 1, any(-100'000, 100'000), 4); break;
        case 10: drive.axis().hold(canopen::cia402::input::positive_limit, any(0, 1) == 1); break;
        default:
          if (any(0, 9) == 0) drive.drive.fault(0x1000, canopen::ErrorRegister::generic, drive.now);
          if (any(0, 3) == 0) drive.ask("080");
          break;
      }
      drive.pass(canopen::Duration{static_cast<std::uint32_t>(any(0, 20'000))});
      const unsigned status = drive.status();
      const std::int8_t present = drive.get<od::modes_of_operation_display>();
      ASSERT_FALSE(drive.axis().commanded_without_power) << seed << " " << i;
      ASSERT_TRUE(is_state(status)) << std::hex << status;
      ASSERT_TRUE(is_state(status) && drive.drive.drive().supports(present)) << int{present};
      if ((status & 0x6F) == 0x27) {
        ASSERT_EQ(status & 0x3000 & ~bits_of_mode(present), 0u) << std::hex << status << " mode " << int{present};
      } else {
        ASSERT_EQ(status & 0x3000, 0u) << std::hex << status;
        if ((status & 0x04) == 0) {
          ASSERT_EQ(drive.axis().torque(), 0);
        }
      }
    }
  }
}

}  // namespace
