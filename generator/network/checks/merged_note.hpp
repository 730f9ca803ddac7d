/// Notes of one rule as one finding, wherever they are.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// Of one cause in the files of several nodes, as the PDOs that the nodes have by default and the network does not use.
class MergedNote {
 public:
  void add(NoteRule rule, const Position& position, std::string message) {
    if (finding_) {
      finding_->add_place(position, std::move(message));
    } else {
      finding_.emplace(Diagnostic{Severity::note, rule, position, std::move(message), {}, {}});
    }
  }

  void report(Diagnostics& diagnostics) {
    if (finding_) diagnostics.report(*std::move(finding_));
  }

 private:
  std::optional<Diagnostic> finding_;
};

}  // namespace edsc
