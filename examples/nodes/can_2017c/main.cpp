#include "can_2017c.hpp"
#include "shared/run_node.hpp"

int main(int argc, char** argv) { return nodes::run_node<Can2017c>(argc, argv); }
