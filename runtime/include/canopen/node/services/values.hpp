/// The values of a node at a reset: default values, or those that are stored (1010h, 1011h, 1020h).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include "canopen/base/clock.hpp"
#include "canopen/emcy/error_register.hpp"
#include "canopen/node/application.hpp"
#include "canopen/node/functions.hpp"
#include "canopen/node/handler_calls.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/node/services/emergency.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/storage/parameter_storage.hpp"
#include "canopen/storage/storage.hpp"

namespace canopen::service {

/// Default values at each reset. 1010h and 1011h reject every write.
template <class Device, class... Handlers>
class DefaultValues : public ServiceDefaults<DefaultValues<Device, Handlers...>> {
 public:
  static constexpr bool exists = !storage_detail::has_storage<Handlers...>;

  template <class Host>
  static void reset_application(Host& host) {
    host.store.reset_application(host.node_id);
  }
  template <class Host>
  static void reset_communication(Host& host) {
    host.store.reset_communication(host.node_id);
  }
};

/// Stored values, if the application provides a storage.
template <class Device, class... Handlers>
class StoredValues : public ServiceDefaults<StoredValues<Device, Handlers...>> {
  struct NoStorage {};
  /// A node without a storage does not make the compiler lay out the stored values.
  using Stored = std::conditional_t<storage_detail::has_storage<Handlers...>, ParameterStorage<Device>, NoStorage>;
  static constexpr bool has_hook = (handler_detail::has_event_function<function::OnStoredValue, Handlers> || ...);

  /// Passes a stored value to the application.
  template <class Host>
  struct Hook {
    static constexpr bool exists = has_hook;
    static constexpr bool lists = false;
    Host* host;
    void operator()(const StoredValue& value) const {
      host->handlers.template notify<function::OnStoredValue>(host->node(), value);
    }
  };

 public:
  static constexpr bool exists = storage_detail::has_storage<Handlers...>;
  /// Whether the storage is written while the node works.
  static constexpr bool is_stepped = (storage_detail::is_stepped<Handlers> || ...);

  template <class Host>
  void on_start(Host& host) {
    stored_.open(host.handlers.storage());
  }
  template <class Host>
  void reset_application(Host& host) {
    finish(host);
    Hook<Host> hook{&host};
    stored_.reset_application(host.handlers.storage(), host.store, host.node_id, hook);
  }
  /// Reports stored values that have been lost, by EMCY 6300h.
  template <class Host>
  void reset_communication(Host& host) {
    finish(host);
    Hook<Host> hook{&host};
    stored_.reset_communication(host.handlers.storage(), host.store, host.node_id, hook);
    if (!stored_.damaged()) return;
    constexpr std::uint16_t code = emergency_code::data_set;
    host.services.template get<Emergency<Device>>().report(host, code, ErrorRegister::generic,
                                                           emergency_info<Device>(host.store, code));
  }

  /// Writes the next part of an image.
  template <class Host>
  void on_time([[maybe_unused]] Host& host) {
    if constexpr (is_stepped) {
      auto& storage = host.handlers.storage();
      if (!storage.busy() || !storage.ready()) return;
      storage.step();
      progress_.ended = !storage.busy();
      progress_.failed = storage.failed();
    }
  }
  template <class Host>
  static std::optional<TimePoint> deadline([[maybe_unused]] Host& host) {
    if constexpr (is_stepped) {
      auto& storage = host.handlers.storage();
      if (storage.busy()) return host.now + (storage.ready() ? Duration{0} : poll_period);
    }
    return std::nullopt;
  }
  /// Whether the last command has started to write an image; once.
  [[nodiscard]] bool take_started() requires(is_stepped) { return std::exchange(progress_.started, false); }
  /// Returns the result when an image has been written; once.
  [[nodiscard]] std::optional<AbortCode> take_result() requires(is_stepped) {
    if (!std::exchange(progress_.ended, false)) return std::nullopt;
    return progress_.failed ? AbortCode::hardware : ok;
  }

  /// "save" and "load". Sub-indices of 1010h and 1011h without a range in CiA 301 are left to their write handlers.
  static constexpr bool has_command(std::uint16_t index) {
    return index == store_parameters || index == restore_parameters;
  }
  template <class Host>
  AbortCode command(Host& host, std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
    const std::uint32_t key = object_key(index, sub_index);
    AbortCode code = check_storage_command(host.store.entries(), index, sub_index, bytes);
    if (code == ok) {
      const HandlerCall call{host.handler_calls, key};
      code = host.handlers.before_write(host.node(), key, bytes);
    }
    if (code != ok || (Stored::Layout::sections_of(sub_index) == 0 && host.handlers.handles(key))) return code;
    code = index == store_parameters ? save(host, sub_index) : restore(host, sub_index);
    if constexpr (is_stepped) progress_.started = code == ok && host.handlers.storage().busy();
    return code;
  }

  /// Stores the parameters of a sub-index of 1010h. device_state: those before are still being written.
  template <class Host>
  [[nodiscard]] AbortCode save(Host& host, std::uint8_t sub_index) {
    if (is_writing(host)) return AbortCode::device_state;
    const SectionSet sections = Stored::Layout::sections_of(sub_index);
    Hook<Host> hook{&host};
    const bool saved = sections != 0 && stored_.save(host.handlers.storage(), sections, host.store, hook);
    if constexpr (is_stepped) host.attention = true;
    return saved ? ok : AbortCode::hardware;
  }
  /// Calls `visit(StoredValue)` for each stored value that is not loaded.
  template <class Host, class Visit>
  void for_each_not_loaded(Host& host, Visit visit) {
    stored_.for_each_not_loaded(host.handlers.storage(), host.store, visit);
  }
  /// Restores the default values of a sub-index of 1011h.
  template <class Host>
  [[nodiscard]] AbortCode restore(Host& host, std::uint8_t sub_index) {
    if (is_writing(host)) return AbortCode::device_state;
    const SectionSet sections = Stored::Layout::sections_of(sub_index);
    Hook<Host> hook{&host};
    const bool restored = sections != 0 && stored_.restore(host.handlers.storage(), sections, host.store, hook);
    if constexpr (is_stepped) host.attention = true;
    return restored ? ok : AbortCode::hardware;
  }

  /// Called before these bytes are written to an object: 1020h becomes 0 if they change the configuration.
  template <class Host>
  static void before_change(Host& host, std::uint16_t index, std::uint8_t sub_index,
                            std::span<const std::uint8_t> bytes) {
    Stored::before_write(host.store, index, sub_index, bytes);
  }
  /// The same after the value of an object has changed.
  template <DictionaryObject Object, class Host>
  static void after_change([[maybe_unused]] Host& host) {
    if constexpr (Stored::template is_configuration<Object>) Stored::clear_configuration(host.store);
  }

 private:
  struct Progress {
    bool started = false;  ///< by the last command
    bool ended = false;    ///< the result has not been reported yet
    bool failed = false;
  };
  struct NoProgress {};
  /// How often a storage that is not ready is asked again.
  static constexpr Duration poll_period{1'000};

  template <class Host>
  [[nodiscard]] static bool is_writing([[maybe_unused]] Host& host) {
    if constexpr (is_stepped) return host.handlers.storage().busy();
    return false;
  }
  /// Completes an image before it is read. The response to its command is not sent: a reset ends all transfers.
  template <class Host>
  void finish([[maybe_unused]] Host& host) {
    if constexpr (is_stepped) {
      static_assert(std::remove_reference_t<decltype(host.handlers.storage())>::capacity >= Stored::Layout::max_image,
                    "the storage is smaller than the parameters of this device");
      host.handlers.storage().finish();
      progress_ = {};
    }
  }

  Stored stored_{};
  [[no_unique_address]] std::conditional_t<is_stepped, Progress, NoProgress> progress_{};
};

}  // namespace canopen::service
