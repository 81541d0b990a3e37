// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/advice.hpp"

#include <algorithm>
#include <cmath>

#include "solver/analysis/diagnostics.hpp"
#include "solver/error.hpp"
#include "solver/geometry/regularity.hpp"

namespace esfem {

std::string thin_elements_remark(const Mesh& mesh, const MeshOrigin& origin) {
  const MeshQuality quality = mesh_quality(mesh.elements, mesh.nodes);
  const double expected = RegularityLimits().radius_ratio;
  if (origin.source.empty() || quality.min_radius_ratio >= expected) return "";
  return format(
      "%s: %s: radius ratio %.2g, at least %g expected; thin elements increase the "
      "errors and require small steps: \"mesh\": {.., \"remesh\": edge_length} replaces them",
      origin.source.c_str(), origin.element(quality.worst_element).c_str(), quality.min_radius_ratio,
      expected);
}

bool have_parted(const EvolveConfig& config, const RunRecorder::CurvatureComparison& found) {
  const double bound = 0.25;
  if (found.rate_difference() > bound) return true;
  if (found.energy_difference() > (config.mesh.degree == 1 ? 2 * bound : bound)) return true;
  return found.deviation > bound &&
         !config.variant.has("reinitialise");  // values recomputed from the surface do not deviate
}

std::string curvature_remark(const RunRecorder::CurvatureComparison& found, double t) {
  return format(
      "nu and H, which the flow evolves, differ from those of the surface at t = %g: H nu by %.0f%%; 1/2 int "
      "H² is %.4g, 1/2 int |kappa|² of the surface %.4g; the area changes at the rate %.4g, int H nu . v is "
      "%.4g",
      t, 100 * found.deviation, found.energy, found.kappa_energy, found.rates.of_surface,
      found.rates.of_fields);
}

std::string sliding_remark(const Series& series) {
  const std::vector<double>&t = series.at("t"), &area = series.at("area"), &W = series.at("willmore_energy");
  const double taken = area[0] - area[1], expected = (t[1] - t[0]) * 2 * std::max(W[0], W[1]);
  if (taken <= 0.005 * area[0] || taken <= 3 * expected) return "";
  return format(
      "the first step removes %.3g of the area %.4g, mean curvature flow would remove about %.2g: nodes "
      "have slid off edges of the surface; try \"flow\": \"dziuk\", or a finer mesh",
      taken, area[0], expected);
}

std::string extinction(double end, const Series& series) {
  const std::vector<double>& area = series.at("area");
  return format("extinct at t = %g: the area has decreased to %g, from %g at the start, and vanishes then",
                end, area.back(), area.front());
}

std::string mesh_failure_remark(const EvolveConfig& config, const Series& series) {
  if (!config.entry->evolves_curvature && !config.entry->is_mean_curvature_flow) return "";
  const auto max_H = series.find("max_H");
  if (max_H == series.end() || max_H->second.size() < 2) return "";
  const double first = max_H->second.front(), last = max_H->second.back();
  if (!(last < 2.5 * first)) return "";
  return format(
      "max |H| has hardly grown (%.3g at the start, %.3g now), so this may be a failure of the mesh, "
      "and not a singularity of the surface; ",
      first, last);
}

std::string large_step_remark(const EvolveConfig& config, const Series& series) {
  const std::vector<double>& area = series.at("area");
  if (config.adaptive) return "";
  if (config.entry->is_mean_curvature_flow) {
    const double left = latest_end_of_mean_curvature_flow(series) - series.at("t").back();
    if (config.grid.tau > 0.1 * left)
      return format(
          "the surface exists for %.2g at most, and tau is %.2g: take smaller steps; if they do not help, ",
          left, config.grid.tau);
  }
  if (area.size() < 2) return "";
  const double change = std::abs(area.back() / area[area.size() - 2] - 1);
  if (change < 0.2) return "";
  return format("the last step has changed the area by %.0f%%: take smaller ones; if they do not help, ",
                100 * change);
}

Key reinitialise_key() {
  return {Key::positive, "reinitialise", nullptr,
          "nu and H are recomputed from the surface when H nu differs from it by more than this in L2, "
          "such as 0.05"};
}

Key tangential_key() {
  return word(
      "tangential", {"none", "minimal_deformation"},
      "motion along the surface: none, or that with the least int |grad v|² (Hu, Li 2022), which keeps "
      "elements in shape");
}

void check_tangential(const EvolveConfig& config, const std::string& source) {
  if (!config.variant.is("tangential", "none"))
    refuse_given(config.variant, {"velocity"}, source + ": variant", "with tangential motion");
}

std::string linear_elements(const EvolveConfig& config) {
  return config.mesh.degree > 1 ? " with \"degree\": 1" : "";
}

std::string smaller_steps(const EvolveConfig& config) {
  return config.adaptive ? "a smaller tolerance and first_step" : "smaller steps";
}

std::string smaller_steps_or_even_elements(const EvolveConfig& config) {
  return "try " + smaller_steps(config) + ", or " + even_elements;
}

}  // namespace esfem
