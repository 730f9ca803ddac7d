/// The master of one servo drive, node 5, which docs/master.md describes.
#pragma once

#include <canopen/master.hpp>
#include <cpc_tc1/device.hpp>
#include <cpc_tc1/pdo.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

template <canopen::BlockingBus B>
class DriveMaster {
 public:
  using Log = std::function<void(const std::string& line)>;

  DriveMaster(B& bus, Log log) : log_{std::move(log)}, master_{bus, network_list()} {
    master_.on_configure = [this](canopen::NodeId) { return configure(); };
    master_.on_booted = [this](canopen::NodeId node, const canopen::BootResult& result) {
      log_(boot_text(node, result));
    };
    master_.on_event = [this](canopen::NmtMasterEvent event, canopen::NodeId node, canopen::NmtState state) {
      log_(event_text(event, node, state));
      if (event == canopen::NmtMasterEvent::lost) position_.reset();
    };
    master_.on_network_started = [this] { listen(); };
    master_.start();
  }

  void run_for(canopen::Duration span) { master_.poll(span); }

  /// std::nullopt before the first TPDO, and while the drive is lost.
  [[nodiscard]] std::optional<std::int32_t> position() const { return position_; }

  [[nodiscard]] canopen::Result<void> switch_on() {
    using command = Controlword::command_value;
    if (const auto sent = drive_.template send<cpc_tc1::Rpdo1>(Controlword{}.command(command::shutdown)); !sent)
      return sent;
    const auto status = drive_.template read<cpc_tc1::od::statusword>();
    if (!status) return status.abort_code();
    log_(status->ready_to_switch_on() ? "ready to switch on" : "not ready to switch on");
    return canopen::ok;
  }

 private:
  using Controlword = cpc_tc1::od::controlword::type;
  using Statusword = cpc_tc1::od::statusword::type;

  [[nodiscard]] static std::vector<canopen::NmtSlave> network_list() {
    using namespace canopen::slave_assignment;
    canopen::NmtSlave drive{canopen::NodeId{5}, listed | boot | mandatory};
    drive.vendor_id = 0x3F5;
    drive.product_code = 1;
    drive.heartbeat_time = 300;
    return {drive};
  }

  [[nodiscard]] canopen::Result<void> configure() {
    using namespace canopen::literals;
    return drive_.template write<cpc_tc1::od::tpdo_communication_parameter_2::event_timer>(20_ms);
  }

  void listen() {
    const canopen::Result<void> done =
        drive_.template on_pdo<cpc_tc1::Tpdo2>([this](Statusword, std::int32_t position) { position_ = position; });
    if (!done) log_("no TPDO 2: " + std::string{to_text(done.abort_code())});
  }

  Log log_;
  canopen::Master<B> master_;
  canopen::MasterRemote<cpc_tc1::Device, B> drive_{master_, canopen::NodeId{5}};
  std::optional<std::int32_t> position_;
};
