/// A device of a master on a host, with its generated types.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/bytes.hpp"
#include "canopen/base/result.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/host/blocking_sdo.hpp"
#include "canopen/host/master_transfers.hpp"
#include "canopen/od/object.hpp"
#include "canopen/pdo/pdo_list.hpp"
#include "canopen/pdo/remapping.hpp"

namespace canopen {

template <BlockingBus BusType>
class Master;

namespace master_detail {

/// Number of the only PDO in a list with a layout; 0: none or several have it.
template <class Layout, class List>
inline constexpr std::uint16_t number_in = 0;
template <class Layout, class... Pdos>
inline constexpr std::uint16_t number_in<Layout, PdoList<Pdos...>> =
    (unsigned{std::is_base_of_v<Layout, Pdos>} + ... + 0u) == 1
        ? static_cast<std::uint16_t>((unsigned{std::is_base_of_v<Layout, Pdos> ? Pdos::number : std::uint16_t{0}} +
                                      ... + 0u))
        : std::uint16_t{0};

}  // namespace master_detail

/// A device on the bus, with its generated types: its objects by SDO, its PDOs by their layouts.
template <class Device, BlockingBus BusType>
class MasterRemote : public BlockingObjects<Device, Master<BusType>> {
  using Objects = BlockingObjects<Device, Master<BusType>>;

 public:
  using Objects::node_id, Objects::Objects;

  /// These wait for the result while the master goes on.
  using Objects::read, Objects::write;

  /// Starts to read an object and returns; `done(result)` is called from `poll` with a Result of its type, for a DOMAIN
  /// of its bytes, exactly once unless this call is rejected: 060A 0023h, too many requests are pending.
  template <DictionaryObject Object, class Done>
  Result<void> read(Object, Done done) {
    if constexpr (!remote_detail::can_be_read<Object, Device>()) {
      return AbortCode::general;
    } else if constexpr (NumberObject<Object>) {
      auto& transfer = master().transfers_.add(
          node_id(), Object::index, Object::sub_index,
          [done = std::move(done)](MasterTransfers::Transfer& ended) mutable {
            const std::size_t size = ended.result == ok ? ended.size : 0;
            done(number_from<Object>({ended.result, std::span{ended.bytes}.first(size), ended.size_known}));
          });
      return master().begin(transfer, MasterTransfers::upload(transfer, sizeof(std::uint64_t)));
    } else {
      return master().begin_upload(node_id(), Object::index, Object::sub_index,
                                   [done = std::move(done)](const Result<std::vector<std::uint8_t>>& bytes) mutable {
                                     if constexpr (StringObject<Object>) {
                                       done(text_from<Object, Device>(bytes));
                                     } else {
                                       done(bytes);
                                     }
                                   });
    }
  }
  /// Starts to write an object and returns; `done(result)` is called from `poll` with a Result<void>, exactly once
  /// unless this call is rejected: 060A 0023h, or a value outside the limits.
  template <DictionaryObject Object, class ValueType, class Done>
  requires remote_detail::WrittenTo<std::decay_t<const ValueType&>, Object, Device>
  [[nodiscard]] Result<void> write(Object object, const ValueType& value, Done done) {
    Begins begins{master(), std::move(done)};
    return BlockingObjects<Device, Begins>{begins, node_id()}.write(object, value);
  }
  template <DictionaryObject Object, class ValueType, class Done>
  remote_detail::NotWritten write(Object, const ValueType&, Done) {
    static_cast<void>(remote_detail::can_be_written<Object, Device, std::decay_t<const ValueType&>>());
    return {};
  }

  /// Calls the handler from now on with the values of each TPDO with this layout: `handler(values...)`. Its COB-ID is
  /// read from the node, again after each boot-up, and updated when it is written through the master. 0800 0022h: the
  /// PDO is not valid; the handler is discarded.
  template <class Layout, class Function>
  Result<void> on_pdo(Function handler) {
    return on_pdo_at<Layout>(tpdo_index<Layout>(), std::move(handler));
  }
  /// The same for TPDO `Number`, which `map` has given this layout.
  template <std::uint16_t Number, class Layout, class Function>
  Result<void> on_pdo(Function handler) {
    return on_pdo_at<Layout>(Remapping<Device, Number, Layout>::communication, std::move(handler));
  }

  /// Maps these objects into TPDO or RPDO `Number` of the device: `map<2, canopen::Tpdo<od::x, od::y>>()`. The PDO is
  /// not valid while its mapping changes, and stays so after an abort code.
  template <std::uint16_t Number, class Layout>
  Result<void> map() {
    using New = Remapping<Device, Number, Layout>;
    const auto cob_id = master().upload(node_id(), New::communication, pdo_parameter::cob_id);
    if (!cob_id) return cob_id.abort_code();
    if (cob_id->size() != 4) return AbortCode::length_mismatch;
    const auto write = [this](std::uint16_t index, std::uint8_t sub_index, std::uint32_t value, std::size_t size) {
      std::array<std::uint8_t, sizeof value> bytes{};
      std::memcpy(bytes.data(), &value, sizeof value);
      return master().download(node_id(), index, sub_index, std::span{bytes}.first(size)).abort_code();
    };
    return New::map_valid(little_endian_number(*cob_id), write);
  }

  /// Sends an RPDO with these values. 060A 0023h: the bus has no room; 0609 0031h, 0609 0032h: a value is outside the
  /// limits of its object, and nothing is sent.
  template <class Layout, class... Values>
  Result<void> send(const Values&... values) {
    static_assert(sizeof...(Values) == Layout::entries, "send: one value for each entry of the RPDO");
    constexpr std::uint16_t number = master_detail::number_in<Layout, typename Device::Rpdos>;
    static_assert(number != 0, "no RPDO of this device has this layout, or several have");
    const Result<std::uint32_t> cob_id =
        master().pdo_cob_id(node_id(), static_cast<std::uint16_t>(rpdo_indices.communication + number - 1));
    if (!cob_id) return cob_id.abort_code();
    if (const AbortCode code = checked<Layout>(std::make_index_sequence<Layout::entries>{}, values...); code != ok)
      return code;
    Frame frame = frame_of(*cob_id);
    pack<Layout>(frame, std::make_index_sequence<Layout::entries>{}, values...);
    return master().bus_.send(frame) ? ok : AbortCode::no_resource;
  }

  /// Requests a TPDO with a remote frame. 060A 0023h: the bus has no room.
  template <class Layout>
  Result<void> request() {
    const Result<std::uint32_t> cob_id = master().pdo_cob_id(node_id(), tpdo_index<Layout>());
    if (!cob_id) return cob_id.abort_code();
    Frame frame = frame_of(*cob_id);
    frame.remote = true;
    frame.size = Layout::size;
    return master().bus_.send(frame) ? ok : AbortCode::no_resource;
  }

 private:
  /// The first abort code of the values of a layout.
  template <class Layout, std::size_t... Position, class... Values>
  [[nodiscard]] static AbortCode checked(std::index_sequence<Position...>, const Values&... values) {
    AbortCode code = ok;
    static_cast<void>(((code = checked_value<typename Layout::template Entry<Position>>(values), code == ok) && ...));
    return code;
  }
  /// The value of a constant with a unit, which is a part of its type.
  template <class Object, class ValueType>
  [[nodiscard]] static constexpr typename Object::type constant() {
    constexpr CheckedValue<Object> checked{ValueType{}};
    return checked.value();
  }
  template <class Object, class ValueType>
  [[nodiscard]] static AbortCode checked_value([[maybe_unused]] const ValueType& value) {
    if constexpr (is_constant<ValueType>) {
      static_cast<void>(constant<Object, ValueType>());  // checked by the compiler
    } else if constexpr (NumberObject<Object> && std::is_arithmetic_v<RawOf<typename Object::type>>) {
      static_assert(remote_detail::has_the_type_of<Object, ValueType>,
                    "send: this value is not of the type of the object");
      if constexpr (remote_detail::has_the_type_of<Object, ValueType>) return remote_detail::check<Object>(value);
    } else if constexpr (remote_detail::is_text_for<Object, ValueType>) {
      return Object::type::from(value).abort_code();
    }
    return ok;
  }
  template <class Object, class ValueType>
  [[nodiscard]] static typename Object::type converted([[maybe_unused]] const ValueType& value) {
    if constexpr (is_constant<ValueType>) {
      return constant<Object, ValueType>();
    } else if constexpr (remote_detail::is_text_for<Object, ValueType>) {
      return Object::type::truncated(value);
    } else {
      return remote_detail::converted<Object>(value);
    }
  }
  template <class Layout, std::size_t... Position, class... Values>
  static void pack(Frame& frame, std::index_sequence<Position...>, const Values&... values) {
    frame.size = Layout::size;
    Layout::pack_into_words(frame.data, converted<typename Layout::template Entry<Position>>(values)...);
  }

  template <class Layout>
  [[nodiscard]] static constexpr std::uint16_t tpdo_index() {
    constexpr std::uint16_t number = master_detail::number_in<Layout, typename Device::Tpdos>;
    static_assert(number != 0, "no TPDO of this device has this layout, or several have");
    return static_cast<std::uint16_t>(tpdo_indices.communication + number - 1);
  }
  [[nodiscard]] static Frame frame_of(std::uint32_t cob_id) {
    Frame frame{};
    frame.extended = (cob_id & 0x2000'0000) != 0;
    frame.id = cob_id & 0x1FFF'FFFF;
    return frame;
  }
  template <class Layout, class Function>
  Result<void> on_pdo_at(std::uint16_t index, Function handler) {
    const Result<std::uint32_t> cob_id = master().pdo_cob_id(node_id(), index);
    if (!cob_id) return cob_id.abort_code();
    master().pdos_.push_back(
        {node_id().value(), index, *cob_id, Layout::size,
         [handler = std::move(handler)](const Frame& frame) mutable { std::apply(handler, Layout::unpack(frame)); }});
    return ok;
  }
  /// Starts a download in place of waiting for it.
  struct Begins {
    Master<BusType>& master;
    std::function<void(Result<void>)> done;
    Result<void> download(NodeId node_id, std::uint16_t index, std::uint8_t sub_index,
                          std::span<const std::uint8_t> bytes) {
      return master.begin_download(node_id, index, sub_index, bytes, std::move(done));
    }
  };
  [[nodiscard]] Master<BusType>& master() const { return this->sdo(); }
};

}  // namespace canopen
