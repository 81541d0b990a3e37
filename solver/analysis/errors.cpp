// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/analysis/errors.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/assembly/lifted_points.hpp"
#include "solver/problems/exact_evolution.hpp"

namespace esfem {

SquaredNorms nodal_norms(const SymmetricMatrix& M, const SymmetricMatrix& A, const Field& e) {
  Field Me, Ae;
  M.multiply(e, Me);
  A.multiply(e, Ae);
  return {e.cwiseProduct(Me).colwise().sum(), e.cwiseProduct(Ae).colwise().sum()};
}

namespace {

/// The squared norms of the difference of the functions with nodal values w and the exact components, in
/// points that point_of(batch, q) gives.
template <class PointOf>
SquaredNorms errors_in_points(const SurfaceSpace& space, const Field& x, const ExactEvolution& exact,
                              double t, const Field& w, const PointOf& point_of) {
  const int components = exact.components(), nodes = space.batches().nodes();
  std::vector<Pack> nodal(components * nodes), L2(components), H1_semi(components);
  FieldsAtPoints at_points(components);
  Batch batch;
  for (int b = 0; b < space.batches().count(); ++b) {
    space.batches().load(b, x, batch);
    for (int l = 0; l < components; ++l) space.batches().gather(batch, w, l, &nodal[l * nodes]);
    for (int q = 0; q < space.batches().points(); ++q) {
      const LiftedPoints points = point_of(batch, q);
      exact.fields(t, points.on_surface, at_points);
      const ElementBatches::Shape* shape = space.batches().shapes(q);
      for (int l = 0; l < components; ++l) {
        Pack e = -at_points.value[l], w_xi = {}, w_eta = {};
        for (int a = 0; a < nodes; ++a) {
          const Pack w_a = nodal[l * nodes + a];
          e += shape[a].value * w_a;
          w_xi += shape[a].dxi * w_a;
          w_eta += shape[a].deta * w_a;
        }
        Pack e_gradient[3];
        for (int i = 0; i < 3; ++i)
          e_gradient[i] = points.dual.xi[i] * w_xi + points.dual.eta[i] * w_eta - at_points.gradient[l][i];
        L2[l] += points.dA * e * e;
        H1_semi[l] += points.dA * dot(e_gradient, e_gradient);
      }
    }
  }
  SquaredNorms norms{Eigen::VectorXd(components), Eigen::VectorXd(components)};
  for (int l = 0; l < components; ++l) {
    norms.L2[l] = sum_of_lanes(L2[l]);
    norms.H1_semi[l] = sum_of_lanes(H1_semi[l]);
  }
  return norms;
}

}  // namespace

SquaredNorms lifted_errors(const SurfaceSpace& space, const Field& x_star, const ExactEvolution& exact,
                           double t, const Field& w) {
  const Surface surface = exact.surface(t);
  return errors_in_points(space, x_star, exact, t, w, [&](const Batch& batch, int q) {
    return lift(space.batches(), batch, q, surface);
  });
}

SquaredNorms unlifted_errors(const SurfaceSpace& space, const Field& x, const ExactEvolution& exact, double t,
                             const Field& w) {
  return errors_in_points(space, x, exact, t, w,
                          [&](const Batch& batch, int q) { return unlifted(space.batches(), batch, q); });
}

void raise_maxima(const Quantities& quantities, const std::string& kind, const SquaredNorms& norms,
                  Errors& maxima,
                  const std::function<void(const std::string&, const std::string&, double)>& each) {
  int column = 0;
  for (const auto& [quantity, components] : quantities) {
    // Round-off can make a vanishing eᵀAe negative.
    const double L2 = std::max(0.0, norms.L2.segment(column, components).sum());
    const double H1_semi = std::max(0.0, norms.H1_semi.segment(column, components).sum());
    const std::pair<const char*, double> values[] = {
        {"_L2", std::sqrt(L2)}, {"_H1", std::sqrt(L2 + H1_semi)}, {"_H1_semi", std::sqrt(H1_semi)}};
    for (const auto& [norm, value] : values) {
      double& maximum = maxima[quantity][kind + norm];
      maximum = std::max(maximum, value);
      if (each) each(quantity, kind + norm, value);
    }
    column += components;
  }
}

ErrorRecorder::ErrorRecorder(const SurfaceSpace& space, const ExactEvolution& exact, Field x0)
    : space_(space),
      exact_(exact),
      x0_(std::move(x0)),
      quantities_(space, exact.quantities),
      M_(space.matrix()),
      A_(space.matrix()) {}

void ErrorRecorder::record(double t, const Field& w) {
  const Field x_star = exact_.trajectories(x0_, t);
  space_.assemble(x_star, M_, A_);
  series_["t"].push_back(t);
  const auto note = [&](const std::string& quantity, const std::string& norm, double error) {
    series_[quantity + "_" + norm].push_back(error);
  };
  raise_maxima(quantities_, "nodal", nodal_norms(M_, A_, w - exact_.nodal_values(x_star, t)), maxima_, note);
  raise_maxima(quantities_, "lifted", lifted_errors(space_, x_star, exact_, t, w), maxima_, note);
}

LargestDifferences::LargestDifferences(const SurfaceSpace& space,
                                       std::vector<ExactEvolution::Quantity> quantities)
    : space_(space), quantities_(space, std::move(quantities)), M_(space.matrix()), A_(space.matrix()) {}

void LargestDifferences::add(const Field& x, const Field& difference) {
  space_.assemble(x, M_, A_);
  raise_maxima(quantities_, "nodal", nodal_norms(M_, A_, difference), errors_);
}

}  // namespace esfem
