#include "conform/cases/pdo/tested_tpdos.hpp"

#include <fmt/format.h>

namespace edsc::conform {

void expect_none(Dut& dut, const Tpdo& tpdo, const std::vector<SeenFrame>& frames, const std::string& when) {
  dut.expect(frames.empty(), fmt::format("no {} {}", tpdo.name(), when), frames_text(frames), frames);
}

SeenFrame expect_frame(Dut& dut, const Tpdo& tpdo, Dut::Mark since, Duration longest, const std::string& when) {
  const auto seen = dut.wait_for(tpdo.frames(), longest, since);
  dut.expect(seen.has_value(), fmt::format("{} {}", tpdo.name(), when),
             fmt::format("no frame within {} ms", longest.count() / 1000));
  return *seen;
}

bool changes_by_itself(Dut& dut, const Tpdo& tpdo) {
  const std::vector<SeenFrame> frames = dut.collect(tpdo.frames(), 2 * silence);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const bool is_same = frames[i].frame == frames[i - 1].frame;
    dut.expect(!is_same, fmt::format("no {} without an event", tpdo.name()),
               frame_text(frames[i].frame) + " twice with the same data", std::span{frames}.subspan(i - 1, 2));
  }
  return !frames.empty();
}

void no_stimulus(Dut& dut, const Tpdo& tpdo, bool has_run) {
  const std::string_view what = dut.simulated() ? "stimulus" : "command of --stimulus";
  if (has_run) {
    dut.inconclusive(Condition::stimulus, fmt::format("the {} ran, {} did not change; it must change an object of {}",
                                                      what, objects_text(tpdo.mapping), tpdo.name()));
  }
  dut.inconclusive(
      Condition::stimulus,
      fmt::format("no stimulus changes an object of {} ({}); use --stimulus with a command that changes one",
                  tpdo.name(), objects_text(tpdo.mapping)));
}

std::uint16_t timer_of(const Dut& dut, const Tpdo& tpdo) {
  constexpr std::uint16_t wanted_ms = 100;
  return static_cast<std::uint16_t>(within_limits(dut, tpdo.index, timer_parameter, wanted_ms));
}

}  // namespace edsc::conform
