/// A linear position sensor with LSS: position and speed of a magnet, with its status register, preset and errors.
#pragma once

#include <array>
#include <canopen/nmt/nmt.hpp>
#include <canopen/node.hpp>
#include <canopen/profile/cia406.hpp>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <rk5c/device.hpp>
#include <string_view>

#include "shared/description.hpp"
#include "shared/input_line.hpp"
#include "shared/lss_settings.hpp"
#include "shared/panel.hpp"
#include "shared/surroundings.hpp"

/// The surroundings must outlive it.
template <canopen::Bus B>
class Rk5c {
  using Device = rk5c::Device;

 public:
  static constexpr nodes::Description description{
      "rk5c", "A linear position sensor that LSS configures.", "the one that LSS has stored, or none",
      "  position 1 UM                    where the magnet is, 0 to 4000000 um: position 1 12345\n"
      "  speed 1 UM/S                     how fast it moves\n"
      "  magnet on|off|two                one magnet is there, none or two\n"
      "  temperature C                    of the microcontroller\n"
      "  test on|off                      internal test mode\n"
      "  flash whole|damaged              what the next check of the parameters' checksum finds\n"
      "  hardware good|bad                what the measuring routines find\n"};

  /// The measuring range in um, and the measuring cycle.
  static constexpr std::int32_t range = 4'000'000;
  static constexpr canopen::Duration measuring_cycle = std::chrono::milliseconds{1};
  static constexpr std::int32_t highest_temperature = 105;

  /// Bits of 1002h.
  enum Status : std::uint8_t {
    running = 0x01,
    starting = 0x02,
    magnet_error = 0x04,
    range_error = 0x08,
    flash_error = 0x10,
    controller_error = 0x20,
    hot = 0x40,
  };

  Rk5c(B& bus, nodes::Surroundings& around)
      : around_{around},
        panel_{around},
        lss_{around, canopen::unconfigured_node_id, bit_rate_125},
        node_{bus,
              lss_.node_id(),
              canopen::stored_in(around.parameters),
              canopen::configured_by_lss(lss_),
              canopen::cyclic_timer_sets_event_timer(),
              canopen::event_timer_sets_cyclic_timer(),
              canopen::on_write<rk5c::od::preset_values_for_multi_sensor_devices<1>>(PresetWriter{this}),
              canopen::on_write<rk5c::od::store_parameters<1>>(Saver{this}),
              canopen::on_write<rk5c::od::restore_default_parameters<1>>(Loader{this}),
              canopen::on_state(StateTeller{this})} {}

  /// Switches the node on.
  void start(canopen::TimePoint now) {
    resets_application_ = true;
    node_.start(now);
    next_measurement_ = now + measuring_cycle;
  }
  void on_frame(const canopen::Frame& frame, canopen::TimePoint now) {
    resets_application_ = canopen::nmt_command(frame, node_.node_id()) == canopen::NmtCommand::reset_node;
    node_.on_frame(frame, now);
    measure_when_due(now);
  }
  void on_time(canopen::TimePoint now) {
    measure_when_due(now);
    node_.on_time(now);
  }
  [[nodiscard]] std::optional<canopen::TimePoint> next_deadline() const {
    const std::optional<canopen::TimePoint> of_node = node_.next_deadline();
    if (!unmeasured_ || (of_node && *of_node < next_measurement_)) return of_node;
    return next_measurement_;
  }

  void on_bus_status(const canopen::BusStatus& status, canopen::TimePoint now) {
    panel_.on_bus_status(status);
    node_.on_bus_status(status, now);
  }

  bool input(const nodes::InputLine& line, canopen::TimePoint now) {
    const bool taken = take(line);
    if (taken && !unmeasured_) {
      unmeasured_ = true;
      next_measurement_ = now + measuring_cycle;
    }
    node_.on_time(now);
    return taken;
  }

  [[nodiscard]] const nodes::Panel& panel() const { return panel_; }
  [[nodiscard]] auto& node() { return node_; }

 private:
  static constexpr canopen::LssBitTiming bit_rate_125{0, 4};

  struct StateTeller {
    Rk5c* sensor;
    void operator()(auto& node, canopen::NmtState state) const {
      sensor->panel_.on_state(state, node.node_id());
      if (state == canopen::NmtState::initialisation) sensor->initialise();
    }
  };
  struct PresetWriter {
    Rk5c* sensor;
    canopen::AbortCode operator()(rk5c::od::preset_values_for_multi_sensor_devices<1>::type value) const {
      return sensor->preset(value.raw());
    }
  };
  struct Saver {
    Rk5c* sensor;
    canopen::AbortCode operator()(rk5c::od::store_parameters<1>::type) const {
      return sensor->store_offset(sensor->encoder_.offset());
    }
  };
  struct Loader {
    Rk5c* sensor;
    canopen::AbortCode operator()(rk5c::od::restore_default_parameters<1>::type) const {
      sensor->check_flash();
      sensor->restored_ = true;
      return sensor->store_offset(0);
    }
  };
  using Node =
      canopen::Node<Device, B, canopen::StoredIn<nodes::NodeStorage>, canopen::ConfiguredByLss<nodes::LssSettings>,
                    canopen::CyclicTimerHandler, canopen::EventTimerHandler,
                    canopen::WriteHandler<rk5c::od::preset_values_for_multi_sensor_devices<1>, PresetWriter>,
                    canopen::WriteHandler<rk5c::od::store_parameters<1>, Saver>,
                    canopen::WriteHandler<rk5c::od::restore_default_parameters<1>, Loader>,
                    canopen::StateHandler<StateTeller>>;

  /// At power-on and at each reset: loads the settings that become valid, and reports the errors that still exist.
  void initialise() {
    if (around_.serial_number != 0) {
      static_cast<void>(node_.set(rk5c::od::identity_object::serial_number{}, around_.serial_number));
    }
    // 6200h is hard-wired to 1800h:05, which each reset sets.
    static_cast<void>(
        node_.set(rk5c::od::cyclic_timer{}, node_.get(rk5c::od::tpdo_communication_parameter_1::event_timer{})));
    data_set_error_reported_ = around_.parameters.state() == canopen::StorageState::damaged;  // by the node itself
    if (data_set_error_reported_) data_set_error_ = true;
    if (data_set_error_) tell_data_set_error();
    check_flash();
    if (hardware_bad_) tell_hardware_error();
    if (resets_application_ && !restored_) encoder_.set_offset(stored_offset());
    starting_ = true;
    unmeasured_ = true;
    show_status();
  }

  // The checksum of the parameters. An error lasts until power-off.

  void check_flash() {
    if (!flash_damaged_ || data_set_error_) return;
    data_set_error_ = true;
    tell_data_set_error();
  }
  void tell_data_set_error() {
    if (!data_set_error_reported_) node_.emergency(canopen::emergency_code::data_set, canopen::ErrorRegister::generic);
    data_set_error_reported_ = true;
    panel_.set(canopen::IndicatorError::configuration, true);
    show_status();
  }
  void tell_hardware_error() { node_.emergency(device_hardware, canopen::ErrorRegister::manufacturer); }

  // Preset and its offset

  /// Aborts with 0800 0020h if there is no valid position.
  [[nodiscard]] canopen::AbortCode preset(std::int32_t value) {
    if ((status() & running) == 0) return canopen::AbortCode::not_stored;
    encoder_.preset(value);
    unmeasured_ = true;
    next_measurement_ = last_time_ + measuring_cycle;
    return canopen::ok;
  }

  [[nodiscard]] std::int32_t stored_offset() {
    std::int32_t offset = 0;
    std::array<std::uint8_t, sizeof offset> bytes{};
    nodes::NodeStorage& from = around_.application;
    const bool stored = from.open() == canopen::StorageState::whole && from.size() == bytes.size();
    if (stored && from.read(0, bytes)) std::memcpy(&offset, bytes.data(), sizeof offset);
    return offset;
  }
  [[nodiscard]] canopen::AbortCode store_offset(std::int32_t offset) {
    std::array<std::uint8_t, sizeof offset> bytes;
    std::memcpy(bytes.data(), &offset, sizeof offset);
    nodes::NodeStorage& to = around_.application;
    return to.begin(bytes.size()) && to.write(bytes) && to.commit() ? canopen::ok : canopen::AbortCode::hardware;
  }

  // Measuring

  void measure_when_due(canopen::TimePoint now) {
    last_time_ = now;
    if (!unmeasured_ || now < next_measurement_) return;
    unmeasured_ = false;
    starting_ = false;
    show_status();
    const bool valid = !hardware_bad_ && magnet_;
    if (!in_range()) {
      show(0, 0);
    } else if (valid) {
      encoder_.measured(node_, encoder_.position_steps(node_, std::int64_t{position_} * 1000),
                        encoder_.speed_steps(node_, speed_ / 10));
    }
  }
  /// Sets position and speed without a measurement.
  void show(std::int32_t position, std::int16_t speed) {
    static_cast<void>(node_.set(rk5c::od::position_values_for_multi_sensor_devices<1>{}, canopen::raw(position)));
    static_cast<void>(node_.set(rk5c::od::speed_value<1>{}, canopen::raw(speed)));
  }

  [[nodiscard]] bool in_range() const { return position_ >= 0 && position_ <= range; }

  [[nodiscard]] std::uint8_t status() const {
    unsigned bits = 0;
    if (starting_ || test_mode_) bits |= starting;
    if (!magnet_) bits |= magnet_error;
    if (!in_range()) bits |= range_error;
    if (data_set_error_) bits |= flash_error;
    if (hardware_bad_) bits |= controller_error;
    if ((bits & (starting | magnet_error | range_error | controller_error)) == 0) bits |= running;
    if (temperature_ > highest_temperature) bits |= hot;
    return static_cast<std::uint8_t>(bits);
  }
  void show_status() {
    const std::uint32_t before = canopen::to_raw(node_.get(rk5c::od::manufacturer_status_register{}));
    const std::uint32_t after = status();
    if (after == before) return;
    static_cast<void>(node_.set(rk5c::od::manufacturer_status_register{}, canopen::raw(after)));
    char line[32];
    std::snprintf(line, sizeof line, "status 0x%02X", static_cast<unsigned>(after));
    around_.log(line);
  }

  [[nodiscard]] bool take(const nodes::InputLine& line) {
    if (line.is("position", 2))
      return line.number<std::uint8_t>(1, 1, 1) && assign(position_, line.number<std::int32_t>(2));
    if (line.is("speed", 2)) return line.number<std::uint8_t>(1, 1, 1) && assign(speed_, line.number<std::int32_t>(2));
    if (line.is("temperature", 1)) return assign(temperature_, line.number<std::int32_t>(1));
    if (line.is("magnet", 1)) return assign(magnet_, line.word(1) == "two" ? std::optional{false} : line.on_or_off(1));
    if (line.is("test", 1)) return assign(test_mode_, line.on_or_off(1));
    if (line.is("flash", 1)) return assign(flash_damaged_, one_of(line, "damaged", "whole"));
    if (!line.is("hardware", 1)) return false;
    const bool was_bad = hardware_bad_;
    if (!assign(hardware_bad_, one_of(line, "bad", "good"))) return false;
    if (hardware_bad_ && !was_bad) tell_hardware_error();
    if (!hardware_bad_ && was_bad) node_.emergency_over(canopen::ErrorRegister::manufacturer);
    return true;
  }
  template <class T>
  [[nodiscard]] static bool assign(T& to, const std::optional<T>& value) {
    if (value) to = *value;
    return value.has_value();
  }
  [[nodiscard]] static std::optional<bool> one_of(const nodes::InputLine& line, std::string_view yes,
                                                  std::string_view no) {
    if (line.word(1) == yes) return true;
    if (line.word(1) == no) return false;
    return std::nullopt;
  }

  static constexpr std::uint16_t device_hardware = 0x5000;

  nodes::Surroundings& around_;
  nodes::Panel panel_;
  nodes::LssSettings lss_;
  canopen::Encoder<Device> encoder_;
  canopen::TimePoint next_measurement_{};
  canopen::TimePoint last_time_{};
  std::int32_t position_ = 0;      ///< um
  std::int32_t speed_ = 0;         ///< um/s
  std::int32_t temperature_ = 25;  ///< degrees Celsius
  bool magnet_ = true;             ///< exactly one
  bool test_mode_ = false;
  bool flash_damaged_ = false;
  bool hardware_bad_ = false;
  bool data_set_error_ = false;
  bool data_set_error_reported_ = false;  ///< reported since the last reset
  bool resets_application_ = true;
  bool restored_ = false;  ///< since power-on: the present offset remains valid until power-off
  bool starting_ = true;
  bool unmeasured_ = true;  ///< the next measuring cycle has a new value
  Node node_;
};
