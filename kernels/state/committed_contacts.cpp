#include "kernels/state/committed_contacts.hpp"

#include "kernels/contact/committed_pair.hpp"
#include "kernels/contact/engine_law.hpp"

namespace voussoir::kernels {

namespace {

/// Sets the forces of a contact. The history is within its caps, as the evaluation left it.
/// @param numbers of the contact's history
void add_forces(const Packing& packing, const double* numbers, const CentreLine<double>& line,
                CommittedContact& contact) {
  using Law = PlainEngineLaw;
  const auto i = static_cast<std::size_t>(contact.i), j = static_cast<std::size_t>(contact.j);
  Law::History history = no_history<Law>();
  read_history<Law>(history, 0, [=](int k) { return numbers[k]; });
  const auto force = force_at_rest<Law>(packing.material_of(i), packing.radii[i], packing.material_of(j),
                                        packing.radii[j], line.overlap, line.overlap_to_branch, history);
  contact.normal_force = force.normal_to_branch[0] * line.length;
  contact.tangential_force = force.tangential[0];
  contact.moment = force.moment[0];
}

}  // namespace

void committed_contacts(const RveBatch& batch, std::size_t rve, std::vector<CommittedContact>& out) {
  const RveStates& s = batch.committed;
  const Cell cell(Mat2{s.cell(rve, 0), s.cell(rve, 1), s.cell(rve, 2), s.cell(rve, 3)});
  const std::vector<double>& radii = batch.packing(rve).radii;
  const auto count = static_cast<std::size_t>(s.contact_count(rve));
  out.resize(count);
  for (std::size_t c = 0; c < count; ++c) {
    CommittedContact& contact = out[c];
    contact.i = first_of(s.contact_key(rve, c));
    contact.j = second_of(s.contact_key(rve, c));
    const auto line = centre_line(cell, s.position(rve, contact.j, 0) - s.position(rve, contact.i, 0),
                                  s.position(rve, contact.j, 1) - s.position(rve, contact.i, 1),
                                  radii[static_cast<std::size_t>(contact.i)],
                                  radii[static_cast<std::size_t>(contact.j)]);
    contact.branch_x = line.branch_x;
    contact.branch_y = line.branch_y;
    contact.normal_x = line.normal_x;
    contact.normal_y = line.normal_y;
    add_forces(batch.packing(rve), s.histories_of(rve) + c * s.history_size(), line, contact);
  }
}

}  // namespace voussoir::kernels
