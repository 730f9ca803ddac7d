#include "twelve_axes_control.hpp"
#include "run_plant.hpp"

int main(int argc, char** argv) { return run_plant<TwelveAxes>(argc, argv); }
