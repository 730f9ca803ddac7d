#include "cpc_tc1.hpp"
#include "shared/run_node.hpp"

int main(int argc, char** argv) { return nodes::run_node<cpc_tc1_node::CpcTc1>(argc, argv); }
