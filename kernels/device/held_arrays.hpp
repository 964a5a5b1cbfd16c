#pragma once
/// Packings and states of a batch in a device's memory. @tparam Backend has that memory (host_backend.hpp says what a
/// backend must have)

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "kernels/device/block_batch.hpp"
#include "kernels/device/resident_rves.hpp"

namespace voussoir::kernels::device {

/// An array in a device's memory.
template <class T, class Backend>
class DeviceArray {
 public:
  DeviceArray() = default;
  explicit DeviceArray(std::size_t count)
      : data_(static_cast<T*>(Backend::allocate(sizeof(T) * std::max<std::size_t>(count, 1)))), count_(count) {}
  DeviceArray(const DeviceArray&) = delete;
  DeviceArray& operator=(const DeviceArray&) = delete;
  DeviceArray(DeviceArray&& from) noexcept : data_(std::exchange(from.data_, nullptr)), count_(from.count_) {}
  DeviceArray& operator=(DeviceArray&& from) noexcept {
    std::swap(data_, from.data_);
    std::swap(count_, from.count_);
    return *this;
  }
  ~DeviceArray() {
    if (data_ != nullptr) Backend::release(data_);
  }

  [[nodiscard]] T* data() const { return data_; }
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] std::size_t bytes() const { return sizeof(T) * count_; }
  /// Makes room for `count` numbers; what was there is lost.
  void at_least(std::size_t count) {
    if (count > count_) *this = DeviceArray(count);
  }
  std::size_t write(std::span<const T> from, std::size_t at = 0) {
    Backend::copy_up(data_ + at, from.data(), from.size_bytes());
    return from.size_bytes();
  }
  std::size_t read(std::span<T> to, std::size_t at = 0) const {
    Backend::copy_down(to.data(), data_ + at, to.size_bytes());
    return to.size_bytes();
  }

 private:
  T* data_ = nullptr;
  std::size_t count_ = 0;
};

/// The packings of a batch on the device.
template <class Law, class Backend>
class HeldPackings {
 public:
  using real = real_of<typename Law::Value>;

  explicit HeldPackings(std::span<const Packing> packings) {
    std::vector<int> sizes;
    for (const Packing& p : packings) {
      sizes.push_back(p.size());
      grains_ = std::max(grains_, p.size());
      materials_ = std::max(materials_, static_cast<int>(p.materials.size()));
      classes_ = classes_ || !p.class_of.empty();
    }
    store(sizes_, std::span<const int>(sizes));
    write_grains(packings);
  }

  /// Writes what depends on the settings.
  void write(std::span<const Packing> packings, const EngineSettings& settings) {
    const std::size_t n = packings.size(), grains = static_cast<std::size_t>(grains_);
    scales_.clear();
    std::vector<GrainShape<real>> shapes(n * grains);
    std::vector<GrainMaterialOf<real>> materials(n * static_cast<std::size_t>(materials_));
    for (std::size_t k = 0; k < n; ++k) {
      const Packing& packing = packings[k];
      scales_.push_back(scales_of<Law>(packing, settings));
      for (std::size_t i = 0; i < packing.radii.size(); ++i)
        shapes[k * grains + i] = grain_shape<Law>(packing, i, scales_[k].largest_radius, settings.overlap_limit);
      for (std::size_t c = 0; c < packing.materials.size(); ++c)
        materials[k * static_cast<std::size_t>(materials_) + c] = rounded(packing.materials[c]);
    }
    store(scales_of_, std::span<const RunScales>(scales_));
    store(shapes_, std::span<const GrainShape<real>>(shapes));
    store(of_classes_, std::span<const GrainMaterialOf<real>>(materials));
  }

  [[nodiscard]] DevicePackings<real> view() const {
    return {scales_of_.data(),  radii_.data(), shapes_.data(), classes_ ? class_of_.data() : nullptr,
            of_classes_.data(), grains_,       materials_};
  }
  [[nodiscard]] ExactPackings exact() const {
    return {sizes_.data(), radii_.data(), classes_ ? class_of_.data() : nullptr, exact_of_classes_.data(),
            grains_,       materials_};
  }
  [[nodiscard]] int grains() const { return grains_; }
  [[nodiscard]] bool classes() const { return classes_; }
  [[nodiscard]] const RunScales& scales(int packing) const { return scales_[static_cast<std::size_t>(packing)]; }

 private:
  int grains_ = 0, materials_ = 1;
  bool classes_ = false;
  std::vector<RunScales> scales_;
  DeviceArray<int, Backend> sizes_;
  DeviceArray<RunScales, Backend> scales_of_;
  DeviceArray<double, Backend> radii_;
  DeviceArray<GrainShape<real>, Backend> shapes_;
  DeviceArray<std::uint8_t, Backend> class_of_;
  DeviceArray<GrainMaterialOf<real>, Backend> of_classes_;
  DeviceArray<GrainMaterial, Backend> exact_of_classes_;

  /// Writes what no setting changes.
  void write_grains(std::span<const Packing> packings) {
    const std::size_t n = packings.size(), grains = static_cast<std::size_t>(grains_);
    std::vector<double> radii(n * grains, 0.0);
    std::vector<std::uint8_t> class_of(classes_ ? n * grains : 0, 0);
    std::vector<GrainMaterial> materials(n * static_cast<std::size_t>(materials_));
    for (std::size_t k = 0; k < n; ++k) {
      const Packing& packing = packings[k];
      std::copy(packing.radii.begin(), packing.radii.end(), radii.data() + k * grains);
      std::copy(packing.class_of.begin(), packing.class_of.end(), class_of.data() + k * grains);
      std::copy(packing.materials.begin(), packing.materials.end(),
                materials.data() + k * static_cast<std::size_t>(materials_));
    }
    store(radii_, std::span<const double>(radii));
    store(class_of_, std::span<const std::uint8_t>(class_of));
    store(exact_of_classes_, std::span<const GrainMaterial>(materials));
  }
  [[nodiscard]] static GrainMaterialOf<real> rounded(const GrainMaterial& m) {
    const auto r = [](double x) { return static_cast<real>(x); };
    return {r(m.modulus), r(m.stiffness_ratio), r(m.friction), r(m.rolling_stiffness), r(m.rolling_limit)};
  }
  template <class T>
  static void store(DeviceArray<T, Backend>& to, std::span<const T> from) {
    to.at_least(from.size());
    to.write(from);
  }
};

/// The arrays of states on the device: `slots` states of each RVE.
template <class Backend>
class StateArrays {
 public:
  StateArrays(int slots, int rves, int grains, int contacts, int history)
      : slots_(slots),
        rves_(rves),
        grains_(grains),
        contacts_(contacts),
        history_(history),
        position_(all(2 * grains)),
        rotation_(all(grains)),
        cell_(all(4)),
        contact_count_(all(1)),
        contact_key_(all(contacts)),
        contact_history_(all(contacts * history)) {}

  /// @param committed_slot, evaluated by RVE, on the device
  [[nodiscard]] DeviceStates view(std::uint8_t* committed_slot, std::uint8_t* evaluated) const {
    return {position_.data(),
            rotation_.data(),
            cell_.data(),
            contact_count_.data(),
            contact_key_.data(),
            contact_history_.data(),
            committed_slot,
            evaluated,
            rves_,
            grains_,
            contacts_,
            history_};
  }
  /// Calls body(array, numbers of the host, how many a state has) for all arrays.
  template <class Body>
  void each_array(const HostStates& host, const Body& body) {
    body(position_, host.position, 2 * grains_);
    body(rotation_, host.rotation, grains_);
    body(cell_, host.cell, 4);
    body(contact_count_, host.contact_count, 1);
    body(contact_key_, host.contact_key, contacts_);
    if (history_ > 0) body(contact_history_, host.contact_history, contacts_ * history_);
  }

 private:
  int slots_, rves_, grains_, contacts_, history_;
  DeviceArray<double, Backend> position_, rotation_, cell_;
  DeviceArray<int, Backend> contact_count_;
  DeviceArray<std::uint32_t, Backend> contact_key_;
  DeviceArray<double, Backend> contact_history_;

  [[nodiscard]] std::size_t all(int count) const {
    return static_cast<std::size_t>(slots_) * static_cast<std::size_t>(rves_) * static_cast<std::size_t>(count);
  }
};

/// The states of a batch on the device: two of each RVE, and which of them is the committed one.
template <class Backend>
class HeldStates {
 public:
  HeldStates(int rves, int grains, int contacts, int history)
      : arrays_(2, rves, grains, contacts, history),
        committed_slot_(static_cast<std::size_t>(rves)),
        evaluated_(static_cast<std::size_t>(rves)),
        slots_(static_cast<std::size_t>(rves), 0) {}

  [[nodiscard]] DeviceStates view() const { return arrays_.view(committed_slot_.data(), evaluated_.data()); }

  void upload(const HostStates& from) {
    slots_.assign(slots_.size(), 0);
    committed_slot_.write(slots_);
    evaluated_.write(std::vector<std::uint8_t>(slots_.size(), 0));
    arrays_.each_array(from, [&](auto& array, const auto* numbers, int count) {
      array.write({numbers, slots_.size() * static_cast<std::size_t>(count)});
    });
  }

  void download(const HostStates& to, std::span<const int> rves, bool trial) {
    const std::vector<std::uint8_t> evaluated = trial ? flags() : std::vector<std::uint8_t>();
    for (const int rve : rves) {
      const auto k = static_cast<std::size_t>(rve);
      const int committed = slots_[k];
      const std::size_t at = view().place(trial && evaluated[k] != 0 ? 1 - committed : committed, rve);
      arrays_.each_array(to, [&](auto& array, auto* numbers, int count) {
        const auto c = static_cast<std::size_t>(count);
        array.read({numbers + k * c, c}, at * c);
      });
    }
  }

  /// Makes trial states committed ones. Returns whether the state of each RVE changed.
  std::vector<std::uint8_t> commit(std::span<const int> kept) {
    std::vector<std::uint8_t> changes = flags();
    for (const int rve : kept) changes[static_cast<std::size_t>(rve)] = 0;
    for (std::size_t k = 0; k < slots_.size(); ++k) slots_[k] ^= changes[k];
    committed_slot_.write(slots_);
    evaluated_.write(std::vector<std::uint8_t>(slots_.size(), 0));
    return changes;
  }

 private:
  StateArrays<Backend> arrays_;
  DeviceArray<std::uint8_t, Backend> committed_slot_, evaluated_;
  std::vector<std::uint8_t> slots_;  ///< committed_slot_, as the host knows it

  [[nodiscard]] std::vector<std::uint8_t> flags() const {
    std::vector<std::uint8_t> out(slots_.size());
    evaluated_.read(out);
    return out;
  }
};

/// A copy of the committed states on the device, from where they come to the host while RVEs advance.
template <class Backend>
class StateCopy {
 public:
  explicit StateCopy(const DeviceStates& of)
      : arrays_(1, of.rves, of.grains, of.contacts, of.history), rves_(of.rves) {}

  void take(const DeviceStates& from) { Backend::copy_committed(from, arrays_.view(nullptr, nullptr)); }
  /// Another thread than that of the other calls may call this. Returns the bytes moved.
  std::size_t bring(const HostStates& to) {
    std::size_t bytes = 0;
    arrays_.each_array(to, [&](const auto& array, auto* numbers, int count) {
      const std::size_t size = sizeof(*numbers) * static_cast<std::size_t>(rves_) * static_cast<std::size_t>(count);
      way_.copy_down(numbers, array.data(), size);
      bytes += size;
    });
    return bytes;
  }

 private:
  StateArrays<Backend> arrays_;
  int rves_;
  typename Backend::WayBeside way_;
};

}  // namespace voussoir::kernels::device
