/// The services of a node, each with the same optional functions, and the folds over them.
///
/// A service is a class with the functions of `ServiceDefaults` that it needs. `host` is a ServiceHost: the functions
/// of the node that a service may call. A node calls the functions of all its services in the order of their list,
/// which is therefore also the order of frames, if several are due.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/base/deadline.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/emcy/service_error.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/od/object.hpp"
#include "canopen/sync/sync.hpp"

namespace canopen {

/// What a service does unless it has a function of its own. The parameter makes the type of each empty base its own, so
/// that bases of several services share one address.
template <class Service>
struct ServiceDefaults {
  /// Whether the device has the service; otherwise an image does not contain any of it.
  static constexpr bool exists = true;
  /// Whether it works in Initialisation and while the bit rate is switched. No other service is called there.
  static constexpr bool runs_without_node_id = false;
  /// Whether it sends there, or ends Initialisation.
  static constexpr bool sends_without_node_id = false;
  /// Whether `on_frame` may receive frames with restricted CAN-IDs: those that no COB-ID can be set to.
  static constexpr bool has_fixed_can_id = false;

  // Start, reset and NMT states

  /// Power-on, before the first reset.
  template <class Host>
  static void on_start(Host&) {}
  /// Reset of 2000h..FFFFh; `reset_communication` follows.
  template <class Host>
  static void reset_application(Host&) {}
  /// Reset of 1000h..1FFFh, before the node enters Initialisation.
  template <class Host>
  static void reset_communication(Host&) {}
  /// The node has entered a state.
  template <class Host>
  static void on_state(Host&, [[maybe_unused]] NmtState before, [[maybe_unused]] NmtState state) {}

  // Frames: returns whether the frame is one of this service

  /// The frames that are received most often, before all others. Not called for a remote frame.
  template <class Host>
  static bool on_frequent_frame(Host&, const Frame&, [[maybe_unused]] std::uint32_t cob_id) {
    return false;
  }
  /// Whether `on_frame` takes a frame with this CAN-ID, which is one that the pre-defined connection set assigns to
  /// PDOs and is none of `on_frequent_frame`. A frame that no service takes is ignored at once: most frames of a bus
  /// are for other nodes.
  template <class Host>
  static constexpr bool may_take(const Host&, [[maybe_unused]] std::uint32_t cob_id) {
    return false;
  }
  /// Not called for a remote frame.
  template <class Host>
  static bool on_frame(Host&, const Frame&, [[maybe_unused]] std::uint32_t cob_id) {
    return false;
  }
  template <class Host>
  static bool on_remote_frame(Host&, const Frame&) {
    return false;
  }
  /// A SYNC has been received, or sent by this node.
  template <class Host>
  static void on_sync(Host&, [[maybe_unused]] Sync sync) {}

  // Time and transmission

  template <class Host>
  static void on_time(Host&) {}
  /// Sends what is due. Returns false if the bus had no room; the rest remains due.
  template <class Host>
  static bool serve(Host&) {
    return true;
  }
  /// Returns when `on_time` or `serve` is next due; not later than `host.now` if it is already due.
  template <class Host>
  static std::optional<TimePoint> deadline(Host&) {
    return std::nullopt;
  }
  /// Keeps the deadlines that `serve` leaves as they are while the bus has no room.
  template <class Host>
  static void keep_deadlines(Host&) {}
  /// Whether the node may not send anything now.
  static constexpr bool silent() { return false; }

  // Errors

  /// Returns the errors that are present.
  static constexpr ServiceErrors errors() { return {}; }

  // Objects

  /// Whether `check_write` decides about writes to an entry. One service does for each entry.
  static constexpr bool checks([[maybe_unused]] std::uint16_t index, [[maybe_unused]] std::uint8_t sub_index) {
    return false;
  }
  /// Whether it does so for objects outside of 1000h..1FFFh.
  static constexpr bool checks_application_objects = false;
  /// Checks whether these bytes, whose length and limits are correct, may be written; may change them.
  template <class Host>
  static AbortCode check_write(Host&, std::uint16_t, std::uint8_t, std::span<std::uint8_t>) {
    return ok;
  }
  /// Applies a parameter of 1000h..1FFFh that has been written, with a new or the same value.
  template <class Host>
  static void after_write(Host&, [[maybe_unused]] std::uint16_t index, [[maybe_unused]] std::uint8_t sub_index) {}
  /// The same for any object, in Operational. `new_value`: it differs from the previous one.
  template <class Host>
  static void after_operational_write(Host&, [[maybe_unused]] std::uint16_t index,
                                      [[maybe_unused]] std::uint8_t sub_index, [[maybe_unused]] bool new_value) {}
  /// An object that is known at compile time has a new value, in Operational. Returns whether something is to be sent.
  template <DictionaryObject Object, class Host>
  static bool on_new_value(Host&) {
    return false;  // nothing is to be sent
  }
  /// Checks whether an entry may be read now.
  template <class Host>
  static AbortCode before_read(Host&, std::uint16_t, std::uint8_t) {
    return ok;
  }
  /// Whether `command` handles writes to an entry without a value.
  static constexpr bool has_command([[maybe_unused]] std::uint16_t index) { return false; }
  template <class Host>
  static AbortCode command(Host&, std::uint16_t, std::uint8_t, std::span<std::uint8_t>) {
    return AbortCode::not_stored;
  }
};

namespace service_detail {

template <class Service>
struct Absent : ServiceDefaults<Absent<Service>> {};

/// The service, or nothing if the device does not have it.
template <class Service>
using Present = std::conditional_t<Service::exists, Service, Absent<Service>>;

}  // namespace service_detail

/// The services of one node. Each function calls that of all services.
template <class... Services>
class ServiceSet : private service_detail::Present<Services>... {
  template <class ServiceType>
  using Present = service_detail::Present<ServiceType>;

 public:
  /// Whether a service works without node-ID.
  static constexpr bool has_any_without_node_id = (Present<Services>::runs_without_node_id || ...);
  static constexpr bool sends_without_node_id = (Present<Services>::sends_without_node_id || ...);

  /// Returns a service that the device has.
  template <class ServiceType>
  [[nodiscard]] ServiceType& get() {
    return *this;
  }
  template <class ServiceType>
  [[nodiscard]] const ServiceType& get() const {
    return *this;
  }

  template <class Host>
  void on_start(Host& host) {
    (Present<Services>::on_start(host), ...);
  }
  template <class Host>
  void reset_application(Host& host) {
    (Present<Services>::reset_application(host), ...);
  }
  template <class Host>
  void reset_communication(Host& host) {
    (Present<Services>::reset_communication(host), ...);
  }
  template <class Host>
  void on_state(Host& host, NmtState before, NmtState state) {
    (Present<Services>::on_state(host, before, state), ...);
  }

  template <class Host>
  [[nodiscard]] bool on_frequent_frame(Host& host, const Frame& frame, std::uint32_t cob_id) {
    return (Present<Services>::on_frequent_frame(host, frame, cob_id) || ...);
  }
  /// Whether the CAN-ID of a frame that is not a frequent one may be that of any service.
  template <class Host>
  [[nodiscard]] bool may_take(const Host& host, std::uint32_t cob_id) const {
    return !is_pdo_can_id(cob_id) || (Present<Services>::may_take(host, cob_id) || ...);
  }
  /// Passes each frame to the services that work without node-ID; others may process it as well.
  template <class Host>
  void on_frame_without_node_id(Host& host, const Frame& frame) {
    (static_cast<void>(Present<Services>::runs_without_node_id &&
                       Present<Services>::on_frame(host, frame, cob_id_of(frame))),
     ...);
  }
  /// Passes a frame with a CAN-ID of the pre-defined connection set.
  template <class Host>
  [[nodiscard]] bool on_fixed_frame(Host& host, const Frame& frame, std::uint32_t cob_id) {
    return ((Present<Services>::has_fixed_can_id && Present<Services>::on_frame(host, frame, cob_id)) || ...);
  }
  /// Passes a frame whose CAN-ID may be that of a configured COB-ID.
  template <class Host>
  [[nodiscard]] bool on_frame(Host& host, const Frame& frame, std::uint32_t cob_id) {
    return ((is_configured<Services> && Present<Services>::on_frame(host, frame, cob_id)) || ...);
  }
  template <class Host>
  [[nodiscard]] bool on_remote_frame(Host& host, const Frame& frame) {
    return (Present<Services>::on_remote_frame(host, frame) || ...);
  }
  template <class Host>
  void on_sync(Host& host, Sync sync) {
    (Present<Services>::on_sync(host, sync), ...);
  }

  template <class Host>
  void on_time_without_node_id(Host& host) {
    ((Present<Services>::runs_without_node_id ? Present<Services>::on_time(host) : void()), ...);
  }
  template <class Host>
  void on_time(Host& host) {
    ((Present<Services>::runs_without_node_id ? void() : Present<Services>::on_time(host)), ...);
  }
  /// Sends what is due, in the order of the services, until the bus has no room. Returns false if it has none.
  template <class Host>
  [[nodiscard]] bool serve(Host& host) {
    return (Present<Services>::serve(host) && ...);
  }
  template <class Host>
  [[nodiscard]] bool serve_without_node_id(Host& host) {
    return ((!Present<Services>::runs_without_node_id || Present<Services>::serve(host)) && ...);
  }
  template <class Host>
  void keep_deadlines(Host& host) {
    (Present<Services>::keep_deadlines(host), ...);
  }
  /// Returns the earliest deadline; of those services only that work without node-ID if `all` is not set.
  template <class Host>
  [[nodiscard]] std::optional<TimePoint> deadline(Host& host, bool all) const {
    std::optional<TimePoint> next;
    (consider<Services>(next, host, all), ...);
    return next;
  }
  [[nodiscard]] bool silent() const { return (Present<Services>::silent() || ...); }

  [[nodiscard]] ServiceErrors errors() const {
    return static_cast<ServiceErrors>((unsigned{Present<Services>::errors()} | ...));
  }

  /// Whether a service checks writes to an entry outside of 1000h..1FFFh.
  [[nodiscard]] static constexpr bool checks_application_object(std::uint16_t index, std::uint8_t sub_index) {
    return ((Present<Services>::checks_application_objects && Present<Services>::checks(index, sub_index)) || ...);
  }
  template <class Host>
  [[nodiscard]] AbortCode check_write(Host& host, std::uint16_t index, std::uint8_t sub_index,
                                      std::span<std::uint8_t> bytes) {
    return check_first<Services...>(host, index, sub_index, bytes);
  }
  template <class Host>
  void after_write(Host& host, std::uint16_t index, std::uint8_t sub_index) {
    (Present<Services>::after_write(host, index, sub_index), ...);
  }
  template <class Host>
  void after_operational_write(Host& host, std::uint16_t index, std::uint8_t sub_index, bool new_value) {
    (Present<Services>::after_operational_write(host, index, sub_index, new_value), ...);
  }
  template <DictionaryObject Object, class Host>
  [[nodiscard]] bool on_new_value(Host& host) {
    return (static_cast<unsigned>(Present<Services>::template on_new_value<Object>(host)) | ...) != 0;
  }
  template <class Host>
  [[nodiscard]] AbortCode before_read(Host& host, std::uint16_t index, std::uint8_t sub_index) {
    AbortCode code = ok;
    static_cast<void>((((code = Present<Services>::before_read(host, index, sub_index)) == ok) && ...));
    return code;
  }
  template <class Host>
  [[nodiscard]] AbortCode command(Host& host, std::uint16_t index, std::uint8_t sub_index,
                                  std::span<std::uint8_t> bytes) {
    AbortCode code = AbortCode::not_stored;
    static_cast<void>((command_if<Services>(host, index, sub_index, bytes, code) || ...));
    return code;
  }

 private:
  template <class ServiceType>
  static constexpr bool is_configured =
      !Present<ServiceType>::has_fixed_can_id && !Present<ServiceType>::runs_without_node_id;

  template <class ServiceType, class Host>
  void consider(std::optional<TimePoint>& next, Host& host, bool all) const {
    if (!all && !Present<ServiceType>::runs_without_node_id) return;
    const std::optional<TimePoint> other = Present<ServiceType>::deadline(host);
    if (other) next = next ? earlier_deadline(*next, *other, host.now) : *other;
  }

  /// Not a fold: with one return for each service, an image is smaller.
  template <class ServiceType, class... Rest, class Host>
  [[nodiscard]] AbortCode check_first(Host& host, std::uint16_t index, std::uint8_t sub_index,
                                      std::span<std::uint8_t> bytes) {
    if (Present<ServiceType>::checks(index, sub_index))
      return Present<ServiceType>::check_write(host, index, sub_index, bytes);
    if constexpr (sizeof...(Rest) != 0) return check_first<Rest...>(host, index, sub_index, bytes);
    return ok;
  }

  template <class ServiceType, class Host>
  [[nodiscard]] bool command_if(Host& host, std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes,
                                AbortCode& code) {
    if (!Present<ServiceType>::has_command(index)) return false;
    code = Present<ServiceType>::command(host, index, sub_index, bytes);
    return true;
  }
};

}  // namespace canopen
