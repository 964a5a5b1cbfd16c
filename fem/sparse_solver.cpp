#include "fem/sparse_solver.hpp"

#include <cholmod.h>

#include <algorithm>
#include <new>
#include <stdexcept>

// Present only where OpenBLAS is the BLAS; dsyrk is a function of every BLAS, whose Fortran gives its name the
// underscore.
extern "C" [[gnu::weak]] void openblas_set_num_threads(int);
extern "C" [[gnu::weak]] void dsyrk_(  // NOLINT(readability-identifier-naming)
    const char*, const char*, const int*, const int*, const double*, const double*, const int*, const double*, double*,
    const int*);

namespace voussoir::fem {
namespace {

/// OpenBLAS gets one thread: sums then have one order, so that a run repeats its bits. It asks the system for its work
/// memory at the first product of matrices, and where there is none it asks again without end (version 0.3.21, 128
/// MiB). So the memory is tried first, and OpenBLAS takes it at once. Throws std::bad_alloc.
void prepare_open_blas() {
  if (openblas_set_num_threads == nullptr || dsyrk_ == nullptr) return;
  openblas_set_num_threads(1);
  static bool has_memory = false;
  if (has_memory) return;
  constexpr std::size_t work_memory = std::size_t{130} << 20;
  ::operator delete(::operator new(work_memory));  // throws std::bad_alloc; its pages are never touched
  const int one = 1;
  const double unit = 1;
  double product = 0;
  dsyrk_("L", "N", &one, &one, &unit, &unit, &one, &unit, &product, &one);
  has_memory = true;
}

}  // namespace

/// The library's workspace, the matrix (its arrays are ours) and the factor.
struct SparseSolver::Cholmod {
  cholmod_common common{};
  cholmod_sparse matrix{};
  cholmod_factor* factor = nullptr;
  SparsePattern pattern;

  Cholmod() {
    prepare_open_blas();
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;  // LL^T: reports a matrix that is not positive definite
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_AMD;
    common.postorder = 1;
  }
  ~Cholmod() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;
};

SparseSolver::SparseSolver(const SparsePattern& pattern) : cholmod_(std::make_unique<Cholmod>()) {
  cholmod_->pattern = pattern;
  cholmod_sparse& matrix = cholmod_->matrix;
  matrix.nrow = matrix.ncol = static_cast<std::size_t>(pattern.n);
  matrix.nzmax = pattern.row.size();
  matrix.p = cholmod_->pattern.column_start.data();
  matrix.i = cholmod_->pattern.row.data();
  matrix.stype = -1;  // lower triangle
  matrix.itype = CHOLMOD_INT;
  matrix.xtype = CHOLMOD_PATTERN;
  matrix.dtype = CHOLMOD_DOUBLE;
  matrix.sorted = matrix.packed = 1;
  cholmod_->factor = cholmod_analyze(&matrix, &cholmod_->common);
  if (cholmod_->factor == nullptr) throw std::runtime_error("sparse solver: CHOLMOD could not analyse the pattern");
}

SparseSolver::~SparseSolver() = default;

FactorStatus SparseSolver::factorise(const std::vector<double>& values) {
  cholmod_sparse matrix = cholmod_->matrix;
  matrix.x = const_cast<double*>(values.data());  // CHOLMOD reads it only
  matrix.xtype = CHOLMOD_REAL;
  cholmod_factorize(&matrix, cholmod_->factor, &cholmod_->common);
  const int status = cholmod_->common.status;
  if (status == CHOLMOD_OK) return FactorStatus::ok;
  return status == CHOLMOD_NOT_POSDEF ? FactorStatus::not_positive_definite : FactorStatus::out_of_memory;
}

Eigen::MatrixXd SparseSolver::solve(const Eigen::MatrixXd& right_hand_sides) {
  if (right_hand_sides.rows() != cholmod_->pattern.n)
    throw std::invalid_argument("sparse solver: wrong number of rows");
  cholmod_dense b{};
  b.nrow = static_cast<std::size_t>(right_hand_sides.rows());
  b.ncol = static_cast<std::size_t>(right_hand_sides.cols());
  b.nzmax = b.nrow * b.ncol;
  b.d = b.nrow;
  b.x = const_cast<double*>(right_hand_sides.data());  // CHOLMOD reads it only
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* x = cholmod_solve(CHOLMOD_A, cholmod_->factor, &b, &cholmod_->common);
  if (x == nullptr) throw std::runtime_error("sparse solver: CHOLMOD could not solve (no factor, or no memory)");
  Eigen::MatrixXd solution = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(x->x),
                                                               right_hand_sides.rows(), right_hand_sides.cols());
  cholmod_free_dense(&x, &cholmod_->common);
  return solution;
}

}  // namespace voussoir::fem
