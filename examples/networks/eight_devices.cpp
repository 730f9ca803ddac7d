#include "eight_devices_control.hpp"
#include "run_plant.hpp"

int main(int argc, char** argv) { return run_plant<EightDevices>(argc, argv); }
