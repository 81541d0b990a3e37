// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/geometry/discrete_curvature.hpp"

#include <cmath>

namespace esfem {

DiscreteCurvature::DiscreteCurvature(const SurfaceSpace& space)
    : space_(space), M_(space.matrix()), A_(space.matrix()), spd_(space.pattern()) {}

void DiscreteCurvature::compute(const Field& x) {
  const auto normal = [](const PointData<0>& p, Integrand<3, 0>& load) {
    for (int l = 0; l < 3; ++l) load.value[l] = p.normal[l];
  };
  space_.assemble(x, M_, A_);
  A_.multiply(x, kappa_);
  space_.assemble_load<0, 3, 0>(x, x, normal, nu_);

  kappa_and_nu_.resize(x.rows(), 6);
  kappa_and_nu_ << kappa_, nu_;
  spd_.factorise(1.0, M_, 0.0, A_);
  spd_.solve(kappa_and_nu_);

  kappa_ = kappa_and_nu_.leftCols(3);
  nu_ = kappa_and_nu_.rightCols(3);
  nu_.rowwise().normalize();
  H_ = kappa_.cwiseProduct(nu_).rowwise().sum();
}

double DiscreteCurvature::deviation(const Field& nu, const Field& H) {
  const double element = M_.energy(Field::Ones(space_.dofs(), 1)) / space_.element_count();
  const double length = std::sqrt(4 / std::sqrt(3) * element) / space_.degree();
  Field both(space_.dofs(), 6);
  both << kappa_, H.col(0).asDiagonal() * nu - kappa_;
  Field smooth = M_ * both;
  spd_.factorise(1.0, M_, length * length, A_);
  spd_.solve(smooth);
  return std::sqrt(M_.energy(smooth.rightCols(3)) / M_.energy(smooth.leftCols(3)));
}

double DiscreteCurvature::distance(const Field& nu, const Field& H) const {
  const Field own = H_.col(0).asDiagonal() * nu_;
  return std::sqrt(M_.energy(H.col(0).asDiagonal() * nu - own) / M_.energy(own));
}

DiscreteCurvature::AreaRates DiscreteCurvature::area_rates(const Field& nu, const Field& H,
                                                           const Field& v) const {
  const Field H_nu = H.col(0).asDiagonal() * nu, Mv = M_ * v;
  return {kappa_.cwiseProduct(Mv).sum(), H_nu.cwiseProduct(Mv).sum(),
          std::sqrt(M_.energy(H_nu) * M_.energy(v))};
}

}  // namespace esfem
