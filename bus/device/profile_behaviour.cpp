#include "device/profile_behaviour.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>

#include "device/simulated_drive.hpp"
#include "device/simulated_encoder.hpp"

namespace edsc {
namespace {

struct ProfileRow {
  std::uint16_t profile;
  std::unique_ptr<ProfileBehaviour> (*make)(BehaviourTarget&);
};
constexpr ProfileRow rows[] = {{402, make_simulated_drive}, {406, make_simulated_encoder}};

const ProfileRow* row_of(std::uint16_t profile) {
  const auto* const row = std::ranges::find(rows, profile, &ProfileRow::profile);
  return row != std::end(rows) ? row : nullptr;
}

}  // namespace

bool has_profile_behaviour(std::uint16_t profile) { return row_of(profile) != nullptr; }

std::unique_ptr<ProfileBehaviour> make_profile_behaviour(std::uint16_t profile, BehaviourTarget& target) {
  const ProfileRow* const row = row_of(profile);
  return row != nullptr ? row->make(target) : nullptr;
}

}  // namespace edsc
