// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/dziuk_willmore_flow.hpp"

#include "solver/error.hpp"
#include "solver/geometry/discrete_curvature.hpp"
#include "solver/geometry/l2_project.hpp"
#include "solver/geometry/regularity.hpp"
#include "solver/linalg/node_block_lu.hpp"

namespace esfem {

// The first variation. The load A(x) x is the derivative of the area, so that its own derivative in direction
// phi, tested by w, is a symmetric form B(w, phi), the second variation of the area. With
//   A'[phi](u, z) = (div phi grad u, grad z) - (D(phi) grad u, grad z)
// and grad x : grad w = div w it is
//   B(w, phi) = (grad w, grad phi) + (div w, div phi) - (D(phi) grad x, grad w).
// The derivative of M w = -A x is M w' = -B phi - M'[phi] w, hence
//   (1/2 w^T M w)' = w^T M w' + 1/2 w^T M'[phi] w = -B(w, phi) - 1/2 (|w|², div phi),
// which is minus the right-hand side of (2.13).

/// The matrix of B(w, phi) on Gamma_h[x]. Since grad x = I - nu nu^T, the functions phi_p e_a and phi_q e_b
/// have
///   int (g_p . g_q) nu_a nu_b + (g_p)_a (g_q)_b - (g_p)_b (g_q)_a,   g = grad phi,
/// where the last two terms are those of the vector c = int g_p x g_q: epsilon_abk c_k.
class AreaHessian {
 public:
  explicit AreaHessian(const SurfaceSpace& space);
  void assemble(const Field& x);
  /// See NodeBlockLu::factorise.
  double entry(int k, bool above, int a, int b) const {
    const auto column = values_.col(k);
    const double symmetric = column[a <= b ? place(a, b) : place(b, a)];
    if (a == b) return symmetric;
    const double skew = ((b - a + 3) % 3 == 1 ? 1 : -1) * column[6 + 3 - a - b];
    return symmetric + (above ? -skew : skew);
  }

 private:
  struct Block {
    Pack entry[9];  ///< the symmetric part 00, 01, 02, 11, 12, 22, and c
  };
  static int place(int a, int b) { return a == 0 ? b : a + b + 1; }
  void add_point(const Batch& batch, int q, const BatchPoint& point);
  void scatter(int batch);

  ElementBatches batches_;
  std::vector<std::pair<int, int>> pairs_;  ///< local nodes p >= q
  std::vector<int> position_;               ///< batches x pairs x lanes: where it goes in values_
  std::vector<double> orientation_;         ///< -1 where it is the transposed block
  std::vector<Block> block_;                ///< work space: one a pair
  Eigen::Matrix<double, 9, Eigen::Dynamic> values_;
};

AreaHessian::AreaHessian(const SurfaceSpace& space)
    : batches_(space.elements(), space.degree(), space.quadrature()),
      values_(9, space.pattern()->entry_count()) {
  for (int p = 0; p < batches_.nodes(); ++p)
    for (int q = 0; q <= p; ++q) pairs_.emplace_back(p, q);
  block_.resize(pairs_.size());
  for (int batch = 0; batch < batches_.count(); ++batch)
    for (const auto& [p, q] : pairs_)
      for (int lane = 0; lane < pack_size; ++lane) {
        const auto element = space.elements().row(batches_.element(batch, lane));
        position_.push_back(space.pattern()->entry(element[p], element[q]));
        orientation_.push_back(element[p] >= element[q] ? 1 : -1);
      }
}

void AreaHessian::add_point(const Batch& batch, int q, const BatchPoint& point) {
  const Pack weight = batch.one * batches_.weight(q) * point.inverse_jacobian;
  const Pack scale = weight * point.inverse_jacobian * point.inverse_jacobian;
  const Pack xi_xi = dot(point.tangent_eta, point.tangent_eta),
             eta_eta = dot(point.tangent_xi, point.tangent_xi),
             xi_eta = -dot(point.tangent_xi, point.tangent_eta);
  Pack normals[6];
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) normals[place(a, b)] = scale * point.normal[a] * point.normal[b];
  const ElementBatches::Shape* shape = batches_.shapes(q);
  for (std::size_t pair = 0; pair < pairs_.size(); ++pair) {
    const ElementBatches::Shape &f = shape[pairs_[pair].first], &g = shape[pairs_[pair].second];
    // grad f . grad g and |grad f x grad g|, both times the square of the Jacobian, and once more in the
    // latter.
    const Pack product =
        f.dxi * g.dxi * xi_xi + (f.dxi * g.deta + f.deta * g.dxi) * xi_eta + f.deta * g.deta * eta_eta;
    const double cross = f.dxi * g.deta - f.deta * g.dxi;
    for (int i = 0; i < 6; ++i) block_[pair].entry[i] += product * normals[i];
    for (int k = 0; k < 3; ++k) block_[pair].entry[6 + k] += cross * weight * point.normal[k];
  }
}

void AreaHessian::scatter(int batch) {
  std::size_t next = batch * pairs_.size() * pack_size;
  for (const Block& block : block_)
    for (int lane = 0; lane < pack_size; ++lane, ++next) {
      auto column = values_.col(position_[next]);
      for (int i = 0; i < 6; ++i) column[i] += block.entry[i][lane];
      for (int i = 6; i < 9; ++i) column[i] += orientation_[next] * block.entry[i][lane];
    }
}

void AreaHessian::assemble(const Field& x) {
  values_.setZero();
  Batch batch;
  BatchPoint point;
  for (int b = 0; b < batches_.count(); ++b) {
    batches_.load(b, x, batch);
    for (Block& block : block_) block = {};
    Lanes regular = ~Lanes{};
    for (int q = 0; q < batches_.points(); ++q) {
      regular &= batches_.evaluate(batch, q, point);
      add_point(batch, q, point);
    }
    batches_.require_regular(regular, batch);
    scatter(b);
  }
}

/// With the old nodes x and w, both on the old surface, and the increments dx and dw, the two equations are
///   1/tau M dx - B dw = force(x, w),
///   A dx + M dw = -A x - M w,
/// with B dx for A dx in the linearised scheme. Unknowns and equations go node by node, dx_1, dx_2, dx_3,
/// dw_1, dw_2, dw_3.
struct DziukWillmoreFlow::System {
  Curvature curvature;
  SymmetricMatrix M, A;
  AreaHessian B;
  NodeBlockLu lu;
  Field force, Ax, Mw;
  Eigen::VectorXd right, solution;

  System(const SurfaceSpace& space, Curvature curvature);
  void assemble(const SurfaceSpace& space, const Field& x, const Field& w);
  void factorise(double tau);
};

DziukWillmoreFlow::System::System(const SurfaceSpace& space, Curvature curvature)
    : curvature(curvature),
      M(space.matrix()),
      A(M),
      B(space),
      lu(*space.pattern(),
         curvature == dziuk
             ? NodeBlockLu::BlockRows{{0, 3}, {1, 4}, {2, 5}, {0, 1, 2, 3}, {0, 1, 2, 4}, {0, 1, 2, 5}}
             : NodeBlockLu::BlockRows{{0, 3, 4, 5},
                                      {1, 3, 4, 5},
                                      {2, 3, 4, 5},
                                      {0, 1, 2, 3},
                                      {0, 1, 2, 4},
                                      {0, 1, 2, 5}}),
      right(6 * space.dofs()),
      solution(6 * space.dofs()) {}

void DziukWillmoreFlow::System::assemble(const SurfaceSpace& space, const Field& x, const Field& w) {
  space.assemble(x, M, A);
  B.assemble(x);
  assemble_willmore_force(space, x, w, force);
  A.multiply(x, Ax);
  M.multiply(w, Mw);
  for (int j = 0; j < x.rows(); ++j)
    right.segment<6>(6 * j) << force.row(j).transpose(), -(Ax.row(j) + Mw.row(j)).transpose();
}

void DziukWillmoreFlow::System::factorise(double tau) {
  lu.factorise([&](int k, bool above, int a, int b) {
    if (a < 3 && b < 3) return M.values[k] / tau;
    if (a < 3) return -B.entry(k, above, a, b - 3);
    if (b >= 3) return M.values[k];
    return curvature == dziuk ? A.values[k] : B.entry(k, above, a - 3, b);
  });
}

DziukWillmoreFlow::DziukWillmoreFlow(const SurfaceSpace& space, Curvature curvature)
    : space_(space), system_(std::make_unique<System>(space, curvature)) {}

DziukWillmoreFlow::~DziukWillmoreFlow() = default;
DziukWillmoreFlow::DziukWillmoreFlow(DziukWillmoreFlow&&) = default;

void DziukWillmoreFlow::step(const BdfStep<State>& step, State& next) {
  if (step.order != 1) {
    throw InputError(
        format("BDF order %d: expected 1, the order of Dziuk's scheme for Willmore flow", step.order));
  }
  const double tau = step.tau;
  const State& old = step.past(0);
  System& system = *system_;
  system.assemble(space_, old.x, old.w);
  system.factorise(tau);
  system.lu.solve(system.right, system.solution);
  for (int j = 0; j < old.x.rows(); ++j) {
    next.v.row(j) = system.solution.segment<3>(6 * j) / tau;
    next.w.row(j) = old.w.row(j) + system.solution.segment<3>(6 * j + 3).transpose();
  }
  next.x = old.x + tau * next.v;
  require_regular(space_, next.x, next.w);
}

void assemble_willmore_force(const SurfaceSpace& space, const Field& x, const Field& w, Field& out) {
  const auto integrand = [](const PointData<3>& p, Integrand<3, 3>& load) {
    const Pack half_square = 0.5 * dot(p.u, p.u), divergence = p.grad[0][0] + p.grad[1][1] + p.grad[2][2];
    for (int l = 0; l < 3; ++l) {
      load.value[l] = Pack{};
      // phi = phi_j e_l has D(phi) = g e_l^T + e_l g^T with g = grad phi_j, and grad x = I - nu nu^T, so that
      // D(phi) grad x : grad w = sum_i g_i (grad w_i)_l + g . grad w_l - nu_l g . (grad w nu).
      Pack normal_part[3];
      for (int i = 0; i < 3; ++i)
        normal_part[i] = p.grad[0][i] * p.normal[0] + p.grad[1][i] * p.normal[1] + p.grad[2][i] * p.normal[2];
      for (int i = 0; i < 3; ++i) {
        const Pack D_term = p.grad[i][l] + p.grad[l][i] - p.normal[l] * normal_part[i];
        load.flux[l][i] = p.grad[l][i] - D_term;
      }
      load.flux[l][l] += half_square + divergence;
    }
  };
  space.assemble_load<3, 3, 3>(x, w, integrand, out);
}

DziukWillmoreFlow::State dziuk_willmore_state_on(const SurfaceSpace& space, const Field& x) {
  DiscreteCurvature curvature(space);
  curvature.compute(x);
  DziukWillmoreFlow::State state{0, x, {}, -curvature.kappa()};
  Field force;
  assemble_willmore_force(space, x, state.w, force);
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  state.v = l2_project(M, std::move(force));
  return state;
}

NodalFields nodal_fields(const DziukWillmoreFlow::State& state) {
  return {{"v", state.v}, {"w", state.w}};
}

}  // namespace esfem
