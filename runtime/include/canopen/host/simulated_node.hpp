/// A node of some device behind one interface, for programs that simulate several devices: a source that includes one
/// device and this header compiles the node alone, without the bus and the protocol of host/simulated_device.hpp. Host
/// side.
#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "canopen/host/memory_storage.hpp"
#include "canopen/lss/lss_handler.hpp"
#include "canopen/node.hpp"
#include "canopen/node/accepted_frames.hpp"
#include "canopen/storage/storage.hpp"

namespace canopen {

/// The bus of a SimulatedNode.
class SimulatedBus {
 public:
  virtual bool send(const Frame& frame) = 0;

 protected:
  ~SimulatedBus() = default;
};

/// What a simulated device keeps without power: parameters, and what LSS has stored. Is the port of its LSS slave: each
/// node-ID and bit rate is accepted. A bit rate does not change anything on the simulated bus.
class SimulatedMemory {
 public:
  explicit SimulatedMemory(NodeId node_id) : node_id_{node_id} {}

  MemoryStorage parameters;

  [[nodiscard]] NodeId node_id() const { return node_id_; }
  [[nodiscard]] LssBitTiming bit_timing() const { return bit_timing_; }
  [[nodiscard]] LssError accept(NodeId) const { return lss::success; }
  [[nodiscard]] LssError accept(LssBitTiming) const { return lss::success; }
  [[nodiscard]] LssError store(NodeId node_id, LssBitTiming bit_timing) {
    node_id_ = node_id;
    bit_timing_ = bit_timing;
    return lss::success;
  }
  void stop_communication() {}
  void start_communication(LssBitTiming) {}

 private:
  NodeId node_id_;
  LssBitTiming bit_timing_{};
};

/// A device between power-on and power-off, with its application. Lives as long as its bus and memory at most.
class SimulatedNode {
 public:
  SimulatedNode() = default;
  SimulatedNode(const SimulatedNode&) = delete;
  SimulatedNode& operator=(const SimulatedNode&) = delete;
  virtual ~SimulatedNode() = default;

  virtual void start(TimePoint now) = 0;
  virtual void on_frame(const Frame& frame, TimePoint now) = 0;
  virtual void on_time(TimePoint now) = 0;
  [[nodiscard]] virtual std::optional<TimePoint> next_deadline() const = 0;
  [[nodiscard]] virtual NmtState state() const = 0;
  /// Appends the frames that `on_frame` does not ignore.
  virtual void accepted_frames(std::vector<AcceptedFrame>& frames) = 0;

  /// What the application does without a request of the bus: Node::set, Node::emergency and Node::emergency_over.
  [[nodiscard]] virtual AbortCode set(std::uint16_t index, std::uint8_t sub_index,
                                      std::span<const std::uint8_t> bytes) = 0;
  virtual void emergency(std::uint16_t code, ErrorRegister bits) = 0;
  virtual void emergency_over(ErrorRegister bits) = 0;
};

/// The application of a device that has none.
struct NoApplication {};

namespace simulation_detail {

/// Whether a predicate holds for a type among those of a tuple.
template <class Tuple>
struct Given;
template <class... Handlers>
struct Given<std::tuple<Handlers...>> {
  static constexpr bool storage = (storage_detail::is_stored_in<Handlers> || ...);
  static constexpr bool lss = (lss_detail::is_handler<Handlers> || ...);
};

/// The storage and the LSS port that the data sheet of a device promises, where the application does not bring its own,
/// before the handlers of the application.
template <class Device, class Handlers>
[[nodiscard]] auto complete(SimulatedMemory& memory, Handlers handlers) {
  constexpr bool stores = Device::dictionary.has(0x1010, 0) || Device::dictionary.has(0x1011, 0);
  const auto storage = [&memory] {
    if constexpr (stores && !Given<Handlers>::storage) {
      return std::tuple{stored_in(memory.parameters)};
    } else {
      return std::tuple<>{};
    }
  };
  const auto lss = [&memory] {
    if constexpr (requires { Device::lss_options; } && !Given<Handlers>::lss) {
      return std::tuple{configured_by_lss<Device::lss_options>(memory)};
    } else {
      return std::tuple<>{};
    }
  };
  return std::tuple_cat(storage(), lss(), std::move(handlers));
}

/// Whether the handlers of a tuple have the functions of an application class.
template <class Application, class Tuple>
inline constexpr bool has_application = false;
template <class Application, class... Handlers>
inline constexpr bool has_application<Application, std::tuple<Handlers...>> =
    (std::is_same_v<ApplicationAt<Application>, Handlers> || ...);

/// The handlers of an application: those that `handlers()` returns, or the application itself, if it is a class with
/// functions that a node calls. The node on a real bus has the same ones.
template <class Application>
[[nodiscard]] auto handlers_of(Application& application) {
  if constexpr (requires { application.handlers(); }) {
    using Handlers = decltype(application.handlers());
    static_assert(!handler_detail::is_application<Application> || has_application<Application, Handlers>,
                  "application: of a class with handlers(), the node calls the functions of the class itself only if "
                  "application_at(*this) is one of these handlers");
    static_assert(!handler_detail::has_uncalled_tick<Application>());
    return application.handlers();
  } else if constexpr (std::is_same_v<Application, NoApplication>) {
    return std::tuple<>{};
  } else {
    return std::tuple{application_at(application)};
  }
}

template <class Device, class Application>
class NodeOf final : public SimulatedNode {
 public:
  NodeOf(SimulatedBus& bus, SimulatedMemory& memory)
      : node_(make_node<Device>(bus, memory.node_id(), complete<Device>(memory, handlers_of(application_)))) {}

  void start(TimePoint now) override {
    node_.start(now);
    serve_until_ = now + longest_pause;
  }
  void on_frame(const Frame& frame, TimePoint now) override { node_.on_frame(frame, now); }
  void on_time(TimePoint now) override {
    serve_until_ = now + longest_pause;
    node_.on_time(now);
  }
  [[nodiscard]] std::optional<TimePoint> next_deadline() const override {
    const std::optional<TimePoint> of_node = node_.next_deadline();
    return of_node && *of_node < serve_until_ ? of_node : serve_until_;
  }

  [[nodiscard]] NmtState state() const override { return node_.state(); }
  void accepted_frames(std::vector<AcceptedFrame>& frames) override {
    for_each_accepted_frame(node_, [&frames](const AcceptedFrame& frame) { frames.push_back(frame); });
  }

  AbortCode set(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> bytes) override {
    return node_.set(index, sub_index, bytes);
  }
  void emergency(std::uint16_t code, ErrorRegister bits) override { node_.emergency(code, bits); }
  void emergency_over(ErrorRegister bits) override { node_.emergency_over(bits); }

 private:
  using Node = decltype(make_node<Device>(
      std::declval<SimulatedBus&>(), NodeId{},
      complete<Device>(std::declval<SimulatedMemory&>(), handlers_of(std::declval<Application&>()))));

  /// A node has to be served every half hour at least.
  static constexpr Duration longest_pause{1'000'000'000};

  Application application_{};
  Node node_;
  TimePoint serve_until_{};
};

}  // namespace simulation_detail

/// Switches a device on: its node and its application are made, `start` follows.
using MakeSimulatedNode = std::unique_ptr<SimulatedNode> (*)(SimulatedBus& bus, SimulatedMemory& memory);

/// The function that does it for a device that edsc has generated. See host/simulated_device.hpp for `Application`.
template <class Device, class Application = NoApplication>
[[nodiscard]] std::unique_ptr<SimulatedNode> make_simulated_node(SimulatedBus& bus, SimulatedMemory& memory) {
  return std::make_unique<simulation_detail::NodeOf<Device, Application>>(bus, memory);
}

/// One of the devices that a program simulates.
struct SimulatedDevice {
  std::string_view name;  ///< no blanks
  MakeSimulatedNode make;
};

}  // namespace canopen
