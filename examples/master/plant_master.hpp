/// The master of the plant: boots and configures its four modules, counts on the digital outputs, ramps an analogue
/// output and compares the inputs with them. While a module is lost it stops the outputs.
#pragma once

#include <algorithm>
#include <array>
#include <can_2017c/device.hpp>
#include <can_2024c/device.hpp>
#include <can_2053c/device.hpp>
#include <can_2057c/device.hpp>
#include <canopen/master.hpp>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// The cycle of the outputs, and the guard time.
inline constexpr canopen::Duration usual_cycle = std::chrono::milliseconds{100};

template <canopen::BlockingBus B>
class PlantMaster {
 public:
  using Log = std::function<void(std::string_view line)>;

  PlantMaster(B& bus, Log log, canopen::Duration cycle = usual_cycle)
      : log_{std::move(log)}, cycle_{cycle}, master_{bus, slaves(cycle), {canopen::nmt_start_up::no_slave_start}} {
    master_.on_configure = [this](canopen::NodeId node_id) { return configure(node_id); };
    master_.on_booted = [this](canopen::NodeId node_id, const canopen::BootResult& result) { booted(node_id, result); };
    master_.on_event = [this](canopen::NmtMasterEvent event, canopen::NodeId node_id, canopen::NmtState) {
      if (event == canopen::NmtMasterEvent::lost) lost(node_id);
    };
    master_.on_emergency = [this](canopen::NodeId node_id, const canopen::EmergencyMessage& message) {
      log_(name(node_id) + " tells EMCY " + hex(message.code, 4));
    };
  }

  void start() { master_.start(); }

  /// Runs one cycle. Call it repeatedly.
  void run_cycle() {
    master_.poll(cycle_);
    if (!running_) return;
    compare();
    write_outputs();
  }

  [[nodiscard]] bool running() const { return running_; }
  /// The number of cycles in which the inputs were equal to the outputs, and in which they were not.
  [[nodiscard]] unsigned agreed() const { return agreed_; }
  [[nodiscard]] unsigned differed() const { return differed_; }

 private:
  static constexpr std::uint8_t life_time_factor = 3;
  static constexpr std::uint8_t all_lines = 0xFF;
  static constexpr std::size_t nodes = 4;

  /// The guard time in ms.
  [[nodiscard]] static std::uint16_t guard_time(canopen::Duration cycle) {
    return static_cast<std::uint16_t>(cycle.count() / 1000);
  }

  [[nodiscard]] static std::vector<canopen::NmtSlave> slaves(canopen::Duration cycle) {
    using namespace canopen::slave_assignment;
    const std::uint32_t assignment =
        listed | boot | mandatory | std::uint32_t{life_time_factor} << 8 | std::uint32_t{guard_time(cycle)} << 16;
    std::vector<canopen::NmtSlave> list;
    for (std::uint8_t i = 1; i <= nodes; ++i) list.push_back({canopen::NodeId{i}, assignment});
    list[0].device_type = default_of<can_2057c::Device>();
    list[1].device_type = default_of<can_2053c::Device>();
    list[2].device_type = default_of<can_2024c::Device>();
    list[3].device_type = default_of<can_2017c::Device>();
    return list;
  }
  /// 1000h is a constant of the EDS.
  template <class Device>
  [[nodiscard]] static std::uint32_t default_of() {
    return canopen::ObjectStore<Device>{}.template number<0x1000, 0>();
  }

  // Booting

  void booted(canopen::NodeId node_id, const canopen::BootResult& result) {
    log_(canopen::boot_text(node_id, result));
    if (result != canopen::BootStatus::booted) return;
    ready_[node_id.value() - 1u] = true;
    if (std::ranges::find(ready_, false) != ready_.end()) return;
    if (!listening_) listen();
    static_cast<void>(master_.command(canopen::NmtCommand::start, canopen::all_nodes));
    log_("all nodes are configured: started");
    running_ = true;
    written_.reset();
  }

  /// Output modules set their outputs to 0 if the master is lost. Input modules send their values by an event timer.
  [[nodiscard]] canopen::Result<void> configure(canopen::NodeId node_id) {
    using namespace canopen::literals;
    switch (node_id.value()) {
      case 1:
        return all({guarded<can_2057c::Device, can_2057c::od::guard_time, can_2057c::od::life_time_factor>(outputs_),
                    outputs_.template write<can_2057c::od::error_mode_output_8_bit<1>>(canopen::raw(all_lines)),
                    outputs_.template write<can_2057c::od::error_mode_output_8_bit<2>>(canopen::raw(all_lines))});
      case 2: return inputs_.template write<can_2053c::od::tpdo_communication_parameter_1::event_timer>(500_ms);
      case 3:
        return guarded<can_2024c::Device, can_2024c::od::guard_time, can_2024c::od::life_time_factor>(
            analogue_outputs_);
      case 4: return analogue_inputs_.template write<can_2017c::od::tpdo_communication_parameter_2::event_timer>(50_ms);
      default: return canopen::ok;
    }
  }
  template <class Device, class GuardTime, class LifeTimeFactor>
  [[nodiscard]] canopen::Result<void> guarded(canopen::MasterRemote<Device, B>& node) const {
    return all({node.template write<GuardTime>(canopen::raw(guard_time(cycle_))),
                node.template write<LifeTimeFactor>(life_time_factor)});
  }
  /// Returns the first failure of several transfers.
  [[nodiscard]] static canopen::Result<void> all(std::initializer_list<canopen::Result<void>> results) {
    for (const canopen::Result<void>& result : results) {
      if (!result) return result;
    }
    return canopen::ok;
  }

  void listen() {
    listening_ = static_cast<bool>(all({
        inputs_.template on_pdo<can_2053c::Tpdo1>(
            [this](auto low, auto high) { read_.digital = static_cast<std::uint16_t>(low.raw() | high.raw() << 8); }),
        analogue_inputs_.template on_pdo<can_2017c::Tpdo2>(
            [this](auto first, auto, auto, auto) { read_.analogue = first.raw(); }),
    }));
    if (!listening_) log_("the PDOs of the inputs cannot be read");
  }

  /// Stops the output modules, which then set their error values. A lost module itself is already being reset.
  void lost(canopen::NodeId node_id) {
    log_(name(node_id) + " is lost: outputs stop");
    running_ = false;
    ready_[node_id.value() - 1u] = false;
    for (const canopen::NodeId with_outputs : {outputs_.node_id(), analogue_outputs_.node_id()}) {
      if (!master_.state(with_outputs)) continue;
      static_cast<void>(master_.command(canopen::NmtCommand::stop, with_outputs));
    }
  }

  // Running

  /// Numbers of the modules, whose inputs and outputs are wired to each other and have the same scale.
  struct Channels {
    std::uint16_t digital = 0;
    std::int16_t analogue = 0;
    friend bool operator==(const Channels&, const Channels&) = default;
  };

  void write_outputs() {
    constexpr auto none = canopen::raw(std::int16_t{0});
    Channels next = written_.value_or(Channels{});
    next.digital = static_cast<std::uint16_t>(next.digital + 1);
    next.analogue = static_cast<std::int16_t>(next.analogue >= 16'000 ? -16'000 : next.analogue + 1'000);
    const auto sent = all({
        outputs_.template send<can_2057c::Rpdo1>(canopen::raw(static_cast<std::uint8_t>(next.digital)),
                                                 canopen::raw(static_cast<std::uint8_t>(next.digital >> 8))),
        analogue_outputs_.template send<can_2024c::Rpdo2>(canopen::raw(next.analogue), none, none, none),
    });
    if (sent) written_ = next;
  }

  void compare() {
    if (!written_) return;
    if (read_ == *written_) {
      ++agreed_;
      return;
    }
    ++differed_;
    log_("inputs " + hex(read_.digital, 4) + ", " + std::to_string(read_.analogue) + " but outputs " +
         hex(written_->digital, 4) + ", " + std::to_string(written_->analogue));
  }

  [[nodiscard]] static std::string name(canopen::NodeId node_id) { return "node " + std::to_string(node_id.value()); }
  [[nodiscard]] static std::string hex(unsigned value, int digits) {
    char text[16];
    std::snprintf(text, sizeof text, "%0*Xh", digits, value);
    return text;
  }

  Log log_;
  canopen::Duration cycle_;
  canopen::Master<B> master_;
  canopen::MasterRemote<can_2057c::Device, B> outputs_{master_, canopen::NodeId{1}};
  canopen::MasterRemote<can_2053c::Device, B> inputs_{master_, canopen::NodeId{2}};
  canopen::MasterRemote<can_2024c::Device, B> analogue_outputs_{master_, canopen::NodeId{3}};
  canopen::MasterRemote<can_2017c::Device, B> analogue_inputs_{master_, canopen::NodeId{4}};
  std::array<bool, nodes> ready_{};
  bool listening_ = false;
  bool running_ = false;
  std::optional<Channels> written_;
  Channels read_;
  unsigned agreed_ = 0;
  unsigned differed_ = 0;
};
