#include "fem/assembly.hpp"

#include <algorithm>
#include <cmath>

namespace voussoir::fem {

namespace {

int element_dof(const ElementNodes& nodes, int i) { return 2 * nodes[i / 2] + i % 2; }

using ElementStiffness = Eigen::Matrix<double, 16, 16>;

ElementStiffness element_stiffness(const GaussPoints& points, const std::vector<Tangent>& tangents, int element) {
  ElementStiffness k = ElementStiffness::Zero();
  Eigen::Matrix<double, 3, 16> b = Eigen::Matrix<double, 3, 16>::Zero();
  for (int i = 4 * element; i < 4 * element + 4; ++i) {
    for (int a = 0; a < 8; ++a) {
      const double dx = points.gradients[i](a, 0);
      const double dy = points.gradients[i](a, 1);
      b(0, 2 * a) = b(2, 2 * a + 1) = dx;
      b(1, 2 * a + 1) = b(2, 2 * a) = dy;
    }
    k.noalias() += b.transpose() * (points.volumes[i] * tangents[i]) * b;
  }
  return k;
}

SparsePattern make_pattern(const Mesh& mesh) {
  std::vector<std::vector<int>> columns(mesh.n_dofs());
  for (const ElementNodes& nodes : mesh.elements)
    for (int j = 0; j < 16; ++j)
      for (int i = 0; i < 16; ++i) {
        const int row = element_dof(nodes, i);
        const int column = element_dof(nodes, j);
        if (row >= column) columns[column].push_back(row);
      }
  SparsePattern pattern;
  pattern.n = mesh.n_dofs();
  pattern.column_start.push_back(0);
  for (auto& column : columns) {
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    pattern.row.insert(pattern.row.end(), column.begin(), column.end());
    pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
  }
  return pattern;
}

int entry_of(const SparsePattern& pattern, int row, int column) {
  const auto first = pattern.row.begin() + pattern.column_start[column];
  const auto last = pattern.row.begin() + pattern.column_start[column + 1];
  return static_cast<int>(std::lower_bound(first, last, row) - pattern.row.begin());
}

/// Replaces rows and columns of constrained dofs by the identity times the mean diagonal. This scale keeps the
/// condition of the matrix; its value has no effect, since the right-hand side is zero at these dofs.
void apply_constraints(const SparsePattern& pattern, const std::vector<char>& constrained,
                       std::vector<double>& values) {
  double trace = 0;
  for (int column = 0; column < pattern.n; ++column) trace += values[pattern.column_start[column]];
  const double diagonal = trace > 0 ? trace / pattern.n : 1.0;
  for (int column = 0; column < pattern.n; ++column)
    for (int k = pattern.column_start[column]; k < pattern.column_start[column + 1]; ++k) {
      const int row = pattern.row[k];
      if (constrained[row] || constrained[column]) values[k] = row == column ? diagonal : 0.0;
    }
}

}  // namespace

StiffnessAssembler::StiffnessAssembler(const Mesh& mesh) : mesh_(mesh), pattern_(make_pattern(mesh)) {
  scatter_.resize(mesh.n_elements());
  for (int e = 0; e < mesh.n_elements(); ++e) {
    int slot = 0;
    for (int j = 0; j < 16; ++j)
      for (int i = j; i < 16; ++i) {
        const int a = element_dof(mesh.elements[e], i);
        const int b = element_dof(mesh.elements[e], j);
        scatter_[e][slot++] = entry_of(pattern_, std::max(a, b), std::min(a, b));
      }
  }
}

std::vector<double> StiffnessAssembler::assemble(const GaussPoints& points, const std::vector<Tangent>& tangents,
                                                 const std::vector<char>& constrained) const {
  std::vector<double> values(pattern_.row.size(), 0.0);
  for (int e = 0; e < mesh_.n_elements(); ++e) {
    const ElementStiffness k = element_stiffness(points, tangents, e);
    int slot = 0;
    for (int j = 0; j < 16; ++j)
      for (int i = j; i < 16; ++i) values[scatter_[e][slot++]] += k(i, j);
  }
  apply_constraints(pattern_, constrained, values);
  return values;
}

InternalForce internal_force(const Mesh& mesh, const GaussPoints& points, const std::vector<Stress>& stress) {
  InternalForce result{Eigen::VectorXd::Zero(mesh.n_dofs()), Eigen::VectorXd::Zero(mesh.n_nodes())};
  for (int e = 0; e < mesh.n_elements(); ++e) {
    Eigen::Matrix<double, 8, 2> element = Eigen::Matrix<double, 8, 2>::Zero();
    for (int i = 4 * e; i < 4 * e + 4; ++i) {
      Eigen::Matrix2d s;
      s << stress[i][0], stress[i][2], stress[i][2], stress[i][1];
      element.noalias() += points.gradients[i] * (points.volumes[i] * s);
    }
    for (int a = 0; a < 8; ++a) {
      const int node = mesh.elements[e][a];
      result.force.segment<2>(2 * node) += element.row(a).transpose();
      result.magnitude[node] += element.row(a).norm();
    }
  }
  return result;
}

}  // namespace voussoir::fem
