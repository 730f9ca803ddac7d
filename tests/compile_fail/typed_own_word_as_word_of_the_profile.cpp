// expect: could not convert|no known conversion
// expect: typed_drive::meaning::statusword .*canopen::cia402::Statusword
// A drive whose options name other bits has a word of its own, which a function for CiA 402 does not accept.
#include <canopen/node.hpp>
#include <canopen/sdo/remote_node.hpp>

#include <cia402_drive/device.hpp>
#include <typed_drive/device.hpp>
#include "support/omitting.hpp"

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

bool is_faulty(canopen::cia402::Statusword status) { return status.fault(); }

bool use([[maybe_unused]] bench::NodeOf<typed_drive::Device, Bus>& own,
         [[maybe_unused]] bench::NodeOf<cia402_drive::Device, Bus>& of_profile) {
#ifdef GOOD
  return is_faulty(of_profile.get(cia402_drive::od::statusword{}));
#else
  return is_faulty(own.get(typed_drive::od::statusword{}));
#endif
}
