/// Replays a trace with the nodes that it names.
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

/// Returns each difference between the nodes and the trace. `stations` are those of Trace::nodes, in that order.
[[nodiscard]] std::vector<Failure> play(const Trace& trace, const std::vector<std::unique_ptr<Station>>& stations);

}  // namespace trace
