// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linalg/gmres.hpp"

#include <Eigen/Sparse>
#include <unsupported/Eigen/IterativeSolvers>

#include "solver/error.hpp"

namespace esfem {
class MapAsMatrix;
}

namespace Eigen::internal {
template <>
struct traits<esfem::MapAsMatrix> : traits<SparseMatrix<double>> {};
}  // namespace Eigen::internal

namespace esfem {

/// A LinearMap in the form that Eigen's iterative solvers take (its documentation, "Matrix-free solvers").
class MapAsMatrix : public Eigen::EigenBase<MapAsMatrix> {
 public:
  using Scalar = double;
  using RealScalar = double;
  using StorageIndex = int;
  enum { ColsAtCompileTime = Eigen::Dynamic, MaxColsAtCompileTime = Eigen::Dynamic, IsRowMajor = false };

  MapAsMatrix(const LinearMap& map, Eigen::Index size) : map_(map), size_(size) {}
  Eigen::Index rows() const { return size_; }
  Eigen::Index cols() const { return size_; }
  const LinearMap& map() const { return map_; }

  template <class Right>
  Eigen::Product<MapAsMatrix, Right, Eigen::AliasFreeProduct> operator*(
      const Eigen::MatrixBase<Right>& right) const {
    return {*this, right.derived()};
  }

 private:
  const LinearMap& map_;
  Eigen::Index size_;
};

}  // namespace esfem

namespace Eigen::internal {
template <class Right>
struct generic_product_impl<esfem::MapAsMatrix, Right, SparseShape, DenseShape, GemvProduct>
    : generic_product_impl_base<esfem::MapAsMatrix, Right,
                                generic_product_impl<esfem::MapAsMatrix, Right, SparseShape, DenseShape>> {
  template <class Out>
  static void scaleAndAddTo(Out& out, const esfem::MapAsMatrix& matrix, const Right& right, double factor) {
    VectorXd image(matrix.rows());
    matrix.map()(right, image);
    out += factor * image;
  }
};
}  // namespace Eigen::internal

namespace esfem {

int solve_gmres(const LinearMap& map, const Eigen::VectorXd& rhs, double tolerance, int most_iterations,
                Eigen::VectorXd& y) {
  const MapAsMatrix matrix(map, rhs.size());
  Eigen::GMRES<MapAsMatrix, Eigen::IdentityPreconditioner> solver(matrix);
  solver.set_restart(most_iterations);
  solver.setMaxIterations(most_iterations);
  solver.setTolerance(tolerance);
  y = solver.solveWithGuess(rhs, y);
  if (solver.info() != Eigen::Success) {
    throw NumericsError(format("GMRES: relative residual %g after %td iterations, expected %g",
                               solver.error(), static_cast<std::ptrdiff_t>(solver.iterations()), tolerance));
  }
  return static_cast<int>(solver.iterations());
}

}  // namespace esfem
