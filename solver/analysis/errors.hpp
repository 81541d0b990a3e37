// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/analysis/table.hpp"
#include "solver/assembly/surface_space.hpp"
#include "solver/flows/exact_evolution.hpp"

namespace esfem {

/// Squared L2 norm and H1 seminorm of each component.
struct SquaredNorms {
  Eigen::VectorXd L2, H1_semi;
};

/// Nodal norms (kll19 (7.1)-(7.2)): eᵀM(x*)e and eᵀA(x*)e per column of e; the matrices are assembled at x*.
SquaredNorms nodal_norms(const SymmetricMatrix& M, const SymmetricMatrix& A, const Field& e);

/// True errors on the exact surface, by quadrature with the space's rule: the functions with nodal values w
/// (N x c) on the interpolated surface Gamma_h[x_star] are lifted to the surface by its closest point (kll19
/// §3.4) and compared with the exact components at time t.
///
/// With x = y + s nu(y) the tangents of the lifted element are dy = (I + s A(y))^{-1} P dx.
SquaredNorms lifted_errors(const SurfaceSpace& space, const Field& x_star, const ExactEvolution& exact,
                           double t, const Field& w);

/// Collects the errors of a run: per step as series "x_nodal_L2", .., and their maxima over time (the norms
/// L^infinity(L2), L^infinity(H1)). H1 is the full norm sqrt(L2² + seminorm²), per time.
class ErrorRecorder {
 public:
  /// x0: the exact initial nodes. Space and exact solution must outlive the recorder.
  ErrorRecorder(const SurfaceSpace& space, const ExactEvolution& exact, Field x0);

  /// w: the numerical components at time t, N x exact.components(), in the order of exact.quantities.
  void record(double t, const Field& w);

  const Errors& maxima() const { return maxima_; }
  const std::map<std::string, std::vector<double>>& series() const { return series_; }

 private:
  void add(const std::string& kind, const SquaredNorms& norms);

  const SurfaceSpace& space_;
  const ExactEvolution& exact_;
  Field x0_;
  SymmetricMatrix M_, A_;
  Errors maxima_;
  std::map<std::string, std::vector<double>> series_;
};

}  // namespace esfem
