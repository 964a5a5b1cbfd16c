#include "host/program/command_line.hpp"
#include "host/ranks/session.hpp"

int main(int argc, char** argv) {
  const voussoir::host::RankSession session;
  return session.serves() ? session.serve() : voussoir::host::run_command_line(argc, argv);
}
