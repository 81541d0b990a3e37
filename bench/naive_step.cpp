// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/naive_step.hpp"

#include <Eigen/Sparse>
#include <Eigen/UmfPackSupport>
#include <vector>

#include "solver/fe/lagrange.hpp"

namespace esfem {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

struct System {
  Sparse M, A;
  Field load;
};

/// Nodal functions u at a quadrature point: values and tangential gradients, one row a component.
struct Point {
  Eigen::VectorXd u;
  Eigen::MatrixXd grad_u;
};
/// Load functionals, value phi + flux . grad phi, one row an output.
struct Load {
  Eigen::VectorXd value;
  Eigen::MatrixXd flux;
};

/// M, A and the loads that integrand(Point, Load&) gives, element by element.
template <class IntegrandFunction>
System assemble(const Mesh& mesh, const Quadrature& rule, const Field& u, int outputs,
                const IntegrandFunction& integrand) {
  const ShapeTable shape = shape_functions(mesh.degree, rule.points);
  const int n = static_cast<int>(mesh.elements.cols());
  const int dofs = static_cast<int>(mesh.nodes.rows());
  std::vector<Eigen::Triplet<double>> mass, stiffness;
  System system;
  system.load = Field::Zero(dofs, outputs);
  Point point;
  Load load;
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

      point.u.setZero(u.cols());
      point.grad_u.setZero(u.cols(), 3);
      for (int a = 0; a < n; ++a) {
        point.u += shape.value(q, a) * u.row(mesh.elements(e, a)).transpose();
        point.grad_u += u.row(mesh.elements(e, a)).transpose() * gradient[a].transpose();
      }
      load.value.setZero(outputs);
      load.flux.setZero(outputs, 3);
      integrand(point, load);
      for (int a = 0; a < n; ++a) {
        system.load.row(mesh.elements(e, a)) +=
            weight * (shape.value(q, a) * load.value + load.flux * gradient[a]).transpose();
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

/// g and f of kll19 §3.3; u = (nu, H).
void mean_curvature_loads(const Point& at, Load& load) {
  const double H = at.u[3];
  load.value.head<3>() = -H * at.u.head<3>();
  load.flux.topRows<3>() = -(H * at.grad_u.topRows<3>() + at.u.head<3>() * at.grad_u.row(3));
  load.value.tail<4>() = at.grad_u.topRows<3>().squaredNorm() * at.u;
}

/// f + F w and g of kll21 §3.3; u = (H, nu, V, z).
void willmore_loads(const Point& at, Load& load) {
  const double H = at.u[0], V = at.u[4];
  const Vec3 nu = at.u.segment<3>(1), z = at.u.tail<3>(), grad_H = at.grad_u.row(0);
  const Mat3 grad_nu = at.grad_u.middleRows<3>(1), A = 0.5 * (grad_nu + grad_nu.transpose());
  const double Q = H * A.squaredNorm() - H * H * H / 2;
  load.value[0] = -A.squaredNorm() * V;
  load.value.segment<3>(1) = (H * A - A * A) * z + (grad_H.squaredNorm() - Q * H) * nu + A * A * grad_H;
  load.flux.middleRows<3>(1) = 2 * nu * (A * grad_H).transpose() + Q * Mat3::Identity();
  load.value[4] = Q;
  load.value.tail<3>() = A.squaredNorm() * nu;
}

/// (u³ - u)/epsilon of the double well.
struct DoubleWellLoad {
  double epsilon;
  void operator()(const Point& at, Load& load) const {
    const double u = at.u[0];
    load.value[0] = (u * u * u - u) / epsilon;
  }
};

/// [alpha M, -A; gamma A, M] as one sparse matrix.
Sparse block_matrix(const System& system, double alpha, double gamma) {
  const int n = static_cast<int>(system.M.rows());
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < n; ++j) {
    for (Sparse::InnerIterator M(system.M, j), A(system.A, j); M; ++M, ++A) {
      const int i = static_cast<int>(M.row());
      entries.emplace_back(i, j, alpha * M.value());
      entries.emplace_back(i, n + j, -A.value());
      entries.emplace_back(n + i, j, gamma * A.value());
      entries.emplace_back(n + i, n + j, M.value());
    }
  }
  Sparse block(2 * n, 2 * n);
  block.setFromTriplets(entries.begin(), entries.end());
  return block;
}

}  // namespace

Field naive_step(const Mesh& mesh, const Quadrature& rule, const Field& u, double mass_factor) {
  const System system = assemble(mesh, rule, u, 7, mean_curvature_loads);
  Eigen::SimplicialLLT<Sparse> solver;
  Field out(mesh.nodes.rows(), 7);
  solver.compute(Sparse(system.M + system.A));
  out.leftCols(3) = solver.solve(system.load.leftCols(3));
  solver.compute(Sparse(mass_factor * system.M + system.A));
  out.rightCols(4) = solver.solve(system.load.rightCols(4));
  return out;
}

Field naive_willmore_step(const Mesh& mesh, const Quadrature& rule, const Field& u_w, double mass_factor) {
  const System system = assemble(mesh, rule, u_w, 8, willmore_loads);
  const Eigen::Index n = mesh.nodes.rows();
  Field right(2 * n, 4);
  right << system.load.leftCols(4), system.load.rightCols(4);
  const Sparse block = block_matrix(system, mass_factor, 1);  // the solver keeps a reference
  const Eigen::UmfPackLU<Sparse> solver(block);
  const Field solution = solver.solve(right);
  Field out(n, 8);
  out << solution.topRows(n), solution.bottomRows(n);
  return out;
}

Field naive_cahn_hilliard_step(const Mesh& mesh, const Quadrature& rule, const Field& u_tilde,
                               const Field& old, double epsilon, double mass_factor) {
  const System system = assemble(mesh, rule, u_tilde, 1, DoubleWellLoad{epsilon});
  const Eigen::Index n = mesh.nodes.rows();
  Field right(2 * n, 1);
  right << old, -system.load;  // the second unknown is -w
  const Sparse block = block_matrix(system, mass_factor, epsilon);
  const Eigen::UmfPackLU<Sparse> solver(block);
  const Field solution = solver.solve(right);
  Field out(n, 2);
  out << solution.topRows(n), -solution.bottomRows(n);
  return out;
}

}  // namespace esfem
