/// A node of some device behind one interface, for programs that simulate several devices: a source that includes one
/// device and this header compiles the node alone, without the bus and the protocol of simulated_device.hpp. Host
/// side.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "canopen/host/memory_storage.hpp"
#include "canopen/lss/lss_handler.hpp"
#include "canopen/node.hpp"
#include "canopen/node/accepted_frames.hpp"
#include "canopen/node/composition.hpp"
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

  /// Returns which parts its composition omits, as words of the protocol in simulation_codec.hpp, each after a
  /// blank: `without=lss`, `without=storage`, `without=INDEX:SUB` for a DOMAIN; `composition=edsc`: it has no
  /// application, and all parts that its EDS promises.
  [[nodiscard]] virtual std::string composition() const = 0;
};

/// The application of a device that has none: its composition is made by edsc.
struct NoApplication {};

namespace simulation_detail {

/// Memory for each DOMAIN of a list. What can be read has a value of 16 bytes.
template <class Domains>
struct DomainMemory;
template <class... Os>
struct DomainMemory<ObjectList<Os...>> {
  std::array<std::array<std::uint8_t, 1024>, sizeof...(Os)> bytes{};

  [[nodiscard]] auto parts() {
    return [this]<std::size_t... Position>(std::index_sequence<Position...>) {
      return std::tuple{bound_to<Os>(bytes[Position], readable(Os::access) ? 16 : 0)...};
    }
    (std::index_sequence_for<Os...>{});
  }
};

/// What the hardware of a device would provide to a node with these other parts: storage, LSS port and the memory of
/// DOMAINs, as far as the EDS promises them, and they are neither there nor omitted.
template <class Device, class... Parts>
struct Hardware {
  using Domains = composition_detail::MissingDomains<Device, Parts...>;
  DomainMemory<Domains> domains{};

  [[nodiscard]] auto ports(SimulatedMemory& memory) {
    return std::tuple_cat(storage(memory), lss(memory), domains.parts());
  }

 private:
  [[nodiscard]] static auto storage([[maybe_unused]] SimulatedMemory& memory) {
    if constexpr (composition_detail::is_missing<Device, part::storage, Parts...>) {
      return std::tuple{stored_in(memory.parameters)};
    } else {
      return std::tuple<>{};
    }
  }
  [[nodiscard]] static auto lss([[maybe_unused]] SimulatedMemory& memory) {
    if constexpr (composition_detail::is_missing<Device, part::lss, Parts...>) {
      return std::tuple{configured_by_lss(memory)};
    } else {
      return std::tuple<>{};
    }
  }
};

/// Whether the handlers of a tuple have the functions of an application class.
template <class Application, class Tuple>
inline constexpr bool has_application = false;
template <class Application, class... Handlers>
inline constexpr bool has_application<Application, std::tuple<Handlers...>> =
    (std::is_same_v<ApplicationAt<Application>, Handlers> || ...);

/// A node of a composition on simulated hardware.
template <class Parts>
class ComposedNode;
template <class Device, class... Parts>
class ComposedNode<Composition<Device, Parts...>> {
  using Hardware = simulation_detail::Hardware<Device, typename composition_detail::Composed<Parts>::type...>;
  Hardware hardware_{};

 public:
  [[nodiscard]] auto make_node(SimulatedBus& bus, SimulatedMemory& memory) {
    return std::apply(
        [&](auto... port) {
          return canopen::make_node<canopen::Composition<Device, Parts...>>(bus, memory.node_id(), port...);
        },
        hardware_.ports(memory));
  }
};

/// A node with the handlers that `handlers()` of an application returns.
template <class Device, class Application>
class WithHandlers {
  template <class Tuple>
  struct HardwareFor;
  template <class... Handlers>
  struct HardwareFor<std::tuple<Handlers...>> : Hardware<Device, Handlers...> {};

  using Handlers = decltype(std::declval<Application&>().handlers());
  static_assert(!handler_detail::is_application<Application> || has_application<Application, Handlers>,
                "application: of a class with handlers(), the node calls the functions of the class itself only if "
                "application_at(*this) is one of these handlers");
  static_assert(decltype(handler_detail::check_tick<Application>())::type::is_good);

  Application application_{};
  HardwareFor<Handlers> hardware_{};

 public:
  [[nodiscard]] auto make_node(SimulatedBus& bus, SimulatedMemory& memory) {
    return canopen::make_node<Device>(bus, memory.node_id(),
                                      std::tuple_cat(hardware_.ports(memory), application_.handlers()));
  }
};

/// The parts of a device that its program has: a composition, an application, or nothing, so that edsc makes them.
template <class Device, class Application>
struct PartsOf {
  using type = ComposedNode<Composition<Device, Application>>;
};
template <class Device>
struct PartsOf<Device, NoApplication> {
  using type = ComposedNode<Composition<Device>>;
};
template <class Device, class Application>
requires requires(Application& application) { application.handlers(); }
struct PartsOf<Device, Application> {
  using type = WithHandlers<Device, Application>;
};
template <class Device, class... Parts>
struct PartsOf<Device, Composition<Device, Parts...>> {
  using type = ComposedNode<Composition<Device, Parts...>>;
};

/// `without=NAME` for each part that a composition omits, after blanks: `without=lss without=2030:00`.
template <class Part>
void append_omitted(std::string& words) {
  if constexpr (DictionaryObject<Part>) {
    std::array<char, 24> text;
    std::snprintf(text.data(), text.size(), " without=%04X:%02X", unsigned{Part::index}, unsigned{Part::sub_index});
    words += text.data();
  } else {
    words.append(" without=").append(Part::name);
  }
}
template <class Part>
struct Omitted {
  static void append(std::string&) {}
};
template <class... Parts>
struct Omitted<without<Parts...>> {
  static void append(std::string& words) { (append_omitted<Parts>(words), ...); }
};
template <class Application>
struct OmittedBy {
  static void append(std::string&) {}
};
template <>
struct OmittedBy<NoApplication> {
  static void append(std::string& words) { words += " composition=edsc"; }
};
template <class Device, class... Parts>
struct OmittedBy<Composition<Device, Parts...>> {
  static void append(std::string& words) { (Omitted<Parts>::append(words), ...); }
};

template <class Device, class Application>
class NodeOf final : public SimulatedNode {
 public:
  NodeOf(SimulatedBus& bus, SimulatedMemory& memory) : node_(parts_.make_node(bus, memory)) {}

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

  [[nodiscard]] std::string composition() const override {
    std::string words;
    OmittedBy<Application>::append(words);
    return words;
  }

 private:
  using Parts = typename PartsOf<Device, Application>::type;
  /// A node has to be served every half hour at least.
  static constexpr Duration longest_pause{1'000'000'000};

  Parts parts_{};
  decltype(parts_.make_node(std::declval<SimulatedBus&>(), std::declval<SimulatedMemory&>())) node_;
  TimePoint serve_until_{};
};

}  // namespace simulation_detail

/// Switches a device on: its node and its application are made, `start` follows.
using MakeSimulatedNode = std::unique_ptr<SimulatedNode> (*)(SimulatedBus& bus, SimulatedMemory& memory);

/// The function that does it for a device that edsc has generated. `Application`: a Composition of the device, or an
/// application class; simulated_device.hpp describes it.
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
