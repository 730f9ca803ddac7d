#include "shared/left_out_text.hpp"

#include <fmt/format.h>

#include "backend/cpp/views.hpp"
#include "diagnostics/place.hpp"
#include "text/printable.hpp"

namespace edsc {

std::vector<LeftOut> all_left_out(const LoadedDevice& loaded) {
  std::vector<LeftOut> left_out = find_left_out(loaded.sheet, *loaded.device);
  for (const Pdo& pdo : loaded.device->pdos) {
    if (!pdo.broken && has_wrong_cob_id(pdo)) left_out.push_back({pdo.position, pdo_label(pdo)});
  }
  return left_out;
}

std::string left_out_text(const std::vector<LeftOut>& left_out) {
  std::string text;
  for (const LeftOut& one : left_out) {
    const Place place = place_of(one.position);
    text +=
        fmt::format("{}:{}:{}: skipped: {}\n", printable(place.file), place.line, place.column, printable(one.what));
  }
  return text;
}

}  // namespace edsc
