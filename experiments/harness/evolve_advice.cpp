// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/evolve_advice.hpp"

#include <algorithm>

#include "solver/error.hpp"

namespace esfem {

std::string thin_elements_remark(const Mesh& mesh, const MeshOrigin& origin) {
  const MeshQuality quality = mesh_quality(mesh.elements, mesh.nodes);
  const double expected = RegularityLimits().radius_ratio;
  if (origin.source.empty() || quality.min_radius_ratio >= expected) return "";
  return format(
      "%s: %s: radius ratio %.2g, at least %g expected; thin elements make the results "
      "worse and small steps necessary: \"mesh\": {.., \"remesh\": edge_length} replaces them",
      origin.source.c_str(), origin.element(quality.worst_element).c_str(), quality.min_radius_ratio,
      expected);
}

namespace {

double reinitialise(const EvolveConfig& config) {
  return config.flow == "mean_curvature" ? config.mean_curvature.reinitialise : config.willmore.reinitialise;
}

}  // namespace

bool have_parted(const EvolveConfig& config, const RunRecorder::CurvatureComparison& found) {
  const double bound = 0.25;
  if (found.rate_difference() > bound) return true;
  if (found.energy_difference() > (config.mesh.degree == 1 ? 2 * bound : bound)) return true;
  return found.deviation > bound &&
         reinitialise(config) == 0;  // what comes from the surface has not parted from it
}

std::string curvature_remark(const RunRecorder::CurvatureComparison& found, double t) {
  return format(
      "nu and H, which the flow evolves, differ from those of the surface at t = %g: H nu by %.0f%%; 1/2 int "
      "H² is "
      "%.4g, 1/2 int |kappa|² of the surface %.4g; the area changes at the rate %.4g, int H nu . v is %.4g",
      t, 100 * found.deviation, found.energy, found.kappa_energy, found.rates.of_surface,
      found.rates.of_fields);
}

std::string sliding_remark(const Series& series) {
  const std::vector<double>&t = series.at("t"), &area = series.at("area"), &W = series.at("willmore_energy");
  const double taken = area[0] - area[1], expected = (t[1] - t[0]) * 2 * std::max(W[0], W[1]);
  if (taken <= 0.005 * area[0] || taken <= 3 * expected) return "";
  return format(
      "the first step takes %.3g of the area %.4g, where mean curvature flow takes about %.2g: nodes have "
      "slid off "
      "edges of the surface; try \"flow\": \"dziuk\", or a finer mesh",
      taken, area[0], expected);
}

std::string curvature_cure(const EvolveConfig& config) {
  const std::string mesh =
      "a mesh that resolves the curvature (a finer one; \"curve\", \"remesh\" of a mesh file)";
  if (config.flow == "mean_curvature")
    return "try \"variant\": {\"reinitialise\": 0.05}, \"flow\": \"dziuk\", or " + mesh;
  return "try \"variant\": {\"relaxation\": ..} or {\"reinitialise\": 0.05}, or " + mesh;
}

std::string extinction(double end, const Series& series) {
  const std::vector<double>& area = series.at("area");
  return format("extinct at t = %g: of the area %g is left of %g at the start, and none there", end,
                area.back(), area.front());
}

std::string cure(const EvolveConfig& config) {
  const bool curved = config.mesh.degree > 1;
  const std::string degree = curved ? " with \"degree\": 1" : "";
  const std::string steps = config.adaptive ? "a smaller tolerance and first_step" : "smaller steps";
  const std::string mesh = "even elements (\"remesh\" of a mesh file)";
  // Of 125 closed meshes that are about, each runs with one of these flows.
  if (config.flow == "mean_curvature")
    return "try \"flow\": \"dziuk\" or \"bgn\"" + degree + "; on some meshes " + mesh +
           (curved ? " " : ", \"variant\": {\"normalise\": true} ") + "or " + steps + " are enough";
  // In its first step, however small, this flow slides its nodes.
  if (config.flow == "bgn")
    return "try \"flow\": \"dziuk\"" + degree + "; on some meshes " + mesh + " are enough";
  if (config.flow == "dziuk")
    return "try \"flow\": \"bgn\"" + degree + "; on some meshes " + mesh + " or " + steps +
           " with \"bdf\": 1 are enough";
  if (config.flow == "willmore" || config.flow == "surface_diffusion")
    return "try " + steps + ", \"variant\": {\"relaxation\": ..}, or " + mesh;
  return "try " + steps + ", or " + mesh;
}

}  // namespace esfem
