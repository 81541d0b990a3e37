// SPDX-License-Identifier: GPL-3.0-or-later
//
// Vesicles: stationary shapes of Helfrich flow with given area and volume
//
// Sample runs:  build/bin/helfrich_vesicles --preset check --output vesicles.json
//               build/bin/helfrich_vesicles --branch prolate --volume 0.8 --curvature 0 --levels 0-2
//
// Writes:       results/paper/helfrich_vesicles.{json,csv,tex}, from which plots/helfrich_vesicles.py draws
//               figures/gallery/{helfrich_energies,helfrich_vesicles}, and the surfaces as
//               results/paper/cells/helfrich_vesicles/CELL/surfaces.pvd
//
// V = Delta H + |A|² (H - H_0) - 1/2 H (H - H_0)² - lambda_A H - lambda_V decreases 1/2 int (H - H_0)² and
// keeps area and volume: kll21 (3.4)-(3.5) with this law, quadratic elements and adaptive BDF2, the
// multipliers being unknowns of each step. The normals are projected in the coefficients, and H_h and nu_h
// relaxed towards the surface: so the stationary surface does not depend on the steps.
//   prolate, oblate   from the spheroid of the same area, 4 pi, and volume
//   perturbed_oblate  from the oblate spheroid, out of round by 1e-4: one that is not stable
//   red_blood_cell    from the Evans-Fung cell; its reduced volume is changed to 0.6 during the first fifth
//                     of the run
// Energies, multipliers and profiles are compared with solutions of the axisymmetric shape equations
// (reference/independent/helfrich.json), in units of sqrt(area/(4 pi)). Errors: energy, of H_h ("flow") and
// of the mean curvature of the surface itself ("surface"), over 8 pi; lambda; and the distance of the nodes
// from the profile.
//
// Expected: order 4 in h for the energy of the surface. Prolates have the least energy for v > 0.65108,
// oblates below. Oblates with H_0 = 0 and v > 0.7497 are unstable, and those with H_0 = 1.5, v = 0.8, of
// which the perturbation grows like exp(14.61 t).
#include <cmath>

#include "experiments/harness/grid.hpp"
#include "solver/analysis/series.hpp"
#include "solver/constants.hpp"
#include "solver/flows/helfrich_law.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/geometry/discrete_curvature.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/problems/vesicle_shapes.hpp"

namespace {

using namespace esfem;
using State = WillmoreFlow::State;

// Times are for area 4 pi, and grow with its square.
const double end_time = 0.4, largest_tau = 0.002, first_tau = 1e-6, tolerance = 1e-3, relaxation = 100;
const double largest_h = 0.3;
const double stationary_speed = 1e-5, perturbation = 1e-4;

const std::vector<std::string> branches = {"prolate", "oblate", "perturbed_oblate", "red_blood_cell"};

const VesicleShape& shape_of(const Choice& choice) {
  const std::string branch = choice["branch"] == "prolate" ? "prolate" : "oblate";
  return vesicle_shape(branch, std::stod(choice["volume"]), std::stod(choice["curvature"]));
}

Surface initial_surface(const Choice& choice) {
  if (choice["branch"] == "red_blood_cell") return evans_fung_cell();
  const VesicleShape& shape = shape_of(choice);
  const double out_of_round = choice["branch"] == "perturbed_oblate" ? perturbation : 0;
  return ellipsoid((1 + out_of_round) * shape.spheroid_equator, (1 - out_of_round) * shape.spheroid_equator,
                   shape.spheroid_pole);
}

/// Graded by curvature; those of oblate spheroids, which would be fine at the edge, are meshes of the unit
/// sphere, flattened.
Mesh generated(const Choice& choice, const Surface& surface) {
  const double scale = std::pow(2, -0.5 * choice.level());
  if (choice["branch"] == "prolate" || choice["branch"] == "red_blood_cell")
    return generate_mesh(surface, largest_h * scale, scale);
  Mesh mesh = generate_mesh(sphere(1), largest_h * scale);
  const VesicleShape& shape = shape_of(choice);
  mesh.nodes *= Vec3(shape.spheroid_equator, shape.spheroid_equator, shape.spheroid_pole).asDiagonal();
  return mesh;
}

HalvedSteps time_steps(const Choice&) {
  return {end_time, largest_tau};
}

Block otherwise(bool) {
  return {{"volume", "0.8"}, {"curvature", "0"}, {"degree", 2},       {"bdf", 2},
          {"level", 0},      {"step", 0},        {"start", "cascade"}};
}

std::vector<Block> preset(bool paper) {
  if (!paper)
    return {{{"branch", "prolate"}, {"volume", {"0.8"}}, {"level", range(0, 1)}},
            {{"branch", "oblate"}, {"volume", {"0.6"}}}};
  const std::vector<int> levels = range(0, 2);
  return {{{"branch", "prolate"}, {"volume", {"0.95", "0.75"}}},
          {{"branch", "prolate"}, {"volume", {"0.7", "0.6"}}, {"level", range(0, 1)}},
          {{"branch", "prolate"}, {"volume", "0.8"}, {"curvature", {"0", "1.5"}}, {"level", levels}},
          {{"branch", "oblate"}, {"volume", {"0.7", "0.6"}}, {"level", levels}},
          {{"branch", "perturbed_oblate"}, {"volume", "0.8"}, {"curvature", "1.5"}, {"level", 1}},
          {{"branch", "red_blood_cell"}, {"volume", "0.6"}}};
}

/// There are shapes to compare with.
bool is_known(const Choice& choice) {
  if (choice["branch"] == "red_blood_cell" && choice["volume"] != "0.6")
    throw InputError("--branch red_blood_cell: the reduced volume at the end is 0.6; expected --volume 0.6");
  shape_of(choice);
  return true;
}

/// The root mean square of V without what moves the surface as a rigid body: on a mesh without symmetry it
/// drifts slowly.
double deforming_speed(const Field& x, const Field& V, const Field& nu) {
  Field rigid(x.rows(), 6);
  rigid.leftCols(3) = nu;
  for (int i = 0; i < 3; ++i) {
    const int k = (i + 1) % 3, l = (i + 2) % 3;
    rigid.col(3 + i) = x.col(k).cwiseProduct(nu.col(l)) - x.col(l).cwiseProduct(nu.col(k));
  }
  const Eigen::MatrixXd gram = rigid.transpose() * rigid;
  const Eigen::VectorXd motion = gram.completeOrthogonalDecomposition().solve(rigid.transpose() * V);
  return (V - rigid * motion).norm() / std::sqrt(double(x.rows()));
}

/// How far a surface about the x3 axis is from round: the amplitude of its second moments' part with two
/// waves, relative to their mean.
double out_of_round(const SurfaceSpace& space, const Field& x) {
  const auto moments = [](const PointData<0>& p, Integrand<3, 0>& load) {
    load.value[0] = p.x[0] * p.x[0] - p.x[1] * p.x[1];
    load.value[1] = 2.0 * p.x[0] * p.x[1];
    load.value[2] = p.x[0] * p.x[0] + p.x[1] * p.x[1];
  };
  Field load;
  space.assemble_load<0, 3, 0>(x, Field(x.rows(), 0), moments, load);
  const Eigen::RowVector3d sums = load.colwise().sum();
  return std::hypot(sums[0], sums[1]) / sums[2];
}

/// Records each step, and ends the run when the shape is stationary.
struct Observer {
  const SurfaceSpace& space;
  double H_0, scale, unit_of_time;  ///< scale: sqrt(area/(4 pi))
  RunRecorder& recorder;
  DiscreteCurvature curvature{space};

  bool operator()(int n, const State& state) {
    recorder.record(n, state);
    const Field spontaneous = Field::Constant(state.x.rows(), 1, H_0);
    curvature.compute(state.x);
    const double speed = deforming_speed(state.x, state.w.col(0), state.u.rightCols(3)) * std::pow(scale, 3);
    Series& series = recorder.series();
    series["helfrich_energy"].push_back(helfrich_energy(space, state.x, state.u.col(0), spontaneous) /
                                        (8 * pi));
    series["surface_energy"].push_back(helfrich_energy(space, state.x, curvature.H(), spontaneous) /
                                       (8 * pi));
    series["lambda_A"].push_back(state.lambda(0, Multipliers::area) * std::pow(scale, 2));
    series["lambda_V"].push_back(state.lambda(0, Multipliers::volume) * std::pow(scale, 3));
    series["speed"].push_back(speed);
    series["out_of_round"].push_back(out_of_round(space, state.x));
    return state.t < end_time / 4 * unit_of_time || speed > stationary_speed;
  }
};

double largest_change(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value / values[0] - 1));
  return largest;
}

/// The numbers that claims are about.
void describe_end(const Choice& choice, const SurfaceSpace& space, const Field& x, Row& row) {
  const VesicleShape& shape = shape_of(choice);
  const Series& series = row.series;
  const auto last = [&](const char* name) { return series.at(name).back(); };
  row.values["area_change"] = largest_change(series.at("area"));
  row.values["largest_rise"] = largest_rise(series.at("surface_energy"));
  row.values["end"] = last("t");
  row.values["worst_angle"] = last("worst_angle");
  if (choice["branch"] != "red_blood_cell") row.values["volume_change"] = largest_change(series.at("volume"));
  if (choice["branch"] == "perturbed_oblate") {
    row.values["growth_rate"] = growth_rate(series.at("t"), series.at("out_of_round"), end_time / 2);
    return;
  }
  row.errors["energy"]["flow"] = std::abs(last("helfrich_energy") - shape.energy);
  row.errors["energy"]["surface"] = std::abs(last("surface_energy") - shape.energy);
  row.errors["lambda_A"]["relative"] = std::abs(last("lambda_A") / shape.lambda_A - 1);
  row.errors["lambda_V"]["relative"] = std::abs(last("lambda_V") / shape.lambda_V - 1);
  row.errors["profile"]["distance"] = distance_from(shape, space, x);
  row.values["energy"] = last("surface_energy");
  row.values["reference_energy"] = shape.energy;
  row.values["reduced_volume"] = reduced_volume(last("area"), last("volume"));
  row.values["speed"] = last("speed");
}

void run(const Choice& choice, Row& row, const std::string& folder) {
  // 1. The initial surface and the finite element space on it.
  const Surface surface = initial_surface(choice);
  const auto generate = [&] { return generated(choice, surface); };
  const Mesh mesh = initial_mesh(choice, generate, surface);
  const SurfaceSpace space(mesh, choice.quadrature());
  describe_mesh(mesh, row);

  // 2. The flow, with the area and the volume of the discrete surface, from the exact normal and mean
  //    curvature.
  const VesicleShape& shape = shape_of(choice);
  const double area = space.area(mesh.nodes), volume = space.volume(mesh.nodes),
               scale = std::sqrt(area / (4 * pi)),
               unit_of_time = choice["branch"] == "red_blood_cell" ? std::pow(scale, 4) : 1;
  WillmoreFlow::Variant variant;
  variant.law = helfrich_law(shape.H_0 / scale);
  variant.prescribed.area = constant_target(area);
  variant.prescribed.volume =
      choice["branch"] == "red_blood_cell"
          ? smooth_target(volume, volume_of(area, shape.reduced_volume), 0, 0.2 * end_time * unit_of_time)
          : constant_target(volume);
  variant.projection = WillmoreFlow::Variant::in_coefficients;
  variant.relaxation = relaxation / unit_of_time;
  const WillmoreStart start =
      willmore_start_on(space, surface, mesh.nodes, variant.law, false, variant.prescribed);
  WillmoreFlow flow(space, variant);

  // 3. The time steps, and the row of the table.
  RunRecorder recorder(space, snapshot_plan(folder, {}, "helfrich", row));
  Observer observe{space, shape.H_0 / scale, scale, unit_of_time, recorder};
  run_recorded(flow,
               AdaptiveSteps{"u", 2, end_time * unit_of_time, tolerance, first_tau * unit_of_time,
                             row.tau * unit_of_time},
               start.state, folder, recorder, row, observe);
  describe_end(choice, space, recorder.newest().x, row);
}

/// A step takes about 10 microseconds a node: three right-hand sides, and the records.
double cost(const Choice& choice) {
  const double nodes = 1000 * std::pow(2.0, choice.level());
  return 300 * nodes * 1e-5;
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("helfrich_vesicles", "esfem", run, otherwise, preset);
  experiment.help =
      "Helfrich flow with prescribed area and volume to stationary vesicles: energies, multipliers and "
      "profiles\n"
      "against solutions of the axisymmetric shape equations, for reduced volumes v and spontaneous "
      "curvatures\n"
      "H_0 in units of sqrt(area/(4 pi)). Edge lengths at most 0.3 2^(-j/2), level j = 0, 1, .. No units.\n\n"
      "Example: helfrich_vesicles --branch prolate --volume 0.8 --curvature 0 --levels 0-2 --output "
      "table.json";
  experiment.grid.axes = {
      {"branch", branches,
       "prolate, oblate: from spheroids | perturbed_oblate: out of round by 1e-4 | red_blood_cell: from the "
       "Evans-Fung cell"},
      {"volume", {"0.95", "0.8", "0.75", "0.7", "0.6"}, "the reduced volume 6 sqrt(pi) volume/area^(3/2)"},
      {"curvature", {"0", "1.5"}, "the spontaneous curvature H_0"}};
  experiment.grid.labels = {"branch", "volume", "curvature"};
  experiment.grid.admits = is_known;
  const std::string why = "surfaces and steps are those of the experiment (evolve takes any)";
  experiment.grid.refused = {{"mesh", why}, {"step", why}, {"bdf", why}, {"start", why}};
  experiment.steps = time_steps;
  experiment.cost = cost;
  experiment.parameters = {{"end_time", end_time},
                           {"tau", "the largest, in units of (area/(4 pi))²"},
                           {"tolerance", tolerance},
                           {"relaxation", relaxation},
                           {"stationary_speed", stationary_speed}};
  experiment.meshes = "generated, edge length 0.3 2^(-level/2), graded by curvature";
  return run_experiment(experiment, argc, argv);
}
