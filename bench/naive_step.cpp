// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/naive_step.hpp"

#include <Eigen/Sparse>
#include <vector>

#include "solver/fe/lagrange.hpp"

namespace esfem {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

struct System {
  Sparse M, A;
  Field load;  ///< N x 7, as in mean_curvature_load of bench_step.cpp
};

System assemble(const Mesh& mesh, const Quadrature& rule, const Field& u) {
  const ShapeTable shape = shape_functions(mesh.degree, rule.points);
  const int n = static_cast<int>(mesh.elements.cols());
  const int dofs = static_cast<int>(mesh.nodes.rows());
  std::vector<Eigen::Triplet<double>> mass, stiffness;
  System system;
  system.load = Field::Zero(dofs, 7);
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    Eigen::MatrixXd element_mass = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd element_stiffness = Eigen::MatrixXd::Zero(n, n);
    for (int q = 0; q < rule.points.rows(); ++q) {
      Vec3 t1 = Vec3::Zero(), t2 = Vec3::Zero();
      for (int a = 0; a < n; ++a) {
        t1 += shape.dxi(q, a) * mesh.nodes.row(mesh.elements(e, a)).transpose();
        t2 += shape.deta(q, a) * mesh.nodes.row(mesh.elements(e, a)).transpose();
      }
      const double g11 = t1.dot(t1), g12 = t1.dot(t2), g22 = t2.dot(t2), det = g11 * g22 - g12 * g12;
      const Vec3 dual1 = (g22 * t1 - g12 * t2) / det, dual2 = (g11 * t2 - g12 * t1) / det;
      const double weight = rule.weights[q] * std::sqrt(det);
      Vec3 gradient[15];
      for (int a = 0; a < n; ++a) gradient[a] = shape.dxi(q, a) * dual1 + shape.deta(q, a) * dual2;

      Eigen::Vector4d value = Eigen::Vector4d::Zero();
      Eigen::Matrix<double, 4, 3> grad_u = Eigen::Matrix<double, 4, 3>::Zero();
      for (int a = 0; a < n; ++a) {
        value += shape.value(q, a) * u.row(mesh.elements(e, a)).transpose();
        grad_u += u.row(mesh.elements(e, a)).transpose() * gradient[a].transpose();
      }
      const double grad_nu_squared = grad_u.topRows<3>().squaredNorm();
      for (int a = 0; a < n; ++a) {
        const int row = mesh.elements(e, a);
        for (int l = 0; l < 3; ++l) {
          const Vec3 flux = value[3] * grad_u.row(l) + value[l] * grad_u.row(3);
          system.load(row, l) -= weight * (value[3] * value[l] * shape.value(q, a) + flux.dot(gradient[a]));
        }
        for (int l = 0; l < 4; ++l)
          system.load(row, 3 + l) += weight * grad_nu_squared * value[l] * shape.value(q, a);
        for (int b = 0; b < n; ++b) {
          element_mass(a, b) += weight * shape.value(q, a) * shape.value(q, b);
          element_stiffness(a, b) += weight * gradient[a].dot(gradient[b]);
        }
      }
    }
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b) {
        mass.emplace_back(mesh.elements(e, a), mesh.elements(e, b), element_mass(a, b));
        stiffness.emplace_back(mesh.elements(e, a), mesh.elements(e, b), element_stiffness(a, b));
      }
  }
  system.M.resize(dofs, dofs);
  system.A.resize(dofs, dofs);
  system.M.setFromTriplets(mass.begin(), mass.end());
  system.A.setFromTriplets(stiffness.begin(), stiffness.end());
  return system;
}

}  // namespace

Field naive_step(const Mesh& mesh, const Quadrature& rule, const Field& u, double mass_factor) {
  const System system = assemble(mesh, rule, u);
  Eigen::SimplicialLLT<Sparse> solver;
  Field out(mesh.nodes.rows(), 7);
  solver.compute(Sparse(system.M + system.A));
  out.leftCols(3) = solver.solve(system.load.leftCols(3));
  solver.compute(Sparse(mass_factor * system.M + system.A));
  out.rightCols(4) = solver.solve(system.load.rightCols(4));
  return out;
}

}  // namespace esfem
