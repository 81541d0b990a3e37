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

/// Squared L2 norm and H1 seminorm of w less something else, component by component, point by point.
class ErrorSums {
 public:
  ErrorSums(const SurfaceSpace& space, const Field& w)
      : batches_(space.batches()), w_(w), nodal_(w.cols() * batches_.nodes()), L2_(w.cols()), H1_(w.cols()) {}

  /// The nodal values of w in the elements of a batch: before its points.
  void load(const Batch& batch) {
    for (int l = 0; l < w_.cols(); ++l) batches_.gather(batch, w_, l, &nodal_[l * batches_.nodes()]);
  }

  /// other: values and tangential gradients at point q, which counts dA.
  void add(int q, const Pack& dA, const DualTangents& dual, const FieldsAtPoints& other) {
    const ElementBatches::Shape* shape = batches_.shapes(q);
    for (int l = 0; l < w_.cols(); ++l) {
      Pack e = -other.value[l], w_xi = {}, w_eta = {};
      for (int a = 0; a < batches_.nodes(); ++a) {
        const Pack w_a = nodal_[l * batches_.nodes() + a];
        e += shape[a].value * w_a;
        w_xi += shape[a].dxi * w_a;
        w_eta += shape[a].deta * w_a;
      }
      Pack e_gradient[3];
      for (int i = 0; i < 3; ++i)
        e_gradient[i] = dual.xi[i] * w_xi + dual.eta[i] * w_eta - other.gradient[l][i];
      L2_[l] += dA * e * e;
      H1_[l] += dA * dot(e_gradient, e_gradient);
    }
  }

  SquaredNorms norms() const {
    SquaredNorms norms{Eigen::VectorXd(w_.cols()), Eigen::VectorXd(w_.cols())};
    for (int l = 0; l < w_.cols(); ++l) {
      norms.L2[l] = sum_of_lanes(L2_[l]);
      norms.H1_semi[l] = sum_of_lanes(H1_[l]);
    }
    return norms;
  }

 private:
  const ElementBatches& batches_;
  const Field& w_;
  std::vector<Pack> nodal_, L2_, H1_;
};

}  // namespace

SquaredNorms lifted_errors(const SurfaceSpace& space, const Field& x_star, const ExactEvolution& exact,
                           double t, const Field& w) {
  ErrorSums sums(space, w);
  FieldsAtPoints at_points(exact.components());
  visit_lifted_points(space, x_star, exact.surface(t), [&](const Batch& batch, const LiftedPoints& points) {
    if (points.q == 0) sums.load(batch);
    exact.fields(t, points.on_surface, at_points);
    sums.add(points.q, points.dA, points.dual, at_points);
  });
  return sums.norms();
}

SquaredNorms quadrature_errors(const SurfaceSpace& space, const Field& x, const FunctionInSpace& exact,
                               const Field& w) {
  const ElementBatches& batches = space.batches();
  ErrorSums sums(space, w);
  FieldsAtPoints at_points(w.cols());
  Batch batch;
  BatchPoint point;
  for (int b = 0; b < batches.count(); ++b) {
    batches.load(b, x, batch);
    sums.load(batch);
    for (int q = 0; q < batches.points(); ++q) {
      batches.require_regular(batches.evaluate(batch, q, point), batch);
      Pack place[3] = {};
      for (int a = 0; a < batches.nodes(); ++a)
        for (int i = 0; i < 3; ++i) place[i] += batches.shapes(q)[a].value * batch.x[a][i];
      exact(batch, q, place, at_points);
      // Tangential gradients: (I - nu nuT) grad, with the normal n = |n| nu of the element.
      for (std::array<Pack, 3>& gradient : at_points.gradient) {
        const Pack along =
            (gradient[0] * point.normal[0] + gradient[1] * point.normal[1] + gradient[2] * point.normal[2]) *
            point.inverse_jacobian * point.inverse_jacobian;
        for (int i = 0; i < 3; ++i) gradient[i] -= along * point.normal[i];
      }
      sums.add(q, batch.one * batches.weight(q) * point.jacobian, DualTangents(point), at_points);
    }
  }
  return sums.norms();
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
