// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/all_orders_problems.hpp"

#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>

#include "experiments/harness/all_orders_runs.hpp"
#include "experiments/harness/growing_sphere_runs.hpp"
#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/flows/cahn_hilliard.hpp"
#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/helfrich_law.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/problems/evolving_ellipsoid.hpp"
#include "solver/problems/exact_states.hpp"
#include "solver/problems/power_law_sphere.hpp"
#include "solver/surfaces/angenent_torus.hpp"

namespace esfem {
namespace {

/// The initial surface of one run, with the finite element space on it.
struct InitialSurface {
  Mesh mesh;
  SurfaceSpace space;
  InitialSurface(const Surface& surface, const Mesh& triangles, int degree)
      : mesh(initial_mesh(
            {}, 0, [&] { return triangles; }, surface, degree)),
        space(mesh) {}
};

/// Edges along the profile of the self-shrinking torus are like r^grading, r the distance from the axis. On
/// grids of equal edges the errors at the hole, where r = 0.44, show no order until 14,000 nodes: for P4
/// those of nu are twenty times as large on as many nodes.
constexpr double grading = 0.5;

/// The arclengths s_0, .., s_n that cut the profile into n edges of sizes like r^grading.
std::vector<double> graded_arclengths(int n) {
  const AngenentProfile& profile = angenent_profile();
  const int samples = 200 * n;
  const double ds = profile.length() / samples;
  std::vector<double> measure{0};  // int r^-grading ds
  for (int i = 0; i < samples; ++i)
    measure.push_back(measure.back() + std::pow(profile.at((i + 0.5) * ds).position[0], -grading) * ds);
  std::vector<double> cuts;
  for (int i = 0, at = 0; i <= n; ++i) {
    const double wanted = measure.back() * i / n;
    while (at + 1 < samples && measure[at + 1] < wanted) ++at;
    cuts.push_back((at + (wanted - measure[at]) / (measure[at + 1] - measure[at])) * ds);
  }
  return cuts;
}

/// The self-shrinking torus, twice as many cells around the axis as along the profile, whose edges are h long
/// on average.
Mesh angenent_grid(double h) {
  // Of an odd number of cells not all diagonals can alternate.
  const int n = 2 * static_cast<int>(std::lround(angenent_profile().length() / h / 2));
  const std::vector<double> s = graded_arclengths(n);
  Mesh mesh = torus_grid(2, 1, 2 * n, n);
  for (int j = 0; j < mesh.nodes.rows(); ++j) {
    const double x = mesh.nodes(j, 0), y = mesh.nodes(j, 1), z = mesh.nodes(j, 2), rho = std::hypot(x, y);
    // The profile begins at the inner equator and goes upwards.
    const int i = (static_cast<int>(std::lround(std::atan2(z, 2 - rho) / turn * n)) + n) % n;
    const Eigen::Vector2d p = angenent_profile().at(s[i]).position;
    mesh.nodes.row(j) << p[0] * x / rho, p[0] * y / rho, p[1];
  }
  return mesh;
}

// A problem of each flow: the flow on a mesh, its states of the exact solution, and what errors are taken of.
// Where the exact solution is not known, `exact` says the quantities alone.

/// The self-shrinking torus under (5.1).
struct MeanCurvatureOnTorus {
  using Flow = MeanCurvatureFlow;
  InitialSurface on;
  ExactEvolution exact = shrinking_angenent_torus();

  MeanCurvatureOnTorus(int degree, double h, double) : on(angenent_torus(), angenent_grid(h), degree) {}
  Flow flow() const { return {on.space, {}}; }
  Flow::State state(double t) const { return exact_mean_curvature_state(exact, on.mesh.nodes, t); }
};

/// The same torus by (5.1) with the velocity of minimal deformation rate, with which it shrinks as a whole.
struct MinimalDeformationOnTorus {
  using Flow = MeanCurvatureFlow;
  InitialSurface on;
  ExactEvolution exact = homothetic_angenent_torus();

  MinimalDeformationOnTorus(int degree, double h, double) : on(angenent_torus(), angenent_grid(h), degree) {}
  Flow flow() const {
    MeanCurvatureFlow::Variant variant;
    variant.tangential = variant.minimal_deformation;
    return {on.space, variant};
  }
  Flow::State state(double t) const { return exact_mean_curvature_state(exact, on.mesh.nodes, t); }
};

/// The same torus by Dziuk's scheme; nu and H from kappa = M^-1 A x.
struct DziukOnTorus {
  using Flow = DziukFlow;
  InitialSurface on;
  ExactEvolution exact = shrinking_angenent_torus();

  DziukOnTorus(int degree, double h, double) : on(angenent_torus(), angenent_grid(h), degree) {}
  Flow flow() const { return Flow(on.space); }
  Flow::State state(double t) const { return exact_dziuk_state(exact, on.mesh.nodes, t); }
};

const PowerLaw squared_curvature(2);

/// v = -H² nu of a sphere.
struct PowerLawOnSphere {
  using Flow = GeneralisedMeanCurvatureFlow;
  static constexpr double radius = 2;
  InitialSurface on;
  ExactEvolution exact = power_law_sphere(radius, squared_curvature);

  PowerLawOnSphere(int degree, double h, double)
      : on(sphere(radius), generate_mesh(sphere(radius), h), degree) {}
  Flow flow() const { return {on.space, squared_curvature}; }
  Flow::State state(double t) const {
    return exact_generalised_mean_curvature_state(exact, on.mesh.nodes, t);
  }
};

/// v = -H² nu of an ellipsoid, on which the normals of moving nodes change.
struct PowerLawOnEllipsoid {
  using Flow = GeneralisedMeanCurvatureFlow;
  const Surface surface = ellipsoid(2, 2, 1.6);
  ExactEvolution exact;
  InitialSurface on;
  Flow::State start;

  PowerLawOnEllipsoid(int degree, double h, double) : on(surface, generate_mesh(surface, h), degree) {
    const Field u = mean_curvature_state_on(surface, on.mesh.nodes).u;
    start = generalised_mean_curvature_state(squared_curvature, on.mesh.nodes, u.leftCols(3), u.col(3));
    exact.quantities = {{"x", 3}, {"v", 3}, {"nu", 3}, {"V", 1}};
  }
  Flow flow() const { return {on.space, squared_curvature}; }
  const Flow::State& state(double) const { return start; }
};

struct CoupledOnSphere {
  using Flow = CoupledDiffusion<GrowingSphereProblem>;
  InitialSurface on;
  ExactEvolution exact = growing_sphere();

  CoupledOnSphere(int degree, double h, double) : on(sphere(1), generate_mesh(sphere(1), h), degree) {}
  Flow flow() const { return growing_sphere_flow(on.space, {}); }
  Flow::State state(double t) const { return exact_growing_sphere_state(on.space, exact, on.mesh.nodes, t); }
};

/// Cahn-Hilliard on the ellipsoid, with Ritz maps as starting values, and theta.
struct CahnHilliardOnEllipsoid {
  using Flow = CahnHilliard<ManufacturedCahnHilliard::Problem>;
  ManufacturedCahnHilliard manufactured{EvolvingEllipsoid{}, 0.5};
  InitialSurface on;
  mutable MovingNodes nodes;
  ExactEvolution exact;

  /// tau: the nodes move by steps of this size.
  CahnHilliardOnEllipsoid(int degree, double h, double tau)
      : on(sphere(1), generate_mesh(sphere(1), h), degree),
        nodes(manufactured.ellipsoid().velocity(), on.mesh.nodes, tau, MovingNodes::all),
        exact(exact_evolution(manufactured, nodes)) {}
  CahnHilliardOnEllipsoid(const CahnHilliardOnEllipsoid&) = delete;  // `exact` refers to other members
  Flow flow() const {
    return {on.space, manufactured.problem(), [this](double t) -> const Field& { return nodes.at(t); },
            manufactured.epsilon(),
            cahn_hilliard_theta(on.space, DoubleWell(), manufactured.epsilon(), state(0))};
  }
  Flow::State state(double t) const {
    return exact_cahn_hilliard_state(on.space, manufactured, nodes.at(t), t, StartValues::ritz);
  }
};

/// Without projections. Helfrich flow has spontaneous curvature, and keeps area and volume.
WillmoreFlow::Variant willmore_variant(bool is_helfrich, const SurfaceSpace& space, const Field& x) {
  WillmoreFlow::Variant variant;
  variant.projection = WillmoreFlow::Variant::none;
  if (!is_helfrich) return variant;
  variant.law = helfrich_law(1);
  variant.prescribed = {constant_target(space.area(x)), constant_target(space.volume(x))};
  return variant;
}

/// The Clifford torus, which is stationary, with theta. It is stationary under Helfrich flow, too: with |A|²
/// = H² - 2 K what H_0 adds to Q is 2 H_0 K - H_0² H/2, and K = H/r - 1/r² on a torus of minor radius r; so
/// lambda_A = 2 H_0/r - H_0²/2 and lambda_V = -2 H_0/r².
template <bool is_helfrich>
struct WillmoreOnTorus {
  using Flow = WillmoreFlow;
  static constexpr double major = 1;
  const double minor = std::sqrt(0.5);
  ExactEvolution exact = stationary_torus(major, minor);
  InitialSurface on;
  WillmoreFlow::Variant variant;
  WillmoreStart start;

  /// h: the edges at the outer equator.
  WillmoreOnTorus(int degree, double h, double)
      : on(torus(major, minor), isothermal_torus_grid(major, minor, cells(h), cells(h)), degree),
        variant(willmore_variant(is_helfrich, on.space, on.mesh.nodes)),
        start(willmore_start_on(on.space, exact.surface(0), on.mesh.nodes, variant.law, true,
                                variant.prescribed)) {}
  Flow flow() const { return {on.space, variant, start.theta}; }
  Flow::State state(double t) const {
    Flow::State state = start.state;
    state.t = t;
    return state;
  }

 private:
  int cells(double h) const {
    const double outer_equator = turn * (major + minor);
    return 2 * static_cast<int>(std::lround(outer_equator / h / 2));
  }
};

/// An ellipsoid that becomes round, or becomes a vesicle.
template <bool is_helfrich>
struct WillmoreOnEllipsoid {
  using Flow = WillmoreFlow;
  const Surface surface = ellipsoid(2, 2, 1.6);
  ExactEvolution exact;
  InitialSurface on;
  WillmoreFlow::Variant variant;
  WillmoreStart start;

  WillmoreOnEllipsoid(int degree, double h, double)
      : on(surface, generate_mesh(surface, h), degree),
        variant(willmore_variant(is_helfrich, on.space, on.mesh.nodes)),
        start(willmore_start_on(on.space, surface, on.mesh.nodes, variant.law, false, variant.prescribed)) {
    exact.quantities = {{"x", 3}, {"nu", 3}, {"H", 1}, {"w", 4}};
  }
  Flow flow() const { return {on.space, variant}; }
  const Flow::State& state(double) const { return start.state; }
};

}  // namespace

/// A step with the velocity of minimal deformation rate takes several times as long as others: its runs end
/// sooner, and in time P4 has a coarser mesh.
const std::vector<OrdersOfFlow>& orders_of_flows() {
  // clang-format off
  static const std::vector<OrdersOfFlow> flows = {
      {"mean_curvature", "self-shrinking torus", {"x", "v", "nu", "H"},
       {0.2, 0.02}, {0.235, 0.47, 0.63, 0.75}, {4, 2, 2, 1, 1},
       {0.2, 0.02}, 0.08, {0.63, 0.94, 1.25, 0.94}, {2, 2, 2, 2, 2},
       113, 2.4e-6},
      {"minimal_deformation", "self-shrinking torus", {"x", "v", "nu", "H"},
       {0.08, 0.02}, {0.235, 0.47, 0.63, 0.75}, {3, 2, 2, 1, 2},
       {0.14, 0.02}, 0.06, {0.63, 0.94, 1.25, 1.25}, {2, 2, 2, 2, 2},
       113, 7e-6},
      {"dziuk", "self-shrinking torus", {"x"},
       {0.2, 0.02}, {0.235, 0.47, 0.63, 0.75}, {3, 3, 2, 2, 2},
       {0.2, 0.02}, 0.08, {0.3, 0.47, 0.75, 0.94}, {3, 3, 3, 2, 2},
       113, 1.2e-6},
      {"generalised_mean_curvature", "v = -H² nu: sphere; ellipsoid", {"x", "v", "nu", "V"},
       {0.1, 0.01}, {0.3, 0.7, 0.9, 1.1}, {5, 4, 4, 3, 3},
       {0.2, 0.02}, 0.08, {0.63, 0.94, 1.25, 1.25}, {2, 2, 2, 2, 2},
       110, 2.4e-6},
      {"coupled_diffusion", "growing sphere", {"x", "v", "u"},
       {0.2, 0.1}, {0.19, 0.38, 0.57, 0.75}, {8, 6, 5, 5, 4},
       {1, 0.1}, 0.4, {0.5, 0.8, 1.0, 1.0}, {3, 2, 3, 3, 3},
       27.5, 1.5e-6},
      {"willmore", "Clifford torus; ellipsoid", {"x", "nu", "H"},
       {0.02, 0.01}, {0.45, 0.6, 0.75, 0.85}, {3, 3, 3, 3, 3},
       {0.5, 0.1}, 0.1, {0.9, 1.25, 1.28, 1.28}, {4, 3, 4, 4, 5},
       170, 1.7e-6},
      {"helfrich", "Clifford torus; ellipsoid", {"x", "nu", "H"},
       {0.02, 0.01}, {0.45, 0.6, 0.75, 0.85}, {3, 3, 3, 3, 3},
       {0.5, 0.1}, 0.1, {0.9, 1.25, 1.28, 1.28}, {4, 3, 4, 4, 5},
       170, 4.5e-6},
      {"cahn_hilliard", "evolving ellipsoid", {"u", "w"},
       {0.2, 0.02}, {0.19, 0.38, 0.57, 0.75}, {5, 4, 3, 3, 2},
       {1, 0.2}, 0.4, {0.5, 0.8, 1.0, 1.0}, {5, 3, 3, 3, 4},
       27.5, 3e-6},
  };
  // clang-format on
  return flows;
}

double OrdersOfFlow::edge_length(int degree, int level) const {
  return space_h.at(degree - 1) * std::pow(2.0, (1 - level) / 2.0);
}

Row run_all_orders(const OrderRun& run, Row row) {
  using Runs = std::map<std::string, std::function<void(const OrderRun&, Row&)>>;
  static const Runs runs = {
      {"mean_curvature", run_problem<MeanCurvatureOnTorus>},
      {"minimal_deformation", run_problem<MinimalDeformationOnTorus>},
      {"dziuk", run_problem<DziukOnTorus>},
      {"generalised_mean_curvature", run_problem<PowerLawOnSphere, PowerLawOnEllipsoid>},
      {"coupled_diffusion", run_problem<CoupledOnSphere>},
      {"willmore", run_problem<WillmoreOnTorus<false>, WillmoreOnEllipsoid<false>>},
      {"helfrich", run_problem<WillmoreOnTorus<true>, WillmoreOnEllipsoid<true>>},
      {"cahn_hilliard", run_problem<CahnHilliardOnEllipsoid>}};
  const auto found = runs.find(run.flow.flow);
  if (found == runs.end()) throw std::logic_error("there is no problem for the flow " + run.flow.flow);
  found->second(run, row);
  return row;
}

}  // namespace esfem
