/// SYNC in a node (1005h, 1006h, 1007h, 1019h): consumer, producer and synchronous window.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>

#include "canopen/node/functions.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/sync/sync.hpp"

namespace canopen::service {

template <class Device>
class Sync : public ServiceDefaults<Sync<Device>> {
  using Consumer = SyncConsumer<Device>;
  using Producer = SyncProducer<Device>;

 public:
  static constexpr bool exists = Consumer::exists;

  template <class Host>
  void on_state([[maybe_unused]] Host& host, [[maybe_unused]] NmtState before, [[maybe_unused]] NmtState state) {
    if constexpr (Producer::exists) {
      if (!serves_sync(state)) {
        producer_.stop();
      } else if (!serves_sync(before)) {
        producer_.start(host.store, host.now, true);
      }
    }
  }

  template <class Host>
  static bool may_take(const Host& host, std::uint32_t cob_id) {
    return Consumer::takes(host.store, cob_id);
  }
  template <class Host>
  bool on_frame(Host& host, const Frame& frame, std::uint32_t cob_id) {
    if (!Consumer::takes(host.store, cob_id)) return false;
    receive(host, Consumer::sync_of(host.store, frame));
    return true;
  }

  /// Sends a SYNC, which this node consumes itself. More important frames are sent before the PDOs of the SYNC.
  /// Inlined: saves 16 bytes of stack on a Cortex-M0+.
  template <class Host>
  [[gnu::always_inline]] bool serve([[maybe_unused]] Host& host) {
    if constexpr (Producer::exists) {
      if (producer_.serve(host.store, host.bus, host.now)) {
        host.attention = true;
        receive(host, producer_.last(host.store));
        host.attention = false;
      }
    }
    return true;
  }

  template <class Host>
  void on_time([[maybe_unused]] Host& host) {
    window_.keep_deadline(host.now);
  }
  template <class Host>
  std::optional<TimePoint> deadline([[maybe_unused]] Host& host) const {
    std::optional<TimePoint> next = window_.next_deadline(host.now);
    if constexpr (Producer::exists) {
      if (const auto due = producer_.next_deadline(); due) next = next ? earlier_deadline(*next, *due, host.now) : due;
    }
    return next;
  }

  /// Whether the node sends SYNC, or has a synchronous window: their times are in microseconds.
  [[nodiscard]] bool needs_exact_time() const {
    if constexpr (Producer::exists) {
      if (producer_.runs()) return true;
    }
    return SyncWindow<Device>::exists;
  }

  /// Whether the synchronous window has elapsed.
  [[nodiscard]] bool window_over(TimePoint now) const { return window_.over(now); }

  static constexpr bool checks(std::uint16_t index, std::uint8_t) {
    return index == 0x1005 || index == 0x1006 || (Consumer::has_overflow && index == 0x1019);
  }
  template <class Host>
  static AbortCode check_write(Host& host, std::uint16_t index, std::uint8_t, std::span<std::uint8_t> bytes) {
    return check_sync_parameter(host.store.entries(), index, bytes);
  }
  template <class Host>
  void after_write([[maybe_unused]] Host& host, [[maybe_unused]] std::uint16_t index, std::uint8_t) {
    if constexpr (Producer::exists) {
      if ((index == 0x1005 || index == 0x1006) && serves_sync(host.state)) producer_.start(host.store, host.now, false);
    }
    if (index == 0x1007) window_.length_changed(host.store);
  }

 private:
  struct NoProducer {};

  template <class Host>
  [[gnu::noinline]] static void receive(Host& host, canopen::Sync sync) {
    if (!serves_sync(host.state)) return;
    if constexpr (Consumer::has_overflow) {
      if (!sync.good) {
        host.report(ServiceError::sync_length);
        return;
      }
      host.end(ServiceError::sync_length);
    }
    host.services.template get<Sync>().window_.open(host.store, host.now);
    host.services.on_sync(host, sync);
    host.handlers.template notify<function::OnSync>(host.node(), sync.counter);
  }

  [[no_unique_address]] std::conditional_t<Producer::exists, Producer, NoProducer> producer_{};
  [[no_unique_address]] SyncWindow<Device> window_{};
};

/// Whether the synchronous window of a node has elapsed; never without 1007h.
template <class Host>
[[nodiscard]] bool sync_window_over([[maybe_unused]] Host& host) {
  using Device = typename Host::Device;
  if constexpr (SyncWindow<Device>::exists) {
    return host.services.template get<Sync<Device>>().window_over(host.now);
  } else {
    return false;
  }
}

}  // namespace canopen::service
