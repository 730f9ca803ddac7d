#include "ezd_1136.hpp"
#include "shared/run_node.hpp"

int main(int argc, char** argv) { return nodes::run_node<ezd_1136_node::Ezd1136>(argc, argv); }
