/// DOMAINs with memory among the parts of a node, bound at power-on.
#pragma once

#include <tuple>

#include "canopen/node/service_set.hpp"
#include "canopen/sdo/domain_handlers.hpp"

namespace canopen::service {

template <class Device, class... Handlers>
class BoundDomains : public ServiceDefaults<BoundDomains<Device, Handlers...>> {
 public:
  static constexpr bool exists = (domain_detail::is_bound_to<Handlers> || ...);

  template <class Host>
  static void on_start(Host& host) {
    std::apply([&](auto&... handler) { (bind(host, handler), ...); }, host.handlers.all());
  }

 private:
  template <class Host, class Handler>
  static void bind([[maybe_unused]] Host& host, [[maybe_unused]] const Handler& handler) {
    if constexpr (domain_detail::is_bound_to<Handler>) {
      if (!handler.memory.empty()) host.node().template bind<typename Handler::object>(handler.memory, handler.size);
    }
  }
};

}  // namespace canopen::service
