#include "cpd.hpp"
#include "shared/run_node.hpp"

int main(int argc, char** argv) { return nodes::run_node<cpd_node::Cpd>(argc, argv); }
