/// PDOs whose mapping can be changed, the procedure for it (CiA 301, 7.5.2.36), and the objects that they can map.
#pragma once

#include <canopen/can/cob_id.hpp>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "conform/cases/pdo/pdo_mapping.hpp"

namespace edsc::conform {

/// A PDO whose mapping can be changed according to the EDS, and the procedure. `restore` restores what was found.
class Remapping {
 public:
  Remapping(Dut& dut, const Pdo& pdo, std::uint8_t capacity);

  [[nodiscard]] const Pdo& pdo() const { return pdo_; }
  [[nodiscard]] std::uint8_t capacity() const { return capacity_; }
  [[nodiscard]] std::uint8_t found_count() const { return count_; }
  [[nodiscard]] bool is_valid() const { return canopen::CobId{cob_id_}.valid(); }
  /// Whether the CAN-ID can be used, so that the PDO is valid or can be enabled.
  [[nodiscard]] bool can_be_valid() const {
    return canopen::may_be_written(canopen::CobId{cob_id_ & ~canopen::CobId::invalid_bit}, true, true);
  }
  [[nodiscard]] std::vector<MappingValue> found() const;
  [[nodiscard]] std::string entry_name(std::uint8_t position) const { return label(mapping_, position); }

  // ---- the five steps ----

  void disable() { dut_.write(communication_, cob_id_parameter, cob_id_ | canopen::CobId::invalid_bit); }
  void clear() { dut_.write(mapping_, 0, 0); }
  [[nodiscard]] SdoOutcome map(std::uint8_t position, const MappingValue& mapped) {
    return dut_.download(mapping_, position, mapped.value());
  }
  [[nodiscard]] SdoOutcome set_count(std::uint8_t count) { return dut_.download(mapping_, 0, count); }
  void enable() { dut_.write(communication_, cob_id_parameter, cob_id_ & ~canopen::CobId::invalid_bit); }

  void begin() {
    disable();
    clear();
  }

  /// Steps 1 to 4. The device must accept them, and reads must return the new mapping.
  void remap(const std::vector<MappingValue>& mapping);
  void restore();

  [[nodiscard]] std::string mapping_text(std::uint8_t position, const MappingValue& mapped) const;
  void expect_unchanged(std::uint8_t sub_index, std::uint64_t value);

 private:
  Dut& dut_;
  const Pdo& pdo_;
  std::uint16_t communication_, mapping_;
  std::uint8_t capacity_;
  std::uint32_t cob_id_;
  std::uint8_t count_;
  std::vector<std::uint64_t> found_;  ///< sub-indices 1 to capacity
};

/// PDOs whose mapping can be changed and restored. Not applicable without one.
[[nodiscard]] std::vector<Remapping> remappings(Dut& dut, std::initializer_list<PdoDirection> directions);
[[nodiscard]] std::vector<Remapping> all_remappings(Dut& dut);

/// The entries of the EDS that satisfy a condition and have a length that the device can map.
[[nodiscard]] std::vector<MappingValue> objects_where(const Dut& dut,
                                                      const std::function<bool(const Entry&)>& condition);
/// The objects that a PDO of this direction can map, except constants.
[[nodiscard]] std::vector<MappingValue> mappable_objects(const Dut& dut, PdoDirection direction);

/// A mapping that differs from the present one, of objects that the EDS allows: the present ones in reverse order, or
/// one that is not yet mapped.
[[nodiscard]] std::vector<MappingValue> new_mapping(const Dut& dut, const Remapping& remapping);

}  // namespace edsc::conform
