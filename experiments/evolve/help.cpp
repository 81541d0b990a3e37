// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/help.hpp"

#include <algorithm>
#include <sstream>

#include "experiments/evolve/config.hpp"
#include "experiments/evolve/formulas.hpp"
#include "experiments/evolve/sweep.hpp"
#include "solver/error.hpp"
#include "solver/surfaces/named.hpp"

namespace esfem {
namespace {

/// The words in lines of at most 110 characters; the first continues a line of `used` characters, the others
/// are indented.
std::string wrapped(const std::string& words, std::size_t used, std::size_t indent) {
  std::istringstream stream(words);
  std::string text;
  for (std::string word; stream >> word; used += word.size() + 1) {
    if (used + word.size() > 110 && !text.empty()) {
      text += "\n" + std::string(indent, ' ');
      used = indent;
    } else if (!text.empty()) {
      text += " ";
    }
    text += word;
  }
  return text + "\n";
}

/// "ritz" | "interpolation", or true | false | "coefficients": the default comes first
std::string values_of(const Key& key) {
  std::string values = key.otherwise.is_null() ? "none" : key.otherwise.dump();
  if (key.kind == Key::words_of) return values;
  if (key.kind == Key::number_or_formula) values += " | \"formula\"";
  if (key.kind == Key::truth_or_word) values += key.otherwise == true ? " | false" : " | true";
  for (const std::string& word : key.words)
    if (word != key.otherwise) values += " | \"" + word + "\"";
  return values;
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
    text += line + wrapped(key.help, line.size(), 52);
  }
  return text;
}

std::string lines_of(const std::vector<FormulaKey>& keys) {
  std::string text;
  for (const FormulaKey& key : keys) {
    std::string line = "      \"" + key.name + "\"";
    line.resize(21, ' ');
    text += line + key.example + (key.is_required ? ", needed" : "") + "\n" + std::string(21, ' ') +
            wrapped(key.help, 21, 21);
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
  if (entry.own_starts) text = entry.fields;
  if (text.empty()) return "";
  return "      starts from    " + text + " of the mesh file" +
         (entry.starts_beside_surface ? "" : ", without \"surface\"") + "\n";
}

std::string help_of(const Entry& entry) {
  std::string text = "\"flow\": \"" + entry.flow + "\"";
  if (!entry.problem.empty()) text += ", \"problem\": \"" + entry.problem + "\"";
  text += "\n      " + wrapped(entry.help, 6, 6);
  if (!entry.fields.empty()) text += "      nodal fields   " + entry.fields + "\n";
  if (!entry.energy.empty()) text += "      energy         \"" + entry.energy + "\" of the series\n";
  if (entry.highest_order == 1)
    text += "      bdf            1\n";
  else if (entry.order_on_files != entry.order)
    text += "      bdf            without \"surface\" 1 by default\n";
  if (entry.time_power != 2)
    text += "      times          in units of L^" + std::to_string(entry.time_power) + "\n";
  if (!entry.limits.empty()) text += "      limits         " + listed(entry.limits) + "\n";
  return text + lines_of("variant", entry.variant) + lines_of("parameters", entry.parameters) +
         lines_of(entry.formulas) + starts_of(entry);
}

const char* const keys_help =
    R"(Keys without a default must be given; unknown keys are errors. "flow", "problem", "variant" and "parameters" are
explained with each flow.
  {"flow": "mean_curvature", "problem": .., "variant": {..}, "parameters": {..},
   "surface": {"name": "sphere", "radius": 2},  exact initial surface; optional with a mesh file
   "mesh": {"file": "a.msh",                  .msh, .off, .obj, .ply, .stl, .vtu of evolve (plots/convert_mesh.py converts other
                                              files): closed, of one or several components; seams, polygons and
                                              orientation are repaired and reported; nodes are projected onto the surface,
                                              if one is given
            "remesh": 0.1,                    replaces the flat triangles of the file by new ones on them, with edges of
                                              about this length; default: no. Edges sharper than feature_angle are kept
            "curve": true,                    puts nodes of degree 2 to 4 on a smooth surface through the corners; default: no.
                                              {"feature_angle": 40}, in degrees: sharper edges stay sharp
            "refine": 0}                      how often each triangle is cut into four: on the surface, if one is given; with
                                              curve on the smooth one; else on the elements of the file
         | {"edge_length": 0.25,              largest edge of a generated mesh, in the surface's units
            "grading": 0.5}                   edges at most this times the radius of curvature; default: edges of one length
         | {"subdivisions": 4},               of an icosahedron, for sphere and ellipsoid
   "initial": {"file": "end.json",            instead of mesh: surface, nodal values and time of an earlier run, from its nodal
                                              output, from a snapshot (.vtu), or from a mesh file with nodal values; see initial
               "time": 0},                    only for files that do not say it
   "degree": 2,                               1..4; default for a file without "surface": the degree of its elements, which is
                                              1 for flat triangles without "curve": on these nu and H do not converge with
                                              higher degrees
   "bdf": 3,                                  1..5; bgn: 1; default for dziuk without "surface": 1
   "tau": 0.05,                               step size (no default)
   "steps": 0,                                end time = steps tau (from "initial": its time + steps tau); 0 writes the initial
                                              surface
   "stop": {"speed": 1e-6,                    ends the run: stationary, the largest |v| in the nodes is below this (length/time
                                              of your data; cahn_hilliard: |du/dt|),
            "energy_rate": 1e-6,              stationary: |dE/dt| of the flow's energy is below this,
            "area": 0.1,                      area below 0.1 times that at the start; values above 1: area above,
            "seconds": 3600},                 wall-clock time of this command; default: none of these
   "adaptive": {"end_time": 4,                instead of tau, steps and start: BDF 1 or 2 (bdf, default 2) with steps that
                "tolerance": 1e-3,            follow the solution; root mean square of x/L (dziuk, bgn), nu and L H
                                              (mean_curvature, willmore, surface_diffusion, helfrich) or u (coupled_diffusion,
                                              phase_separation)
                "first_step": 1e-6 T,         not controlled, so smaller than end_time (default: at most a tenth)
                "largest_step": 0.01},        default: no bound
   "start": "exact" | "cascade" | "substeps:16",  default: exact where a solution is known (sphere, angenent_torus), else substeps:16
   "quadrature": {"conical": 6} | {"degree": 10},  default: degree 4, 6, 8, 10 for P1..P4; bgn of degree 1: the vertices
   "limits": {"curvature_size": 5,            singular, as far as listed with the flow: |H| times edge length above
                                              this (or 4 times its initial maximum);
              "radius_ratio": 0.01,           radius ratio of an element below this (or the square of the initial minimum; no
              "normal_length": 4},            limit if that minimum is < 0.01); |nu| or 1/|nu| of a flow's nu above this
   "exact": {"u": "exp(-6*t)*x*y"},           a solution by formulas of x, y, z, t: the series has the errors of each step
   "definitions": {"r2": "x^2 + y^2"},        names for parts of formulas
   "output": {"nodal": "end.json",            nodal values at the end; without "output" on standard output
              "history": true,                nodal has the steps before, so that "initial" goes on bit for bit; default: true
                                              with tau and a file
              "series": "series.json",        written at the end; "series.csv": a line per step, written at once
              "vtu": "run.pvd",               snapshots for ParaView: run.pvd and run_0000.vtu, .., at start and end,
              "checkpoint": "run.checkpoint", the same command resumes from it; see checkpoint
              "every": 10,                    at every 10th step (default 0: none of these)
              "every_time": 0.1,              at the first step at or after each multiple of this; tau stays as it is
              "times": [0.1, 0.25]}}          and at the first step at or after each of these times
)";

const char* const units_help =
    R"(Values that you give have the units of your data. Defaults and tolerances are relative to L, the power of ten nearest
to sqrt(area/(4 pi)) of the initial surface: L = 1 for sizes of 0.32 to 3.2. Times have the unit T = L^2, or another
power where the flow says so (phase_separation: mobility 1, epsilon a length).
A disturbance consists of waves with wave numbers up to 4/L and phases relative to the origin (on a mesh without
"surface": to its centroid); in phase_separation its mean is 0.
)";

const char* const output_help =
    R"("nodal" has t, x, v and the nodal fields of the flow at the last step, one row per node; the nodes of the mesh file come
first, in its order. elements has one row per element: its nodes, counted from 0 (corners, then the nodes of the edges
01, 12, 20, then inner ones). node_numbers are the numbers of the nodes in the file, if these are not 1, 2, ..

"series" has, per step,
  t, area, volume, willmore_energy (1/2 int H²), max_H, h, worst_angle (degrees), worst_radius_ratio;
  flows with nu: min_nu, max_nu;
  willmore, surface_diffusion, helfrich: kappa_energy, 1/2 int |kappa|² of the surface itself;
  helfrich: helfrich_energy, 1/2 int (H - H_0)², and the multipliers lambda_A and lambda_V;
  coupled_diffusion: min_u, max_u and mass_u, int u, of each species (u, or u1, u2, ..);
  cahn_hilliard: mass, int u, and energy, int epsilon/2 |grad u|² + (u² - 1)²/(4 epsilon);
  with "exact": u_nodal_L2, u_nodal_H1 and u_nodal_H1_semi of each field that has a formula, and by quadrature
    u_lifted_L2, .. on the exact surface where it is known (at rest, "velocity" or "exact" with a level_set), else
    u_unlifted_L2, .. on the discrete one. With "x" in it, the trajectories of the nodes (of x, y, z at the start, and
    t), errors are those in the exact nodes.

Snapshots have v, nu, H, and kappa = M^-1 A x, and as field data TimeValue, step, flow and configuration (this file;
texts are arrays of bytes). If the flow has no nu, then max_H, willmore_energy, and nu and H of the snapshots are those
of the discrete surface.

Before the first step, missing folders of output files are created and the files are opened for writing as a test. At
its end a run says on standard error how many steps were taken, how long that took, and which files were written.
)";

const char* const end_help =
    R"(A run that meets a singularity ends with exit code 2, and reports and writes what it has computed. So it does
  when u grows to 1000 times its initial size (tumour_growth: or that of its steady state; kinetics, mixture, ellipsoid: 1e9),
  when the surface is extinct: its extrapolated area is zero within the next step, or its area is below 1e-6 of the
  initial one, or, under mean curvature flow, it has lived for A/(16 pi), the longest possible time for an area A.

"stop" ends it with exit code 0, and "status" of the series is "stationary: ..", "area: .." or "seconds: ..", headed by
"in the first step: " where one step was enough, which may say more of the bound than of the flow. A run that resumes
from its checkpoint takes a step before it is judged again.

Else "status" is "ok", the reason why the run ended, or "ok, but ..": then nu and H, which the flow evolves, no longer
agree with the surface, for example because the mesh does not resolve the curvature; or, with bgn, nodes have slid off
edges. nu and H are compared with the surface at the start, at the end and every 50 steps. They do not agree if H nu and
kappa, smoothed over an edge length, differ by more than 25% in L2, or the rates of area int H nu . v and int kappa . v
by more than 25% of ||H nu|| ||v||, or willmore_energy and kappa_energy by more than 25% (degree 1: 50%).
)";

const char* const initial_help =
    R"(From a mesh file a run starts from those of its nodal values that are listed with its flow ("starts from"): $NodeData of
.msh, point data of .vtu, real properties of the vertices of .ply (H, or nu_x, nu_y, nu_z); it reports this. t starts at
0, and defaults are relative to the length of this surface: to continue with the parameters of an earlier run, give them.

From "initial", the nodal output of a run: this has also degree, flow, and history: the states of the last bdf steps, the
nodes at the start, and what the flow keeps from step to step. A run from it with the same flow, surface, variant,
parameters, quadrature, tau and bdf goes on bit for bit as if it had not ended ("surface" and "bdf" may be left out).
Otherwise, and from other files, it starts from the nodal values listed with the flow with new starting steps, and says
why; a file without them is an error, and limits and defaults are then relative to its surface.
)";

const char* const checkpoint_help =
    R"(The file is written every 30 seconds, when the run is stopped, and at its end, and is kept. A run that finds it resumes
from it, bit for bit as if it had not been stopped; more steps or a later end_time thus prolong a finished run (with
adaptive steps the last ones, which led to the earlier end, are repeated). output may change: every and times apply from
there on, and a vtu of another name begins there. A file that does not fit (another tau, mesh, variant or build of the
program) or is damaged is an error before the first step, and is left unchanged. The checkpoint from which a run has
resumed is kept as run.checkpoint.previous.

SIGINT and SIGTERM stop a run after the step in progress: it writes its checkpoint and what it has computed, with "status":
"stopped by signal SIGINT at t = ..", says how to go on, and ends with exit code 130 or 143. A second signal ends it at
once.
)";

/// What evolve --explain NAME prints. The title is its line in --help; a flow, which has none, is listed
/// there with its problems.
struct Subject {
  std::string name, title, text;
};

std::vector<Subject> subjects() {
  std::vector<Subject> all = {{"keys", "every key of a configuration, with its default", keys_help}};
  for (const Entry& entry : entries()) {
    if (all.back().name != entry.flow) all.push_back({entry.flow, "", ""});
    all.back().text += help_of(entry);
  }
  all.push_back({"units", "of numbers, defaults and tolerances", units_help});
  all.push_back({"surfaces", "those with a name, and their parameters", named_surfaces_help()});
  all.push_back({"formulas", "what they may contain", formulas_help()});
  all.push_back({"output", "what the files contain", output_help});
  all.push_back({"end", "when a run ends, and its status", end_help});
  all.push_back({"initial", "starting from a file, going on from an earlier run", initial_help});
  all.push_back({"checkpoint", "stopping and resuming", checkpoint_help});
  all.push_back({"sweeps", "many runs: --set, --list, --cell, --collect", sweep_help()});
  return all;
}

/// The flows, each with its problems, a line of help each.
std::string list_of_flows() {
  std::string text;
  for (const Entry& entry : entries()) {
    const bool has_default = &entry == &entries().front() || (&entry - 1)->flow != entry.flow;
    std::string line = "  " + (has_default ? entry.flow : "");
    if (!entry.problem.empty()) {
      if (has_default) text += line + ", by \"problem\":\n";
      line = "    " + entry.problem;
    }
    line.resize(std::max<std::size_t>(line.size() + 2, 30), ' ');
    text += line + wrapped(entry.help, line.size(), 30);
  }
  return text;
}

}  // namespace

std::string evolve_help() {
  std::string titles;
  for (const Subject& subject : subjects()) {
    if (subject.title.empty()) continue;
    std::string line = "  " + subject.name;
    line.resize(30, ' ');
    titles += line + subject.title + "\n";
  }
  return std::string(R"(Evolves a surface: flow, surface or mesh, and method come from a JSON file, such as
)") + evolve_example +
         R"(

Flows; the first problem of a flow is its default:
)" + list_of_flows() +
         R"(
evolve --explain NAME, where NAME is a flow, explains its keys, and with another NAME
)" + titles +
         R"(  all                         all of this
More configurations: reference/examples, such as evolve reference/examples/sphere.json; docs/own_problems.md.
README.md names the papers kll19, nick18, kll21 and bk22.
)";
}

std::string evolve_explanation(const std::string& name) {
  std::string text, known;
  for (const Subject& subject : subjects()) {
    if (name == subject.name) return subject.text;
    if (name == "all") text += "== " + subject.name + "\n" + subject.text + "\n";
    known += subject.name + ", ";
  }
  if (text.empty()) throw InputError("--explain: found " + name + ", expected one of " + known + "all");
  return text;
}

}  // namespace esfem
