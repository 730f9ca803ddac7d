#include "can_2024c.hpp"
#include "shared/run_node.hpp"

int main(int argc, char** argv) { return nodes::run_node<Can2024c>(argc, argv); }
