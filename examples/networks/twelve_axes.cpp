#include "run_plant.hpp"
#include "twelve_axes_control.hpp"

int main(int argc, char** argv) { return run_plant<TwelveAxes>(argc, argv); }
