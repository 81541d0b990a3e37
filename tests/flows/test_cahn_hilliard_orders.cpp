// SPDX-License-Identifier: GPL-3.0-or-later
// Orders in time of the Cahn-Hilliard discretisation on one mesh, against a solution with small steps on the
// same mesh; and what its parts are needed for.
#include <gtest/gtest.h>

#include "solver/flows/cahn_hilliard.hpp"
#include "solver/problems/evolving_ellipsoid.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem::test_cahn_hilliard_orders {
namespace {

using State = CahnHilliardState;
using Starts = std::function<State(double t)>;
using Flow = CahnHilliard<ManufacturedCahnHilliard::Problem>;

const double epsilon = 0.5;

/// The manufactured solution on one mesh.
struct Ellipsoid {
  ManufacturedCahnHilliard exact{EvolvingEllipsoid(), epsilon};
  Mesh mesh;
  SurfaceSpace space;
  MovingNodes nodes;
  NodalMotion motion = [this](double t) -> const Field& { return nodes.at(t); };

  Ellipsoid(int subdivisions, double tau_of_the_nodes)
      : mesh(sphere_mesh(1, 1, subdivisions)),
        space(mesh),
        nodes(exact.ellipsoid().velocity(), mesh.nodes, tau_of_the_nodes, MovingNodes::all) {}

  State exact_state(double t, StartValues values = StartValues::ritz) {
    return exact_cahn_hilliard_state(space, exact, nodes.at(t), t, values);
  }

  Field theta(const State& start) const { return cahn_hilliard_theta(space, DoubleWell(), epsilon, start); }
};

/// The semi-discrete solution by BDF5 with steps of 1/640, and runs that start from it at t = 0.4: Ritz maps
/// are off it by an error in space, of which the fast modes have died out by then.
class SemiDiscreteEllipsoid {
 public:
  SemiDiscreteEllipsoid() : on_(1, tau_), theta_(on_.theta(on_.exact_state(0))) {
    Flow flow = make_flow();
    const Starts starts = [&](double t) { return on_.exact_state(t); };
    integrate(flow, {5, tau_, 512, {}}, {starts(0), starts},
              [&](int, const State& state) { solution_.push_back(state); });
  }

  /// Order of the largest error of u or w for t in [0.4, 0.8], from steps of 1/40 and 1/80. cascade: started
  /// by BDF 1, 2, .. of the same step size, not by the semi-discrete solution.
  double order_of(Field State::*field, int q, bool cascade = false) {
    return order(error(field, q, 16, cascade), error(field, q, 8, cascade));
  }

 private:
  Flow make_flow() { return Flow(on_.space, on_.exact.problem(), on_.motion, epsilon, theta_); }

  double error(Field State::*field, int q, int ratio, bool cascade) {
    Flow flow = make_flow();
    History<State> past(q);
    State next;
    double largest = 0;
    const int begin = 256, known = cascade ? begin - (q - 1) * ratio : begin;
    for (int m = begin - (q - 1) * ratio; m <= 512; m += ratio) {
      if (m <= known) {
        next = solution_[m];
      } else {
        next.t = m * tau_;
        flow.step(past.equal_step(std::min(q, past.size()), ratio * tau_, next.t), next);
      }
      largest = std::max(largest, (next.*field - solution_[m].*field).norm());
      past.push(next);
    }
    return largest;
  }

  double tau_ = 1.0 / 640;
  Ellipsoid on_;
  Field theta_;
  std::vector<State> solution_;
};

SemiDiscreteEllipsoid& ellipsoid_in_time() {
  static SemiDiscreteEllipsoid instance;
  return instance;
}

TEST(CahnHilliardInTime, HasTheOrderOfTheBdf) {
  for (int q : {1, 2, 3, 4, 5}) {
    EXPECT_GE(ellipsoid_in_time().order_of(&State::u, q), q - 0.3) << "u, BDF" << q;
    EXPECT_GE(ellipsoid_in_time().order_of(&State::w, q), q - 0.3) << "w, BDF" << q;
  }
}

// The error of the first step of BDF1 decays: only w, which sees it at once, has order 2 in full.
TEST(CahnHilliardInTime, ACascadeOfTheSameStepLosesTheOrder) {
  for (int q : {3, 4, 5}) EXPECT_LT(ellipsoid_in_time().order_of(&State::w, q, true), 2.5) << "w, BDF" << q;
  EXPECT_LT(ellipsoid_in_time().order_of(&State::u, 5, true), 3.7) << "u, BDF5";
}

/// b as part of f, with the factor that (8.3) as printed puts before its load: 1/tau.
struct LoadInF : DoubleWell {
  const ManufacturedCahnHilliard* exact;
  double factor;

  Pack f(double t, const PointData<1>& p) const {
    Pack values;
    for (int lane = 0; lane < pack_size; ++lane)
      values[lane] = factor * exact->b(Vec3(p.x[0][lane], p.x[1][lane], p.x[2][lane]), t);
    return values;
  }
};

TEST(CahnHilliard, TheLoadNeedsTheStepSize) {
  Ellipsoid on(2, 0.0125);
  const auto error = [&](double tau, bool as_printed) {
    LoadInF problem;
    problem.exact = &on.exact;
    problem.factor = as_printed ? 1 / tau : 1;
    const State start = on.exact_state(0);
    CahnHilliard flow(on.space, problem, on.motion, epsilon, on.theta(start));
    const int steps = static_cast<int>(std::lround(0.3 / tau));
    return (last_state(flow, {1, tau, steps, {}}, start).u - on.exact_state(0.3).u).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(error(0.0125, false), 0.8 * error(0.025, false));
  EXPECT_GT(error(0.0125, true), error(0.025, true));
  EXPECT_GT(error(0.0125, true), 10 * error(0.0125, false));
}

TEST(CahnHilliard, ThetaLetsWBeginWhereItShould) {
  const auto jump_of_w = [&](double tau, bool with_theta) {
    Ellipsoid on(1, tau);
    const State start = on.exact_state(0);
    CahnHilliard flow(on.space, on.exact.problem(), on.motion, epsilon,
                      with_theta ? on.theta(start) : Field());
    return (last_state(flow, {1, tau, 1, {}}, start).w - start.w).norm();
  };
  EXPECT_GT(order(jump_of_w(2e-5, true), jump_of_w(1e-5, true)), 0.9);
  EXPECT_LT(order(jump_of_w(2e-5, false), jump_of_w(1e-5, false)), 0.1) << "without theta";
}

}  // namespace
}  // namespace esfem::test_cahn_hilliard_orders
