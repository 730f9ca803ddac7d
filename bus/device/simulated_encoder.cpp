#include "device/simulated_encoder.hpp"

#include <algorithm>
#include <array>
#include <canopen/base/clock.hpp>
#include <cstdint>
#include <memory>
#include <optional>

#include "device/target_objects.hpp"

namespace edsc {
namespace {

constexpr std::uint32_t usual_steps = 4096;
constexpr std::uint64_t period_us = 10'000'000;
constexpr canopen::Duration measuring_cycle{10'000};
constexpr unsigned channels = 8;

constexpr std::uint16_t preset = 0x6003, position = 0x6004, channel_preset = 0x6010, channel_position = 0x6020,
                        channel_speed = 0x6030, cyclic_timer = 0x6200, tpdo_1 = 0x1800;
constexpr std::uint8_t event_timer = 5;

class SimulatedEncoder final : public ProfileBehaviour {
 public:
  explicit SimulatedEncoder(BehaviourTarget& target) : target_{target} {}

  void restart() override {
    steps_ = std::max<std::uint32_t>(integer_of<std::uint32_t>(target_, 0x6001, 0).value_or(usual_steps), 2);
  }

  void after_write(std::uint32_t key) override {
    const auto index = static_cast<std::uint16_t>(key >> 8);
    const auto sub_index = static_cast<std::uint8_t>(key);
    if (index == preset) return take_preset(index, sub_index, 0);
    if (index == channel_preset && sub_index >= 1 && sub_index <= channels)
      return take_preset(index, sub_index, sub_index - 1u);
    if (index == cyclic_timer) copy(cyclic_timer, 0, tpdo_1, event_timer);
    if (index == tpdo_1 && sub_index == event_timer) copy(tpdo_1, event_timer, cyclic_timer, 0);
  }

  void on_time(canopen::TimePoint now) override {
    if (!measured_) measured_ = now;
    const canopen::Duration passed = now - *measured_;
    if (passed < measuring_cycle && is_published_) return;
    time_us_ = (time_us_ + passed.count()) % period_us;
    measured_ = now;
    is_published_ = true;
    publish();
  }
  [[nodiscard]] std::optional<canopen::TimePoint> next_deadline() const override {
    return measured_ ? std::optional{*measured_ + measuring_cycle} : std::nullopt;
  }

 private:
  [[nodiscard]] bool moves_back() const { return time_us_ >= period_us / 2; }
  /// In measuring steps, without the offset.
  [[nodiscard]] std::uint32_t measured() const {
    const std::uint64_t way = moves_back() ? period_us - time_us_ : time_us_;
    return static_cast<std::uint32_t>(way * (steps_ - 1) / (period_us / 2));
  }

  void publish() {
    const auto speed = static_cast<std::int32_t>(std::uint64_t{steps_} * 2'000'000 / period_us);
    set_integer(target_, position, 0, measured() + offsets_[0]);
    for (std::uint8_t channel = 1; channel <= channels; ++channel) {
      set_integer(target_, channel_position, channel, measured() + offsets_[channel - 1u]);
      set_integer(target_, channel_speed, channel, moves_back() ? -speed : speed);
    }
  }

  void take_preset(std::uint16_t index, std::uint8_t sub_index, unsigned channel) {
    const std::optional<std::uint32_t> value = integer_of<std::uint32_t>(target_, index, sub_index);
    if (value) offsets_[channel] = *value - measured();
    is_published_ = false;
  }

  void copy(std::uint16_t from, std::uint8_t from_sub_index, std::uint16_t to, std::uint8_t to_sub_index) {
    const std::optional<std::uint32_t> value = integer_of<std::uint32_t>(target_, from, from_sub_index);
    if (value) set_integer(target_, to, to_sub_index, *value);
  }

  BehaviourTarget& target_;
  std::uint32_t steps_ = usual_steps;
  std::uint64_t time_us_ = 0;  ///< in the present motion to and fro
  std::optional<canopen::TimePoint> measured_;
  bool is_published_ = false;
  std::array<std::uint32_t, channels> offsets_{};
};

}  // namespace

std::unique_ptr<ProfileBehaviour> make_simulated_encoder(BehaviourTarget& target) {
  return std::make_unique<SimulatedEncoder>(target);
}

}  // namespace edsc
