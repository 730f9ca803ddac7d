#include "four_modules_control.hpp"
#include "run_plant.hpp"

int main(int argc, char** argv) { return run_plant<FourModules>(argc, argv); }
