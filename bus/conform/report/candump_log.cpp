#include "conform/report/candump_log.hpp"

#include "server/candump_line.hpp"

namespace edsc::conform {

std::string candump_log(const RunReport& run) {
  constexpr std::uint64_t second = 1'000'000;
  const std::string interface = interface_of(run.bus);
  std::string log;
  for (const SeenFrame& seen : run.frames) {
    log += candump_line(seen.frame, interface,
                        {static_cast<std::int64_t>(seen.at / second), static_cast<std::int32_t>(seen.at % second)});
    log += '\n';
  }
  return log;
}

}  // namespace edsc::conform
