#include "shared/compare_dictionaries.hpp"

#include <fmt/format.h>

#include "accept/declared_differences.hpp"
#include "monitor/progress_line.hpp"

namespace edsc {

accept::Comparison compare_dictionaries(LiveBus& bus, ConformanceTest& test) {
  ProgressLine progress;
  accept::ComparisonSettings settings;
  settings.node = test.run.dut.node;
  settings.sdo = test.run.dut.sdo;
  settings.progress = [&](std::size_t done, std::size_t of) {
    if (progress.due()) progress.show(fmt::format("object {} of {}", done + 1, of));
  };
  accept::Comparison comparison = accept::compare_dictionary(bus, test.sheet(), test.loaded->sheet, settings);
  accept::apply_deviations(test.deviations.all, comparison);
  return comparison;
}

}  // namespace edsc
