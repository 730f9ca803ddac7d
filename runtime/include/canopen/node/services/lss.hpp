/// LSS slave in a node, if the application provides a port for it.
#pragma once

#include <cstdint>
#include <optional>
#include <tuple>
#include <type_traits>

#include "canopen/lss/lss_handler.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/sheet.hpp"

namespace canopen::service {

template <class Device, class... Handlers>
class Lss : public ServiceDefaults<Lss<Device, Handlers...>> {
  using Handler = typename lss_detail::Find<Handlers...>::type;

 public:
  static constexpr bool exists = !std::is_void_v<Handler>;
  static constexpr bool runs_without_node_id = true;
  static constexpr bool sends_without_node_id = true;

  template <class Host>
  void on_start(Host& host) {
    if constexpr (has_sheet<Device>) {
      if (const auto& options = Device::sheet_of(host.store).lss_options; options) slave_.set_options(*options);
    }
    slave_.start(host.node_id, port(host).bit_timing());
  }
  /// The pending node-ID is activated by reset communication.
  template <class Host>
  void reset_application(Host& host) {
    slave_.reset_application();
    host.node_id = slave_.pending_node_id();
  }
  template <class Host>
  void reset_communication(Host& host) {
    host.node_id = slave_.reset_communication();
  }
  template <class Host>
  void on_state(Host&, NmtState, NmtState state) {
    slave_.enter(state);
  }

  /// Not inlined: saves 44 bytes of a Cortex-M0+.
  template <class Host>
  [[gnu::noinline]] bool on_frame(Host& host, const Frame& frame, std::uint32_t) {
    if constexpr (has_sheet<Device>) {
      if (!Device::sheet_of(host.store).lss_options) return false;
    }
    slave_.on_frame(frame, Hooks<Host>{host}, host.now);
    if (slave_.has_reply()) host.attention = true;
    return false;
  }
  template <class Host>
  void on_time(Host& host) {
    slave_.on_time(Hooks<Host>{host}, host.now);
  }
  template <class Host>
  bool serve(Host& host) {
    return slave_.serve(host.bus);
  }
  template <class Host>
  std::optional<TimePoint> deadline(Host& host) const {
    return slave_.has_reply() && !slave_.silent() ? host.now : slave_.next_deadline();
  }
  /// While the bit rate is being switched.
  bool silent() const { return slave_.silent(); }

 private:
  template <class Host>
  [[nodiscard]] static auto& port(Host& host) {
    return *std::get<Handler>(host.handlers.all()).port;
  }

  template <class Host>
  struct Hooks {
    Host& host;
    [[nodiscard]] std::uint32_t identity(std::uint8_t sub_index) const {
      const entry::Word word = host.store.entries().dictionary().find(0x1018, sub_index);
      return word > Dictionary::no_sub_index ? host.store.entries().number(word) : 0;
    }
    [[nodiscard]] LssError accept(NodeId node_id) const { return port(host).accept(node_id); }
    [[nodiscard]] LssError accept(LssBitTiming timing) const { return port(host).accept(timing); }
    [[nodiscard]] LssError store(NodeId node_id, LssBitTiming timing) const {
      return port(host).store(node_id, timing);
    }
    void reset_communication() const { host.reset_communication(); }
    void stop_communication() const { port(host).stop_communication(); }
    void start_communication(LssBitTiming timing) const { port(host).start_communication(timing); }
  };

  [[no_unique_address]] typename lss_detail::SlaveOf<Device, Handler>::type slave_{};
};

}  // namespace canopen::service
