/// Values that other contexts have posted to the mailboxes of a node.
#pragma once

#include <optional>
#include <tuple>

#include "canopen/base/clock.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/node/values_from.hpp"

namespace canopen::service {

template <class Device, class... Handlers>
class PostedValues : public ServiceDefaults<PostedValues<Device, Handlers...>> {
 public:
  static constexpr bool exists = (mailbox_detail::is_values_from<Handlers> || ...);
  /// A posted value makes the node due at once, in each state, and periodic functions get it.
  static constexpr bool runs_without_node_id = true;

  template <class Host>
  static void on_time(Host& host) {
    std::apply([&](const auto&... handlers) { (take_over(handlers, host), ...); }, host.handlers.all());
  }
  template <class Host>
  static std::optional<TimePoint> deadline(Host& host) {
    const bool any =
        std::apply([](const auto&... handlers) { return (pending(handlers) || ...); }, host.handlers.all());
    return any ? std::optional{host.now} : std::nullopt;
  }

 private:
  template <class Handler, class Host>
  static void take_over(const Handler&, Host&) {}
  template <class MailboxType, class Host>
  static void take_over(const ValuesFrom<MailboxType>& values, Host& host) {
    values.mailbox->take_over(host.node());
  }

  template <class Handler>
  [[nodiscard]] static bool pending(const Handler&) {
    return false;
  }
  template <class MailboxType>
  [[nodiscard]] static bool pending(const ValuesFrom<MailboxType>& values) {
    return values.mailbox->pending();
  }
};

}  // namespace canopen::service
