// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/discrete_curvature.hpp"

namespace esfem {

DiscreteCurvature::DiscreteCurvature(const SurfaceSpace& space)
    : space_(space), M_(space.matrix()), A_(space.matrix()), cholesky_(space.pattern()) {}

void DiscreteCurvature::compute(const Field& x) {
  const auto normal = [](const PointData<0>& p, Integrand<3, 0>& load) {
    for (int l = 0; l < 3; ++l) load.value[l] = p.normal[l];
  };
  space_.assemble(x, M_, A_);
  A_.multiply(x, kappa_);
  space_.assemble_load<0, 3, 0>(x, x, normal, nu_);

  kappa_and_nu_.resize(x.rows(), 6);
  kappa_and_nu_ << kappa_, nu_;
  cholesky_.factorise(1.0, M_, 0.0, A_);
  cholesky_.solve(kappa_and_nu_);

  kappa_ = kappa_and_nu_.leftCols(3);
  nu_ = kappa_and_nu_.rightCols(3);
  nu_.rowwise().normalize();
  H_ = kappa_.cwiseProduct(nu_).rowwise().sum();
}

}  // namespace esfem
