/// A drive of CiA 402 with a simulated axis, whatever its EDS.
#pragma once

#include <memory>

#include "device/behaviour.hpp"
#include "device/profile_behaviour.hpp"

namespace edsc {

/// The units are increments, increments per second and increments per second squared. A turn has the increments of
/// 608Fh, 4096 if the device does not have it. A drive without 6060h follows the target that
/// was written last, 607Ah (mode 8) or 60FFh (mode 3). Only the first axis is simulated, without touch probes (60B8h).
[[nodiscard]] std::unique_ptr<ProfileBehaviour> make_simulated_drive(BehaviourTarget& target);

}  // namespace edsc
