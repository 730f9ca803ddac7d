/// An encoder of CiA 406 that moves, whatever its EDS.
#pragma once

#include <memory>

#include "device/behaviour.hpp"
#include "device/profile_behaviour.hpp"

namespace edsc {

/// It moves to and fro over one turn of 6001h steps, 4096 if the device does not have it, in 10 s. The position is
/// 6004h or 6020h, the speed 6030h in steps per second. A write of 6003h or 6010h sets the present position
/// to this value; the cyclic timer 6200h and the event timer of TPDO 1 are equal.
[[nodiscard]] std::unique_ptr<ProfileBehaviour> make_simulated_encoder(BehaviourTarget& target);

}  // namespace edsc
