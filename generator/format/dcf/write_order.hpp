/// The order in which the values of a configuration are written to a node: values that can change only while a service
/// is disabled are written while it is disabled.
#pragma once

#include <cstdint>
#include <vector>

#include "device/device.hpp"

namespace edsc {

/// A value to be written.
struct WriteValue {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::vector<std::uint8_t> bytes;  ///< low byte first
  bool is_last = false;             ///< written after all other values
};

enum class StepKind : std::uint8_t {
  write,       ///< the value
  switch_off,  ///< COB-ID: read it, and write it with the bits that disable it; nothing if it is disabled
  switch_on,   ///< COB-ID: write the value, or the value read before if it is not configured
  clear,       ///< write 0: the number of mapped objects, or a period
  restore,     ///< write the value that `clear` read, or `bytes` if that is greater
};

struct WriteStep {
  StepKind kind = StepKind::write;
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  const WriteValue* value = nullptr;  ///< null if the entry is not configured
  std::vector<std::uint8_t> bytes;    ///< to write; of `switch_on` empty if the entry is not configured
  std::uint32_t off_set = 0;          ///< COB-ID: bits that are set, and cleared, while it is disabled
  std::uint32_t off_cleared = 0;
  unsigned group = 0;  ///< if a step fails, the other steps of its group are skipped; 0: no group
};

/// Which values must be written if those with `differs` are different in the node: these, the complete mapping if part
/// of it differs, and the SYNC period with the SYNC counter overflow.
[[nodiscard]] std::vector<bool> with_dependent_values(const std::vector<WriteValue>& values,
                                                      const std::vector<bool>& differs);

/// The steps, in order: communication parameters, application, then for each PDO: COB-ID disabled, number of mapped
/// objects 0, mapping, number, other parameters, COB-ID; then the last values. `values` must outlive them; `device` may
/// be null.
[[nodiscard]] std::vector<WriteStep> order_writes(const std::vector<WriteValue>& values, const Device* device);

}  // namespace edsc
