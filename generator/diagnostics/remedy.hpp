/// A change of a file that removes the cause of a finding.
#pragma once

#include <cstdint>
#include <string>

#include "diagnostics/position.hpp"
#include "rules/rule.hpp"

namespace edsc {

/// Only what is certain: the value that edsc uses instead of the one that is written, because a standard or the rest of
/// the file states it.
struct Remedy {
  enum class Kind : std::uint8_t {
    value,   ///< `text` replaces the value at `place`
    key,     ///< the section at `place` gets `key` with the value `text`, or `place` is that of the value it has
    listing  ///< the object described at `place` is added to its object list
  };

  Kind kind = Kind::value;
  RuleId rule;
  Position place;
  std::string key = {};
  std::string text = {};
  std::string reason = {};
};

}  // namespace edsc
