/// The slaves that an NMT master manages, from 1F80h to 1F8Ah (CiA 302-2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "canopen/base/clock.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/nmt/heartbeat_consumer.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object_store.hpp"

namespace canopen {

/// Bits of NMT slave assignment 1F81h. Bits 15..8 are the life time factor, bits 31..16 the guard time in ms.
namespace slave_assignment {
inline constexpr std::uint32_t listed = 0x01;            ///< the node is a slave of this master
inline constexpr std::uint32_t boot = 0x04;              ///< it is started, and booted again after each boot-up message
inline constexpr std::uint32_t mandatory = 0x08;         ///< the network is started only with it
inline constexpr std::uint32_t keep_alive = 0x10;        ///< it is not reset if it is already Operational
inline constexpr std::uint32_t software_version = 0x20;  ///< 1F56h:01 is compared with 1F55h
inline constexpr std::uint32_t software_update = 0x40;   ///< a different software may be updated, by the application
inline constexpr std::uint32_t restore = 0x80;  ///< its default values are restored before it is configured: 1F8Ah
}  // namespace slave_assignment

/// One slave. An identity number of 0 is not compared.
struct NmtSlave {
  NodeId node_id;
  std::uint32_t assignment = 0;       ///< 1F81h
  std::uint32_t device_type = 0;      ///< 1F84h, compared with 1000h
  std::uint32_t vendor_id = 0;        ///< 1F85h, compared with 1018h:01
  std::uint32_t product_code = 0;     ///< 1F86h, compared with 1018h:02
  std::uint32_t revision_number = 0;  ///< 1F87h, compared with 1018h:03
  std::uint32_t serial_number = 0;    ///< 1F88h, compared with 1018h:04
  /// Time in ms without a heartbeat after which the slave is lost, as in 1016h. During boot-up, half of it is written
  /// to 1017h of the slave if that is 0 or too long. 0: guarding with the times of `assignment`.
  std::uint16_t heartbeat_time = 0;
  std::uint8_t restored_parameters = 0;  ///< 1F8Ah, with bit `restore`: sub-index of 1011h that is written; 0: none
  std::uint32_t software = 0;            ///< 1F55h, compared with 1F56h:01 if bit `software_version` is set
  std::uint32_t configuration_date = 0;  ///< 1F26h, compared with 1020h:01: days since 1984-01-01
  std::uint32_t configuration_time = 0;  ///< 1F27h, compared with 1020h:02: ms since midnight
  /// Concise DCF as in 1F22h, written to the slave at each boot-up unless 1020h has the date and the time above, both
  /// other than 0, and the slave has the values. It must outlive the master.
  std::span<const std::uint8_t> concise_dcf{};
  /// Time in ms after which a request without a response has failed; 0: the time of the master.
  std::uint16_t sdo_timeout = 0;
  /// Whether the values of the concise DCF are read back before the slave is started. A slave that rounds a value that
  /// is written is not started until the DCF has the rounded value.
  bool read_back = true;

  [[nodiscard]] constexpr bool has(std::uint32_t bit) const { return (assignment & bit) != 0; }
  [[nodiscard]] constexpr std::uint8_t life_time_factor() const { return static_cast<std::uint8_t>(assignment >> 8); }
  [[nodiscard]] constexpr std::uint16_t guard_time() const { return static_cast<std::uint16_t>(assignment >> 16); }

  /// Whether a loss of the slave is detected by heartbeat; otherwise by guarding; or not at all.
  [[nodiscard]] constexpr bool beats() const { return heartbeat_time != 0; }
  [[nodiscard]] constexpr bool guarded() const { return !beats() && guard_time() != 0; }
  [[nodiscard]] constexpr bool watched() const { return beats() || guarded(); }
};

/// Settings for all slaves.
struct NmtStartUp {
  std::uint32_t bits = 0;  ///< 1F80h
  Duration boot_time{0};   ///< 1F89h: time for the mandatory slaves to boot up, up to half an hour; 0: unlimited

  [[nodiscard]] constexpr bool has(std::uint32_t bit) const { return (bits & bit) != 0; }
};

namespace network_list_detail {

/// Returns an entry of up to 32 bits; 0 if it does not exist.
template <class Device>
[[nodiscard]] std::uint32_t number_or_zero(EntryAccess<Device> entries, std::uint16_t index, std::uint8_t sub_index) {
  const entry::Word word = entries.find(index, sub_index);
  return word > Dictionary::no_sub_index ? entries.number(word) : 0;
}

}  // namespace network_list_detail

/// Reads 1F80h and 1F89h. A boot time above half an hour counts as half an hour.
template <class Device>
[[nodiscard]] NmtStartUp read_start_up(EntryAccess<Device> entries) {
  using network_list_detail::number_or_zero;
  constexpr std::uint32_t half_hour = 30 * 60 * 1000;
  const std::uint32_t milliseconds = number_or_zero(entries, 0x1F89, 0);
  return {number_or_zero(entries, 0x1F80, 0), Duration{(milliseconds < half_hour ? milliseconds : half_hour) * 1000u}};
}

/// Fills `slaves` with the nodes that 1F81h lists, in ascending order, and returns their number. If it is greater than
/// the size of `slaves`, the rest is missing.
template <class Device>
std::size_t read_network_list(EntryAccess<Device> entries, std::span<NmtSlave> slaves) {
  using network_list_detail::number_or_zero;
  std::size_t count = 0;
  for (std::uint8_t node_id = 1; node_id <= 127; ++node_id) {
    const std::uint32_t assignment = number_or_zero(entries, 0x1F81, node_id);
    if ((assignment & slave_assignment::listed) == 0) continue;
    if (count < slaves.size()) {
      NmtSlave& slave = slaves[count];
      slave = {NodeId{node_id}, assignment};
      slave.device_type = number_or_zero(entries, 0x1F84, node_id);
      slave.vendor_id = number_or_zero(entries, 0x1F85, node_id);
      slave.product_code = number_or_zero(entries, 0x1F86, node_id);
      slave.revision_number = number_or_zero(entries, 0x1F87, node_id);
      slave.serial_number = number_or_zero(entries, 0x1F88, node_id);
      slave.software = number_or_zero(entries, 0x1F55, node_id);
      slave.configuration_date = number_or_zero(entries, 0x1F26, node_id);
      slave.configuration_time = number_or_zero(entries, 0x1F27, node_id);
      slave.restored_parameters = static_cast<std::uint8_t>(number_or_zero(entries, 0x1F8A, node_id));
      for (std::size_t i = 1; i <= consumer_heartbeat_times(entries.dictionary()); ++i) {
        const ConsumerHeartbeatTime time{number_or_zero(entries, 0x1016, static_cast<std::uint8_t>(i))};
        if (time.used() && time.node_id() == slave.node_id) slave.heartbeat_time = time.milliseconds();
      }
    }
    ++count;
  }
  return count;
}

}  // namespace canopen
