#include "plant.hpp"

#include "shared/run_node.hpp"

int main(int argc, char** argv) { return nodes::run_node<Plant>(argc, argv); }
