// The work of all ranks but the first: such a rank owns a part of the pool and answers commands.
#include <Kokkos_Core.hpp>
#include <chrono>
#include <csignal>
#include <exception>
#include <new>
#include <optional>
#include <stdexcept>

#include "host/material/rve_pool.hpp"
#include "host/process/build_info.hpp"
#include "host/process/exit_code.hpp"
#include "host/process/resources.hpp"
#include "host/process/threads.hpp"
#include "host/ranks/messages.hpp"
#include "host/ranks/session.hpp"
#include "kernels/isa/choose_lanes.hpp"

namespace voussoir::host {
namespace {

class Service {
 public:
  /// Obeys a command and adds the answer to `reply`. Throws where the command fails.
  void obey(Command command, ByteReader& read, ByteWriter& reply) {
    switch (command) {
      case Command::start:
        return start(read, reply);
      case Command::make:
        return make(read, reply);
      case Command::begin_increment:
        return pool().begin_increment();
      case Command::evaluate:
        return evaluate(read, reply);
      case Command::commit:
        return pool().commit();
      case Command::fields:
        return fields(reply);
      case Command::states:
        return states(read, reply);
      case Command::retire:
        return pool().retire(read.list<std::size_t>());
      case Command::set_states:
        return set_states(read, reply);
      case Command::forget:
        pool_.reset();
        return reply.value(peak_memory());
      case Command::quit:
        return;
    }
    throw std::logic_error("this rank does not know the command");
  }

 private:
  RvePool& pool() {
    if (!pool_) throw std::logic_error("this rank has no pool for the command");
    return *pool_;
  }

  void start(ByteReader& read, ByteWriter& reply) {
    const std::string theirs = read.text();
    if (theirs != build_revision) {
      throw std::runtime_error("the program there is another build (" + std::string(build_revision) + " instead of " +
                               theirs + ")");
    }
    const int threads = read.value<int>();
    if (!kokkos_) kokkos_.emplace(threads);
    std::string lanes, fault;
    try {
      lanes = kernels::name_of(kernels::choose_lanes(kernels::find_instruction_set(read.text())).lanes->isa);
    } catch (const kernels::UnusableLanes& error) {  // wrong input here is wrong input of the run
      fault = error.what();
    }
    reply.list(host_name());
    reply.value(Kokkos::DefaultHostExecutionSpace().concurrency());
    reply.list(lanes);
    reply.list(fault);
  }

  void make(ByteReader& read, ByteWriter& reply) {
    pool_.reset();
    const PackingMix mix = read_mix(read);
    PoolOptions options;
    transfer_options(read, options);
    options.local_rank = local_rank();
    pool_.emplace(mix, options);
    reply.list(pool().committed_reports());
    reply.list(pool().device_sentence());
  }

  void evaluate(ByteReader& read, ByteWriter& reply) {
    const auto since = std::chrono::steady_clock::now();
    const bool with_tangents = read.value<bool>();
    const auto flat = read.list<double>();
    std::vector<fem::Gradient> gradients(flat.size() / 4);
    for (std::size_t k = 0; k < gradients.size(); ++k)
      gradients[k] = Eigen::Map<const fem::Gradient>(flat.data() + 4 * k);
    const kernels::Work work = pool().advance(gradients, with_tangents);
    reply.value(std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count());
    reply.value(work);
    reply.value(pool().deferral_error());
    reply.list(pool().trial_reports());
  }

  void fields(ByteWriter& reply) {
    const std::vector<fem::PointField> all = pool().fields();
    reply.value(static_cast<std::uint64_t>(all.size()));
    for (const fem::PointField& field : all) {
      reply.list(field.name);
      reply.list(field.unit);
      reply.value(field.components);
      reply.list(field.values);
    }
  }

  void states(ByteReader& read, ByteWriter& reply) {
    const auto first = read.value<std::uint64_t>();
    const auto n = read.value<std::uint64_t>();
    for (const std::vector<std::byte>& record : pool().records(first, n)) reply.list(record);
  }

  void set_states(ByteReader& read, ByteWriter& reply) {
    std::vector<std::size_t> rves;
    std::vector<StateRecord> records;
    for (auto k = read.value<std::uint64_t>(); !read.at_end(); ++k) {
      rves.push_back(k);
      records.push_back(read.take(read.value<std::uint64_t>()));
    }
    pool().set_states(rves, records);
    reply.list(pool().committed_reports());
  }

  std::optional<KokkosSession> kokkos_;
  std::optional<RvePool> pool_;
};

Message answer(Service& service, const Message& message) {
  ByteReader read(message);
  Message reply{std::byte{1}};
  std::string complaint;
  try {
    ByteWriter write(reply);
    service.obey(read.value<Command>(), read, write);
    return reply;
  } catch (const std::bad_alloc&) {
    complaint = "out of memory";
  } catch (const std::exception& error) {
    complaint = error.what();
  }
  Message refusal{std::byte{0}};
  ByteWriter(refusal).list("rank " + std::to_string(this_rank()) + " on " + host_name() + ": " + complaint);
  return refusal;
}

}  // namespace

int RankSession::serve() const {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) std::signal(signal, SIG_IGN);
  try {
    Service service;
    for (;;) {
      const Message message = receive_message(0);
      if (message.front() == static_cast<std::byte>(Command::quit)) return exit_code(Outcome::done);
      send_message(0, answer(service, message));
    }
  } catch (const std::exception& error) {
    abort_ranks(exit_code(Outcome::machine_failure), error.what());
  }
}

}  // namespace voussoir::host
