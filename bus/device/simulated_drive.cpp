#include "device/simulated_drive.hpp"

#include <array>
#include <canopen/emcy/emcy_producer.hpp>
#include <canopen/emcy/error_register.hpp>
#include <canopen/nmt/nmt.hpp>
#include <canopen/od/accepted_values.hpp>
#include <canopen/od/object.hpp>
#include <canopen/profile/cia402.hpp>
#include <canopen/profile/cia402_simulated_axis.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "device/target_objects.hpp"
#include "values/little_endian.hpp"

namespace edsc {
namespace {

/// The device of the profile: it has each object; NodeOfDrive has the default value of one that is missing. Each SYNC
/// begins a period of interpolation, since 1006h is not compared with 60C2h. The device has no touch probes.
struct DriveDictionary {
  std::array<canopen::AcceptedRange, 0> accepted{};

  [[nodiscard]] static constexpr bool has(std::uint16_t index, std::uint8_t) {
    return index != 0x60B8 && index != 0x1006;
  }
};
struct AnyDrive {
  static constexpr DriveDictionary dictionary{};
};

constexpr canopen::cia402::Options drive_options = [] {
  canopen::cia402::Options options;
  options.modes = canopen::cia402::implemented_modes;
  return options;
}();

/// The node of the profile.
class NodeOfDrive {
 public:
  explicit NodeOfDrive(BehaviourTarget& target) : target_{target} {}

  template <class>
  static constexpr bool has_handler = true;

  template <class Object>
  [[nodiscard]] typename Object::type value_or(typename Object::type otherwise) const {
    if constexpr (Object::index == canopen::cia402::object::ModesOfOperation::index) otherwise = mode;
    return integer_of<typename Object::type>(target_, Object::index, Object::sub_index).value_or(otherwise);
  }

  template <class Object>
  [[nodiscard]] canopen::AbortCode set(typename Object::type value) const {
    set_integer(target_, Object::index, Object::sub_index, value);
    return canopen::ok;
  }
  [[nodiscard]] canopen::NmtState state() const { return target_.nmt_state(); }
  void emergency(canopen::EmergencyCode code, canopen::ErrorRegister bits, const canopen::EmergencyInfo&) const {
    target_.emergency(code.value(), bits);
  }
  void emergency_over(canopen::ErrorRegister bits) const { target_.emergency_over(bits); }
  void hold_error(canopen::ErrorRegister bits) const { target_.hold_error(bits); }

  /// Of a drive without 6060h.
  std::int8_t mode = canopen::cia402::mode::cyclic_synchronous_position;

 private:
  BehaviourTarget& target_;
};

constexpr std::uint32_t usual_increments = 4096;
constexpr std::uint32_t target_position = 0x607A00, data_record = 0x60C101, target_velocity = 0x60FF00;

class SimulatedDrive final : public ProfileBehaviour {
 public:
  explicit SimulatedDrive(BehaviourTarget& target) : target_{target}, node_{target} {}

  void restart() override {
    const std::uint32_t increments = integer_of<std::uint32_t>(target_, 0x608F, 1).value_or(usual_increments);
    const std::uint32_t turns = integer_of<std::uint32_t>(target_, 0x608F, 2).value_or(1);
    canopen::cia402::AxisData data = axis_data;
    if (increments != 0 && turns != 0) data.increments_per_turn = double(increments) / turns;
    axis_.set_data(data);
    drive_.start();
  }
  [[nodiscard]] canopen::AbortCode before_write(std::uint32_t key, std::span<const std::uint8_t> bytes) override {
    if (key != data_record || bytes.size() != sizeof(std::int32_t)) return canopen::ok;
    return drive_.offer_set_point(node_, static_cast<std::int32_t>(number_of(bytes)));
  }
  void after_write(std::uint32_t key) override {
    namespace mode = canopen::cia402::mode;
    if (key == target_position) node_.mode = mode::cyclic_synchronous_position;
    if (key == target_velocity) node_.mode = mode::profile_velocity;
  }
  void on_sync() override { drive_.on_sync(node_); }
  void on_error(std::uint16_t code) override { drive_.error_handler().call(node_, code); }
  void on_time(canopen::TimePoint now) override { drive_.on_time(node_, now); }
  [[nodiscard]] std::optional<canopen::TimePoint> next_deadline() const override { return drive_.next_deadline(); }

 private:
  static constexpr canopen::cia402::AxisData axis_data{.increments_per_turn = usual_increments,
                                                       .velocity_unit = 1,
                                                       .acceleration_unit = 1,
                                                       .highest_velocity = 10'000'000,
                                                       .highest_acceleration = 1'000'000'000};

  BehaviourTarget& target_;
  NodeOfDrive node_;
  canopen::cia402::SimulatedAxis axis_{axis_data};
  canopen::cia402::Drive<AnyDrive, canopen::cia402::SimulatedAxis, drive_options> drive_{axis_};
};

}  // namespace

std::unique_ptr<ProfileBehaviour> make_simulated_drive(BehaviourTarget& target) {
  return std::make_unique<SimulatedDrive>(target);
}

}  // namespace edsc
