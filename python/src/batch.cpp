// The class Batch of voussoir._core: a GrainBatch that releases the interpreter lock while grains run.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "host/case/load_case.hpp"
#include "host/library/accepted_case.hpp"
#include "host/library/grain_batch.hpp"
#include "io/input_error.hpp"
#include "kernels/isa/choose_lanes.hpp"
#include "python/src/arrays.hpp"
#include "python/src/engine.hpp"
#include "python/src/packings.hpp"

namespace voussoir::python {
namespace {

using library::GrainBatch;
using Gradients = nb::ndarray<const double, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
using Points = std::vector<std::size_t>;

/// All members need the interpreter lock. One thread at a time uses the batch; others wait.
class Batch final : public engine::Closable {
 public:
  explicit Batch(std::unique_ptr<GrainBatch> batch) : batch_(std::move(batch)), size_(batch_->size()) {
    batch_->set_pause(&engine::look_for_signals, &engine::run_stoppable);
  }
  ~Batch() override {
    // The memory is that of an engine whose threads are elsewhere: it is left alone.
    // NOLINTNEXTLINE(bugprone-unused-return-value): nobody is to delete it
    if (engine::forked()) static_cast<void>(batch_.release());
  }
  void close() override { end(std::unique_lock(busy_)); }
  void close_by_user() {
    if (engine::forked()) return;
    refuse_handler();
    const nb::gil_scoped_release free;
    end(wait_for_turn());
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool is_open() const { return is_open_; }

  /// Runs `work` without the interpreter lock, while no other thread uses the batch.
  template <class Work>
  auto run(const Work& work) {
    const engine::Call call;
    refuse_handler();
    const nb::gil_scoped_release free;
    const auto lock = wait_for_turn();
    const User user(user_);
    if (!batch_) throw std::runtime_error("this batch is closed");
    return work(*batch_);
  }

 private:
  class User {
   public:
    explicit User(std::atomic<std::thread::id>& user) : user_(&user) { user = std::this_thread::get_id(); }
    ~User() { *user_ = std::thread::id(); }
    User(const User&) = delete;
    User& operator=(const User&) = delete;

   private:
    std::atomic<std::thread::id>* user_;
  };

  /// Waits until no other thread uses the batch, and looks for signals meanwhile.
  std::unique_lock<std::timed_mutex> wait_for_turn() {
    std::unique_lock lock(busy_, std::try_to_lock);
    while (!lock && !lock.try_lock_for(std::chrono::milliseconds(50))) engine::look_for_signals();
    return lock;
  }

  /// Frees the grains. @param held the lock of `busy_`
  void end(const std::unique_lock<std::timed_mutex>& /*held*/) {
    is_open_ = false;
    batch_.reset();
  }

  /// A signal's handler runs within a pause of its thread, which has the batch and would wait for itself.
  void refuse_handler() const {
    if (user_ == std::this_thread::get_id())
      throw std::runtime_error("a signal's handler cannot use a batch that is at work in its own thread");
  }

  std::timed_mutex busy_;
  std::atomic<std::thread::id> user_;  ///< the thread that has `busy_`
  std::unique_ptr<GrainBatch> batch_;
  std::size_t size_;
  std::atomic<bool> is_open_ = true;
};

/// Arrays of an answer, before they are NumPy's.
class NewAnswer {
 public:
  NewAnswer(std::size_t n, bool with_tangent) : n_(n), stress_(4 * n), tangent_(with_tangent ? 9 * n : 0), report_(n) {}
  [[nodiscard]] library::AnswerArrays arrays() { return {stress_.values(), tangent_.values(), report_.values()}; }
  /// Stress, tangent or None, bytes of the reports, and the outcome.
  [[nodiscard]] nb::tuple give(const fem::BatchReport& outcome) {
    const bool with_tangent = !tangent_.values().empty();
    return nb::make_tuple(stress_.give({n_, 2, 2}), with_tangent ? tangent_.give({n_, 3, 3}) : nb::none(),
                          bytes_of_reports(), outcome.usable, outcome.message);
  }

 private:
  nb::object bytes_of_reports() {
    NewArray<std::uint8_t> bytes(n_ * sizeof(library::PointReport));
    const auto from = std::as_bytes(report_.values());
    std::copy_n(reinterpret_cast<const std::uint8_t*>(from.data()), from.size(), bytes.values().data());
    return bytes.give({from.size()});
  }

  std::size_t n_;
  NewArray<double> stress_, tangent_;
  NewArray<library::PointReport> report_;
};

nb::tuple evaluate(Batch& batch, const Gradients& f_minus_i, bool with_tangent) {
  const std::size_t n = batch.size();
  if (f_minus_i.shape(0) != n || f_minus_i.shape(1) != 2 || f_minus_i.shape(2) != 2)
    throw nb::value_error("f_minus_i needs the shape (n, 2, 2), with the n of the batch");
  NewAnswer answer(n, with_tangent);
  const fem::BatchReport outcome = batch.run(
      [&](GrainBatch& grains) { return grains.evaluate({f_minus_i.data(), f_minus_i.size()}, answer.arrays()); });
  return answer.give(outcome);
}

nb::tuple committed(Batch& batch, bool with_tangent) {
  NewAnswer answer(batch.size(), with_tangent);
  batch.run([&](GrainBatch& grains) { grains.committed(answer.arrays()); });
  return answer.give({});
}

nb::bytes state(Batch& batch, const Points& points) {
  const std::vector<std::byte> bytes = batch.run([&](GrainBatch& grains) { return grains.state(points); });
  return nb::bytes(bytes.data(), bytes.size());
}

void set_state(Batch& batch, const nb::bytes& bytes, const Points& points) {
  const std::span<const std::byte> span(static_cast<const std::byte*>(bytes.data()), bytes.size());
  const auto refuse = [](const std::string& reason) {
    throw std::invalid_argument("the bytes are no state of these points: " + reason);
  };
  batch.run([&](GrainBatch& grains) {
    try {
      grains.set_state(span, points);
    } catch (const io::InputError& fault) {
      refuse(fault.sentence());
    } catch (const std::runtime_error& fault) {
      refuse(fault.what());
    }
  });
}

/// Name, unit and values of each field.
nb::list fields(Batch& batch) {
  nb::list out;
  for (const fem::PointField& field : batch.run([](GrainBatch& grains) { return grains.fields(); })) {
    const auto components = static_cast<std::size_t>(field.components);
    const bool is_scalar = components == 1;
    const nb::object values = is_scalar ? array_of(field.values)
                                        : array_of(field.values, {field.values.size() / components, components});
    out.append(nb::make_tuple(field.name, field.unit, values));
  }
  return out;
}

nb::dict snapshot(Batch& batch, std::size_t point) {
  const io::RveSnapshot rve = batch.run([&](GrainBatch& grains) { return grains.snapshot(point); });
  nb::dict out;
  out["radius"] = array_of(rve.radius);
  out["x"] = array_of(rve.x);
  out["y"] = array_of(rve.y);
  out["rotation"] = array_of(rve.rotation);
  out["cell"] = array_of(std::vector<double>(rve.cell.begin(), rve.cell.end()), {2, 2});
  out["thickness"] = rve.thickness;
  out["contact_i"] = array_of(rve.contact_i);
  out["contact_j"] = array_of(rve.contact_j);
  out["branch"] = array_of(rve.branch, {rve.contact_i.size(), 2});
  out["force"] = array_of(rve.force, {rve.contact_i.size(), 2});
  return out;
}

/// A batch of these packings. @param settings text of a case of a kind with a mesh, with [engine], [newton] and
/// [output]
Batch* new_batch(const nb::list& packings, const std::vector<int>& packing_of, const std::string& settings,
                 const std::string& name, const std::vector<bool>& mirrored) {
  const engine::Call call;
  std::vector<io::Packing> files;
  for (const nb::handle packing : packings) files.push_back(python::packing_of(nb::cast<nb::dict>(packing)));
  const nb::gil_scoped_release free;
  const host::Case input = host::case_of_text(settings, name);
  static_cast<void>(kernels::choose_lanes(input.engine.isa));
  std::vector<library::Grains> grains;
  for (const io::Packing& file : files) grains.push_back(library::grains_of(file));
  return new Batch(std::make_unique<GrainBatch>(std::move(grains), packing_of, library::options_of(input), mirrored));
}

/// A batch as a case of the program describes it, and the lines of the log that tell of its packings.
nb::tuple batch_of_case(const std::string& file, const std::vector<std::string>& overrides, std::size_t n,
                        const std::vector<bool>& mirrored) {
  std::vector<std::string> notes;
  std::unique_ptr<Batch> batch;
  {
    const engine::Call call;
    const nb::gil_scoped_release free;
    const host::Case input = library::accepted(host::load_case(file, overrides));
    host::PackingMix mix;
    engine::run_stoppable(
        [&] { mix = library::mix_of(input, n, [&](const std::string& line) { notes.push_back(line); }); });
    batch = std::make_unique<Batch>(library::make_batch(input, std::move(mix), mirrored));
  }
  return nb::make_tuple(nb::cast(batch.release(), nb::rv_policy::take_ownership), notes);
}

}  // namespace

void bind_batch(nb::module_& module) {
  nb::class_<Batch>(module, "Batch", "RVEs at n points; voussoir.RveBatch is the class for users.")
      .def("__len__", &Batch::size)
      .def_prop_ro("is_open", &Batch::is_open)
      .def("evaluate", &evaluate, nb::arg("f_minus_i"), nb::arg("tangent"))
      .def("committed", &committed, nb::arg("tangent"))
      .def("commit", [](Batch& batch) { batch.run([](GrainBatch& grains) { grains.commit(); }); })
      .def("begin_increment", [](Batch& batch) { batch.run([](GrainBatch& grains) { grains.begin_increment(); }); })
      .def("state", &state, nb::arg("points"))
      .def("set_state", &set_state, nb::arg("state"), nb::arg("points"))
      .def("fields", &fields)
      .def("void_ratio",
           [](Batch& batch) { return array_of(batch.run([](GrainBatch& grains) { return grains.void_ratios(); })); })
      .def("packing_of",
           [](Batch& batch) { return array_of(batch.run([](GrainBatch& grains) { return grains.packing_of(); })); })
      .def("device",
           [](Batch& batch) { return batch.run([](GrainBatch& grains) { return grains.device_sentence(); }); })
      .def("engine_seconds",
           [](Batch& batch) { return batch.run([](GrainBatch& grains) { return grains.engine_seconds(); }); })
      .def("snapshot", &snapshot, nb::arg("point"))
      .def(
          "packing",
          [](Batch& batch, std::size_t point) {
            return dict_of(batch.run([&](GrainBatch& grains) { return grains.packing(point); }));
          },
          nb::arg("point"))
      .def("close", &Batch::close_by_user);
  module.def("new_batch", &new_batch, nb::arg("packings"), nb::arg("packing_of"), nb::arg("settings"), nb::arg("name"),
             nb::arg("mirrored"), nb::rv_policy::take_ownership);
  module.def("batch_of_case", &batch_of_case, nb::arg("file"), nb::arg("overrides"), nb::arg("n"), nb::arg("mirrored"));
}

}  // namespace voussoir::python
