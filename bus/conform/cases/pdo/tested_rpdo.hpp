/// An RPDO that a case sends to the device, and what SDO then reads from the mapped objects.
#pragma once

#include <canopen/can/frame.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "conform/cases/pdo/pdo_mapping.hpp"

namespace edsc::conform {

/// A valid RPDO with at least one object whose value SDO can read and that does not change by itself. Create it in
/// Pre-operational; it leaves the device there.
class TestedRpdo {
 public:
  /// Prefers an RPDO of type 254 or 255. Not applicable without an RPDO; inconclusive if no value can be compared.
  explicit TestedRpdo(Dut& dut);

  [[nodiscard]] std::string name() const;
  [[nodiscard]] std::uint16_t index() const { return index_; }  ///< 1400h and above
  [[nodiscard]] std::uint32_t cob_id() const { return cob_id_; }
  [[nodiscard]] unsigned size() const;

  /// Sends the RPDO with other values than the present ones, and a SYNC if it is synchronous.
  void send() { send(size()); }
  /// The same with another number of bytes; additional ones are FFh.
  void send(unsigned bytes);
  /// The same without a SYNC, and without time for the device.
  void send_frame(unsigned bytes);
  /// Sends the values that the objects had at first, and a SYNC.
  void send_present();
  /// Sets 1007h to 0: a device with a synchronous window takes a synchronous RPDO only for this time after a SYNC
  /// (CiA 301, 7.5.2.7). Returns whether the device has no window now.
  bool end_sync_window();
  /// Sends a SYNC. Does nothing if the EDS does not have 1005h.
  void send_sync();

  /// Whether the objects have the sent values, according to SDO.
  enum class Applied : std::uint8_t { none, some, all };
  [[nodiscard]] Applied applied();
  /// Fails if an object has its sent value.
  void expect_ignored(const std::string& when);

 private:
  bool use(const Pdo& pdo, bool with_synchronous);

  Dut& dut_;
  const Pdo* pdo_ = nullptr;
  std::uint16_t index_ = 0;
  std::uint32_t cob_id_ = 0;
  bool synchronous_ = false;
  std::optional<canopen::Frame> sync_;  ///< as found: in Stopped its parameters cannot be read
  std::vector<MappingValue> mapping_;
  std::vector<std::uint64_t> present_, other_;
  std::uint64_t compared_ = 0;  ///< mask of the bits whose objects are compared
};

}  // namespace edsc::conform
