#include "kernels/state/committed_contacts.hpp"

#include <cmath>

#include "kernels/contact/cell.hpp"
#include "kernels/contact/engine_law.hpp"

namespace voussoir::kernels {

namespace {

/// Sets the forces of a contact by one call of the law without motion. The history is within its caps, as the
/// evaluation left it.
/// @param numbers of the contact's history; @param length |b| [m]
void add_forces(const Packing& packing, const double* numbers, CommittedContact& contact, double length) {
  using Law = PlainEngineLaw;
  using V = Law::Value;
  const auto i = static_cast<std::size_t>(contact.i), j = static_cast<std::size_t>(contact.j);
  const double ri = packing.radii[i], rj = packing.radii[j];
  const Law law(Law::combine(packing.material_of(i), ri, packing.material_of(j), rj));
  Law::History history = no_history<Law>();
  read_history<Law>(history, 0, [=](int k) { return numbers[k]; });
  const double overlap = ri + rj - length;
  const auto force = law({V(overlap / (ri + rj)), V(overlap / length), V(0.0), V(0.0)}, history);
  contact.normal_force = force.normal_to_branch[0] * length;
  contact.tangential_force = force.tangential[0];
  contact.moment = force.moment[0];
}

}  // namespace

void committed_contacts(const RveBatch& batch, std::size_t rve, std::vector<CommittedContact>& out) {
  const RveStates& s = batch.committed;
  const Cell cell(Mat2{s.cell(rve, 0), s.cell(rve, 1), s.cell(rve, 2), s.cell(rve, 3)});
  const auto count = static_cast<std::size_t>(s.contact_count(rve));
  out.resize(count);
  for (std::size_t c = 0; c < count; ++c) {
    CommittedContact& contact = out[c];
    contact.i = first_of(s.contact_key(rve, c));
    contact.j = second_of(s.contact_key(rve, c));
    contact.branch_x = s.position(rve, contact.j, 0) - s.position(rve, contact.i, 0);
    contact.branch_y = s.position(rve, contact.j, 1) - s.position(rve, contact.i, 1);
    cell.nearest(contact.branch_x, contact.branch_y);
    const double length = std::sqrt(contact.branch_x * contact.branch_x + contact.branch_y * contact.branch_y);
    contact.normal_x = contact.branch_x / length;
    contact.normal_y = contact.branch_y / length;
    add_forces(batch.packing(rve), s.histories_of(rve) + c * s.history_size(), contact, length);
  }
}

}  // namespace voussoir::kernels
