#include "host/command_line.hpp"

int main(int argc, char** argv) { return voussoir::host::run_command_line(argc, argv); }
