#include "host/ranks/pool.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <functional>
#include <stdexcept>

#include "host/material/answers.hpp"
#include "host/ranks/messages.hpp"

namespace voussoir::host {
namespace {

constexpr std::size_t records_a_message = 128;  ///< RVEs of 700 grains take 45 kB each

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Sends each rank r > 0 the message `message(r)`, calls `meanwhile` on this rank and returns the replies. Throws the
/// failure of this rank, or else that of the first other rank that failed. All replies are received before the throw,
/// so that the next command meets no old reply.
std::vector<Message> ask(std::size_t others, const std::function<Message(std::size_t)>& message,
                         const std::function<void()>& meanwhile = {}) {
  for (std::size_t r = 1; r <= others; ++r) send_message(static_cast<int>(r), message(r));
  std::exception_ptr failure;
  try {
    if (meanwhile) meanwhile();
  } catch (...) {
    failure = std::current_exception();
  }
  std::vector<Message> replies;
  for (std::size_t r = 1; r <= others; ++r) {
    replies.push_back(receive_message(static_cast<int>(r)));
    ByteReader read(replies.back());
    if (read.value<bool>() || failure) continue;
    failure = std::make_exception_ptr(std::runtime_error(read.text()));
  }
  if (failure) std::rethrow_exception(failure);
  return replies;
}

ByteReader values_of(const Message& reply) { return ByteReader(std::span(reply).subspan(1)); }

void place(std::span<const kernels::RveReport> from, std::span<const std::size_t> points,
           std::vector<kernels::RveReport>& to) {
  if (from.size() != points.size())
    throw std::logic_error("a rank has answered for another number of points than it holds");
  for (std::size_t k = 0; k < points.size(); ++k) to[points[k]] = from[k];
}

}  // namespace

std::vector<std::vector<std::size_t>> deal_points(std::size_t n, std::span<const RankInfo> ranks) {
  std::vector<std::vector<std::size_t>> points(ranks.size());
  const auto load = [&](std::size_t r) { return static_cast<double>(points[r].size() + 1) / ranks[r].threads; };
  for (std::size_t p = 0; p < n; ++p) {
    std::size_t least = 0;
    for (std::size_t r = 1; r < ranks.size(); ++r) {
      if (load(r) < load(least)) least = r;
    }
    points[least].push_back(p);
  }
  return points;
}

RankPool::RankPool(PackingMix mix, const PoolOptions& options, std::span<const RankInfo> ranks, PackingNote note)
    : mix_(std::move(mix)),
      options_(options),
      note_(std::move(note)),
      least_areas_(least_areas(mix_)),
      points_(deal_points(mix_.points(), ranks)),
      trial_(mix_.points()),
      committed_(mix_.points()),
      retired_(mix_.points()) {
  const auto replies = ask(
      others(), [&](std::size_t r) { return make_message(r); },
      [&] { own_ = std::make_unique<RvePool>(mix_.part(points_[0]), options_); });
  place(own_->committed_reports(), points_[0], committed_);
  std::string text = fmt::format("{} ranks:", ranks.size());
  std::vector<std::string> devices{own_->device_sentence()};
  for (std::size_t r = 0; r < ranks.size(); ++r) {
    if (r > 0) {
      ByteReader read = values_of(replies[r - 1]);
      place(read.list<kernels::RveReport>(), points_[r], committed_);
      devices.push_back(read.text());
    }
    text += fmt::format("{} {} points on {} with {} threads and {} lanes", r > 0 ? "," : "", points_[r].size(),
                        ranks[r].host, ranks[r].threads, ranks[r].lanes);
  }
  if (!note_) return;
  note_(text);
  // Where no rank speaks of a device, there is none to speak of.
  if (std::all_of(devices.begin(), devices.end(), [](const std::string& d) { return d.empty(); })) return;
  for (std::size_t r = 0; r < ranks.size(); ++r)
    note_(fmt::format("rank {}: {}", r, devices[r].empty() ? "grains by lanes" : devices[r]));
}

RankPool::~RankPool() {
  try {
    describe_costs();
    // NOLINTNEXTLINE(bugprone-empty-catch): a rank or the log is gone, of which another exception tells.
  } catch (const std::exception&) {
  }
}

void RankPool::describe_costs() {
  const auto replies = ask(others(), [](std::size_t) { return message_of(Command::forget); });
  if (!note_) return;
  const Ledger& l = ledger_;
  if (l.evaluations > 0) {
    note_(fmt::format(
        "ranks: {} evaluations in {:.3g} s, {:.3g} MB of messages each; the first rank waited {:.1f} % of that "
        "time, spreading cost {:.1f} %",
        l.evaluations, l.evaluating, l.bytes / static_cast<double>(l.evaluations) * 1e-6,
        100.0 * l.waiting / l.evaluating, 100.0 * (l.evaluating - l.slowest) / l.evaluating));
  }
  for (std::size_t r = 1; r <= others(); ++r) {
    note_(fmt::format("rank {}: peak memory {:.0f} MB", r, values_of(replies[r - 1]).value<double>() * 1e-6));
  }
}

Message RankPool::make_message(std::size_t rank) const {
  Message message = message_of(Command::make);
  ByteWriter write(message);
  write_mix(write, mix_.part(points_[rank]));
  transfer_options(write, options_);
  return message;
}

void RankPool::begin_increment() {
  ask(others(), [](std::size_t) { return message_of(Command::begin_increment); }, [&] { own_->begin_increment(); });
}

Message RankPool::gradient_message(std::size_t rank, std::span<const fem::Gradient> gradients,
                                   bool with_tangents) const {
  std::vector<double> flat;
  for (const std::size_t p : points_[rank]) flat.insert(flat.end(), gradients[p].data(), gradients[p].data() + 4);
  Message message = message_of(Command::evaluate, with_tangents);
  ByteWriter(message).list(flat);
  return message;
}

fem::BatchReport RankPool::evaluate(std::span<const fem::Gradient> gradients, std::span<fem::Stress> stress,
                                    std::span<fem::Tangent> tangent) {
  const double start = now();
  kernels::Work work;
  double own_end = start;
  double slowest = 0;
  const auto message = [&](std::size_t r) {
    Message m = gradient_message(r, gradients, !tangent.empty());
    ledger_.bytes += static_cast<double>(m.size());
    return m;
  };
  const auto replies = ask(others(), message, [&] {
    const double since = now();
    std::vector<fem::Gradient> mine;
    for (const std::size_t p : points_[0]) mine.push_back(gradients[p]);
    work = own_->advance(mine, !tangent.empty());
    own_end = now();
    slowest = own_end - since;
  });
  ledger_.waiting += now() - own_end;
  place(own_->trial_reports(), points_[0], trial_);
  double deferral_error = own_->deferral_error();
  for (std::size_t r = 1; r <= others(); ++r) {
    ByteReader read = values_of(replies[r - 1]);
    slowest = std::max(slowest, read.value<double>());
    work += read.value<kernels::Work>();
    deferral_error = std::max(deferral_error, read.value<double>());
    place(read.list<kernels::RveReport>(), points_[r], trial_);
    ledger_.bytes += static_cast<double>(replies[r - 1].size());
  }
  copy_answers(trial_, stress, tangent);
  retired_.clear(stress, tangent);
  fem::BatchReport report = summarise(trial_, {own_->pressure_floor(), least_areas_, mix_.numbers, retired_});
  report.work = work.particle_steps;
  report.lane_steps = work.lane_steps;
  report.tangent_time = work.tangent_time();
  report.deferral_error = deferral_error;
  ++ledger_.evaluations;
  ledger_.slowest += slowest;
  ledger_.evaluating += now() - start;
  return report;
}

void RankPool::commit() {
  ask(others(), [](std::size_t) { return message_of(Command::commit); }, [&] { own_->commit(); });
  committed_ = trial_;
}

void RankPool::committed(std::span<fem::Stress> stress, std::span<fem::Tangent> tangent) const {
  copy_answers(committed_, stress, tangent);
  retired_.clear(stress, tangent);
}

/// A list of points is sent to each rank, by their numbers within the rank.
void RankPool::retire(std::span<const std::size_t> points) {
  retired_.add(points);
  std::vector<std::vector<std::size_t>> of_rank(points_.size());
  for (std::size_t r = 0; r < points_.size(); ++r) {
    for (const std::size_t p : points) {
      const auto found = std::lower_bound(points_[r].begin(), points_[r].end(), p);
      if (found != points_[r].end() && *found == p)
        of_rank[r].push_back(static_cast<std::size_t>(found - points_[r].begin()));
    }
  }
  const auto message = [&](std::size_t r) {
    Message m = message_of(Command::retire);
    ByteWriter(m).list(of_rank[r]);
    return m;
  };
  ask(others(), message, [&] { own_->retire(of_rank[0]); });
}

std::vector<fem::PointField> RankPool::fields() const {
  std::vector<fem::PointField> mine;
  const auto replies = ask(
      others(), [](std::size_t) { return message_of(Command::fields); }, [&] { mine = own_->fields(); });
  std::vector<fem::PointField> all;
  for (const fem::PointField& field : mine) {
    all.push_back({field.name, field.unit, field.components,
                   std::vector<double>(size() * static_cast<std::size_t>(field.components))});
  }
  const auto spread = [&](std::size_t field, std::size_t rank, const std::vector<double>& values) {
    const auto width = static_cast<std::size_t>(all[field].components);
    for (std::size_t k = 0; k < points_[rank].size(); ++k) {
      std::copy_n(values.data() + k * width, width, all[field].values.data() + points_[rank][k] * width);
    }
  };
  for (std::size_t f = 0; f < all.size(); ++f) spread(f, 0, mine[f].values);
  for (std::size_t r = 1; r <= others(); ++r) {
    ByteReader read = values_of(replies[r - 1]);
    if (read.value<std::uint64_t>() != all.size())
      throw std::logic_error("a rank has other fields than the first rank");
    for (std::size_t f = 0; f < all.size(); ++f) {
      if (read.text() != all[f].name || read.text() != all[f].unit || read.value<int>() != all[f].components) {
        throw std::logic_error("a rank has other fields than the first rank");
      }
      spread(f, r, read.list<double>());
    }
  }
  return all;
}

/// The records of `n` RVEs of a rank from its RVE `first` on, counted within the rank.
std::vector<std::vector<std::byte>> RankPool::records_of(std::size_t rank, std::size_t first, std::size_t n) const {
  if (rank == 0) return own_->records(first, n);
  std::vector<std::vector<std::byte>> records;
  send_message(static_cast<int>(rank),
               message_of(Command::states, static_cast<std::uint64_t>(first), static_cast<std::uint64_t>(n)));
  const Message reply = receive_message(static_cast<int>(rank));
  ByteReader read(reply);
  if (!read.value<bool>()) throw std::runtime_error(read.text());
  for (std::size_t k = 0; k < n; ++k) records.push_back(read.list<std::byte>());
  return records;
}

std::vector<std::byte> RankPool::state() const {
  std::vector<std::vector<std::byte>> records(size());
  for (std::size_t r = 0; r < points_.size(); ++r) {
    for (std::size_t first = 0; first < points_[r].size(); first += records_a_message) {
      auto some = records_of(r, first, std::min(records_a_message, points_[r].size() - first));
      for (std::size_t k = 0; k < some.size(); ++k) records[points_[r][first + k]] = std::move(some[k]);
    }
  }
  return join_state(identity(), std::vector<StateRecord>(records.begin(), records.end()));
}

void RankPool::set_state(std::span<const std::byte> bytes) {
  const std::vector<StateRecord> records = split_state(bytes, identity(), size());
  std::vector<std::size_t> rves(points_[0].size());
  std::vector<StateRecord> mine;
  for (std::size_t k = 0; k < rves.size(); ++k) {
    rves[k] = k;
    mine.push_back(records[points_[0][k]]);
  }
  own_->set_states(rves, mine);
  place(own_->committed_reports(), points_[0], committed_);
  std::size_t most = 0;
  for (const auto& points : points_) most = std::max(most, points.size());
  for (std::size_t first = 0; first < most; first += records_a_message) {
    const auto message = [&](std::size_t r) {
      Message m = message_of(Command::set_states, static_cast<std::uint64_t>(first));
      ByteWriter write(m);
      for (std::size_t k = first; k < std::min(first + records_a_message, points_[r].size()); ++k)
        write.list(records[points_[r][k]]);
      return m;
    };
    const auto replies = ask(others(), message);
    for (std::size_t r = 1; r <= others(); ++r) {
      place(values_of(replies[r - 1]).list<kernels::RveReport>(), points_[r], committed_);
    }
  }
}

/// A pool of one RVE is filled from the RVE's record, which another rank may hold, and makes the snapshot.
std::vector<io::RveSnapshot> RankPool::snapshots(std::span<const std::int64_t> points) const {
  std::vector<io::RveSnapshot> out;
  for (const std::int64_t point : points) {
    if (point < 0 || point >= static_cast<std::int64_t>(size()))
      throw std::out_of_range("there is no Gauss point of this number");
    const auto p = static_cast<std::size_t>(point);
    PoolOptions by_lanes = options_;
    by_lanes.engine.backend = Backend::lanes;
    RvePool one(mix_.part({p}), by_lanes);
    for (std::size_t r = 0; r < points_.size(); ++r) {
      const auto found = std::lower_bound(points_[r].begin(), points_[r].end(), p);
      if (found == points_[r].end() || *found != p) continue;
      const auto record = records_of(r, static_cast<std::size_t>(found - points_[r].begin()), 1);
      const std::size_t first = 0;
      const StateRecord bytes = record.front();
      one.set_states(std::span(&first, 1), std::span(&bytes, 1));
    }
    const std::int64_t only = 0;
    out.push_back(one.snapshots(std::span(&only, 1)).front());
    out.back().name = point_name(p);
  }
  return out;
}

}  // namespace voussoir::host
