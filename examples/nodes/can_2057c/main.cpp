#include "can_2057c.hpp"
#include "shared/run_node.hpp"

int main(int argc, char** argv) { return nodes::run_node<Can2057c>(argc, argv); }
