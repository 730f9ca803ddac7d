#include "backend/target.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "backend/c/c_view.hpp"
#include "backend/cpp/cpp_view.hpp"

namespace edsc {
namespace {

constexpr Target rows[] = {
    {"cpp", "C++20 for the runtime of edsc: dictionary, typed objects, PDOs", cpp_view},
    {"c", "a C99 header: indices, types and default values of objects, PDOs as structs", c_view},
};

}  // namespace

std::span<const Target> targets() { return rows; }

const Target& target_of(std::string_view name) {
  const auto* const found = std::ranges::find(rows, name, &Target::name);
  if (found == std::end(rows)) throw std::logic_error{"unknown target " + std::string{name}};
  return *found;
}

const std::vector<Template>& templates_of(const Target& target) { return target_templates(target.name); }

}  // namespace edsc
