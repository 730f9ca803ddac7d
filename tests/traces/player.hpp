/// Plays a trace against the nodes that it names.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "station.hpp"
#include "trace.hpp"

namespace trace {

struct Failure {
  std::size_t line;
  std::string message;
};

/// All places where the nodes do something else than the trace. `stations` are those of Trace::nodes, in that order.
[[nodiscard]] std::vector<Failure> play(const Trace& trace, const std::vector<std::unique_ptr<Station>>& stations);

}  // namespace trace
