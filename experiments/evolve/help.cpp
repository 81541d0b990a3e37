// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/config.hpp"
#include "solver/surfaces/named.hpp"

namespace esfem {
namespace {

/// "ritz" | "interpolation"
std::string values_of(const Key& key) {
  if (key.kind != Key::word) return key.otherwise.is_null() ? "none" : key.otherwise.dump();
  std::string words;
  for (const std::string& word : key.words) words += (words.empty() ? "\"" : " | \"") + word + "\"";
  return words;
}

std::string unit_of(int length_power) {
  return length_power == 0 ? "" : length_power == 1 ? " L" : " L^" + std::to_string(length_power);
}

std::string lines_of(const char* object, const std::vector<Key>& keys) {
  std::string text;
  for (const Key& key : keys) {
    std::string line = std::string("      ") + (&key == &keys.front() ? object : "");
    line.resize(21, ' ');
    line += "\"" + key.name + "\": " + values_of(key) + unit_of(key.length_power);
    line.resize(std::max<std::size_t>(line.size() + 2, 52), ' ');
    text += line + key.help + "\n";
  }
  return text;
}

std::string starts_of(const Entry& entry) {
  std::string text;
  for (const std::vector<std::string>& names : entry.starts) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    text += (text.empty() ? "" : "; or ") + list;
  }
  if (text.empty()) return "";
  return "      starts from    " + text + " of the mesh file" +
         (entry.starts_beside_surface ? "" : ", without \"surface\"") + "\n";
}

std::string help_of(const Entry& entry) {
  std::string text = "  \"" + entry.flow + "\"";
  if (!entry.problem.empty()) text += ", \"problem\": \"" + entry.problem + "\"";
  text += ": " + entry.help + "\n";
  if (!entry.fields.empty()) text += "      nodal fields   " + entry.fields + "\n";
  if (entry.highest_order == 1)
    text += "      bdf            1\n";
  else if (entry.order_on_files != entry.order)
    text += "      bdf            without \"surface\" 1 by default\n";
  if (entry.time_power != 2)
    text += "      times          in units of L^" + std::to_string(entry.time_power) + "\n";
  return text + lines_of("variant", entry.variant) + lines_of("parameters", entry.parameters) +
         starts_of(entry);
}

}  // namespace

std::string evolve_config_help() {
  std::string flows;
  for (const Entry& entry : entries()) flows += help_of(entry);
  return R"(CONFIG.json (keys without a default must be given; unknown keys are errors; evolve --schema prints them for editors):
  {"flow": "mean_curvature", "problem": .., "variant": {..}, "parameters": {..},   see Flows
   "surface": {"name": "sphere", "radius": 2},  exact initial surface; may be left out with a mesh file
   "mesh": {"file": "a.msh",                  .msh, .off, .obj, .ply, .stl, .vtu of evolve (plots/convert_mesh.py converts other
                                              files): closed, of one or several parts; seams, polygons and orientation are
                                              mended with a remark; nodes are projected to the surface, where one is given
            "remesh": 0.1,                    flat triangles made anew with edges of about this length, on those of the
                                              file; default: not. Edges sharper than feature_angle are kept
            "curve": true}                    nodes of degree 2 to 4 on a smooth surface through the corners; default: not.
                                              {"feature_angle": 40}, in degrees: sharper edges stay sharp
         | {"edge_length": 0.25}              largest edge of a generated mesh, in the surface's units
         | {"subdivisions": 4},               of an icosahedron, for sphere and ellipsoid
   "degree": 2,                               1..4; default of a file without "surface": its own, 1 where triangles are flat
                                              and not curved: nu and H of flat ones do not converge with higher degrees
   "bdf": 3,                                  1..5; bgn: 1; default for dziuk without "surface": 1
   "tau": 0.05,                               step size (no default)
   "steps": 0,                                end time = steps tau; 0 writes the initial surface
   "adaptive": {"end_time": 4,                instead of tau, steps and start: BDF 1 or 2 (bdf, default 2) with steps that
                "tolerance": 1e-3,            follow the solution; root mean square of x/L (dziuk, bgn), nu and L H
                                              (mean_curvature, willmore, surface_diffusion) or u (coupled_diffusion,
                                              phase_separation)
                "first_step": 1e-6 T,         not controlled, so smaller than end_time (default: at most a tenth)
                "largest_step": 0.01},        default: no bound
   "start": "exact" | "cascade" | "substeps:16",  default: exact where a solution is known (sphere, angenent_torus), else substeps:16
   "quadrature": {"conical": 6} | {"degree": 10},  default: degree 4, 6, 8, 10 for P1..P4; bgn of degree 1: the vertices
   "limits": {"curvature_size": 5,            singular is more |H| times edge than this (or 4 times that of the start),
              "radius_ratio": 0.01,           an element's radius ratio below this (or the smallest of the start squared;
              "normal_length": 4},            no limit where that is < 0.01), |nu| or 1/|nu| of a flow's nu beyond this
   "output": {"nodal": "end.json", "series": "series.json",  default: nodal values on standard output
              "vtu": "run.pvd",               snapshots for ParaView: run.pvd and run_0000.vtu, .., at start and end,
              "checkpoint": "run.checkpoint", the same command goes on from it; see below
              "every": 10,                    at every 10th step (default 0: none of these)
              "times": [0.1, 0.25]}}          and at the first step at or after each of these times
Flows, the first problem of each is its default; with the defaults of their keys:
)" + flows +
         R"(Units: what is given has those of the data. Defaults and tolerances are relative to L, the power of ten next to
sqrt(area/(4 pi)) of the initial surface: 1 for sizes of 0.32 to 3.2. Times have the unit T = L^2;
where a flow says so, another power (phase_separation: mobility 1, epsilon a length). The waves of a disturbance have wave numbers up to 4/L, in
phase_separation the mean 0, and phases about the origin, on a mesh without "surface" about its centroid.
Surfaces and their defaults:
)" + named_surfaces_help() +
         R"(Output: nodal has t, x, v and what else the flow has (see Flows) of the last step, one row a node; the nodes of the mesh
file come first, in its order. elements are the rows of the nodes of each element, counted from 0 (corners, then the nodes
of the edges 01, 12, 20, then inner ones); node_numbers, where they are not 1, 2, .., the file's own of its nodes.
A run starts from the nodal values of its mesh file ($NodeData of .msh, point data of .vtu) that have the names listed
there, and says so; t starts at 0, and defaults are relative to the length of this surface: to go on
with the parameters of the run before, give them. The series has, per step, t, area, volume, willmore_energy (1/2 int H²), max_H, h, worst_angle
(degrees), worst_radius_ratio, where the flow has nu also min_nu, max_nu; for
willmore and surface_diffusion kappa_energy, 1/2 int |kappa|² of the surface itself; for cahn_hilliard mass, int u, and
energy, int epsilon/2 |grad u|² + (u² - 1)²/(4 epsilon). Snapshots have v, nu, H, and kappa = M^-1 A x, and as
field data TimeValue, step, flow and configuration (this file; texts are arrays of bytes). Where the flow has no nu, max_H
and willmore_energy, and nu and H of snapshots, are those of the discrete surface.
A run that meets a singularity, shrinks to nothing (extinct: its area, extrapolated, is zero within the next step, or
below 1e-6 of the first, or an area A under mean curvature flow has lived for A/(16 pi), the longest possible), or in which
u grows to 1000 times its first size (tumour_growth: or that of its steady state), writes what it has computed, says so,
and ends with exit code 2. "status" of series is "ok", what has ended the run, or "ok, but ..": nu and H of a flow that evolves them are no longer those of the surface (H nu
and kappa, smoothed over an edge length, differ by more than 25% in L2, or the rates of area int H nu . v and int kappa . v
by more than 25% of ||H nu|| ||v||, or willmore_energy and kappa_energy by more than 25%, degree 1: 50%; looked at at the
start, the end and every 50 steps), as on meshes that do not resolve the curvature; or, bgn, nodes have slid off edges.
Folders of output files are made, and the files tried, before the first step.
Checkpoint: the file is written every 30 seconds, when the run is stopped, and at its end, and is kept. A run that finds it
goes on from it, bit for bit as if it had not been stopped; so more steps, or a later end_time, prolong a finished run (with
adaptive steps the last ones, which led to the earlier end, are taken again). output may change: every and times hold from
there on, and a vtu of another name begins there. A file that does not serve (another tau, mesh, variant, build of the
program; damaged) is an error before the first step, and stays as it is. What a run has gone on from is kept as
run.checkpoint.previous.
SIGINT and SIGTERM stop a run after the step in progress: it writes its checkpoint and what it has computed, with "status":
"stopped by signal SIGINT at t = ..", and ends with exit code 2, since it is not done. A second signal ends it at once.)";
}

}  // namespace esfem
