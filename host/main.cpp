#include "host/process/standard_streams.hpp"
#include "host/program/command_line.hpp"
#include "host/program/failure.hpp"
#include "host/ranks/session.hpp"

int main(int argc, char** argv) {
  voussoir::host::prepare_standard_streams();
  voussoir::host::end_all_failures_by_the_table();
  const voussoir::host::RankSession session;
  return session.serves() ? session.serve() : voussoir::host::run_command_line(argc, argv);
}
