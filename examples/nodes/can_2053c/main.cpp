#include "can_2053c.hpp"
#include "shared/run_node.hpp"

int main(int argc, char** argv) { return nodes::run_node<Can2053c>(argc, argv); }
