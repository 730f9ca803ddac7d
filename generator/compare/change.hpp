/// The changes between two versions of a device, and what each breaks.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compare/change_rules.hpp"
#include "diagnostics/position.hpp"

namespace edsc {

/// One difference. On a side without the entry, the position is the whole file.
struct Change {
  ChangeRule rule;
  std::string entry;      ///< `6040h:00`, `1018h`, `TPDO 1`, `EMCY 2310h` or `device`
  std::string name;       ///< of the entry; may be empty
  std::string old_value;  ///< empty if there is none
  std::string new_value;
  Position old_position;
  Position new_position;
  Breaks breaks;  ///< those of the rule, unless the comparison knows better

  [[nodiscard]] bool is_breaking() const { return breaks.any(); }
};

/// The property, its old and new value, and the consequence, in one sentence.
[[nodiscard]] std::string message_of(const Change& change);

/// The audience of a comparison.
enum class Audience : std::uint8_t {
  all,
  wire,    ///< masters and PDO partners: devices on the same bus
  source,  ///< code that is compiled against the generated headers
};

/// Collects changes; the rule states what each breaks, unless the caller does.
class Changes {
 public:
  Change& add(ChangeRule rule, std::string entry, std::string name, const Position& old_position,
              const Position& new_position);

  /// Drops the changes that break only other audiences; the others then break only this audience.
  void keep(Audience audience);
  /// Adds the changes of another device.
  void append(Changes more);

  [[nodiscard]] const std::vector<Change>& all() const { return all_; }
  [[nodiscard]] std::size_t breaking() const;

 private:
  std::vector<Change> all_;
};

}  // namespace edsc
