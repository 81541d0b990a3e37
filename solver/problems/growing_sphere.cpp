// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/problems/growing_sphere.hpp"

#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/problems/exact_evolution.hpp"

namespace esfem {

GrowingSphere::GrowingSphere(double t) {
  r = 1 + std::sin(pi * t) / 2;
  dr = pi * std::cos(pi * t) / 2;
  ddr = -pi * pi * std::sin(pi * t) / 2;
  a = std::exp(-t * t);
  da = -2 * t * a;
}

GrowingSphereProblem::GrowingSphereProblem(const CoupledDiffusionParameters& parameters,
                                           CoupledDiffusionVariant::Law law, Coupling coupling)
    : alpha_(parameters.alpha), beta_(parameters.beta), law_(law), coupling_(coupling) {
  if (parameters.diffusion.size() != 1) {
    throw InputError(format("%zu diffusion coefficients; the growing sphere has one species",
                            parameters.diffusion.size()));
  }
  D_ = parameters.diffusion[0];
}

double GrowingSphereProblem::normal_load(const GrowingSphere& s) const {
  const double smoothing = 2 * alpha_ * s.dr / (s.r * s.r);
  if (law_ == CoupledDiffusionVariant::dynamic) return s.ddr + 2 * s.dr * s.dr / s.r + smoothing;
  return s.dr + smoothing + 2 * beta_ / s.r;
}

ExactEvolution growing_sphere() {
  ExactEvolution exact;
  exact.quantities = {{"x", 3}, {"v", 3}, {"u", 1}};
  exact.surface = [](double t) { return sphere(GrowingSphere(t).r); };
  exact.trajectories = [](const Field& x0, double t) -> Field { return GrowingSphere(t).r * x0; };
  exact.fields = [](double t, const SurfacePoints& at, FieldsAtPoints& out) {
    const GrowingSphere s(t);
    const double rate = s.dr / s.r;
    const Pack(&y)[3] = at.y;
    for (int i = 0; i < 3; ++i) {
      out.value[i] = y[i];
      out.value[3 + i] = rate * y[i];
      for (int j = 0; j < 3; ++j) {
        out.gradient[i][j] = at.projection(i, j);
        out.gradient[3 + i][j] = rate * at.projection(i, j);
      }
    }
    out.value[6] = s.a * y[0] * y[1] * y[2];
    const Pack in_space[3] = {s.a * y[1] * y[2], s.a * y[2] * y[0], s.a * y[0] * y[1]};
    const Pack along_normal = dot(at.normal, in_space);
    for (int j = 0; j < 3; ++j) out.gradient[6][j] = in_space[j] - along_normal * at.normal[j];
  };
  return exact;
}

CoupledDiffusionState exact_growing_sphere_state(const SurfaceSpace& space, const ExactEvolution& exact,
                                                 const Field& x0, double t) {
  Field x = exact.trajectories(x0, t);
  const Field values = exact.nodal_values(x, t);
  return coupled_diffusion_state(space, t, std::move(x), values.middleCols(exact.column("v"), 3),
                                 values.col(exact.column("u")));
}

}  // namespace esfem
