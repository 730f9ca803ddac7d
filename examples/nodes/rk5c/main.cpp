#include "rk5c.hpp"

#include "shared/run_node.hpp"

int main(int argc, char** argv) { return nodes::run_node<Rk5c>(argc, argv); }
