// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "solver/analysis/run_recorder.hpp"
#include "solver/fe/quadrature.hpp"
#include "solver/flows/evolving_ellipsoid.hpp"
#include "solver/flows/growing_sphere.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/flows/tumour_growth.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/mesh/mesh.hpp"
#include "solver/mesh/origin.hpp"
#include "solver/time/integrate.hpp"

namespace esfem {

/// What a CONFIG.json of `evolve` asks for, with the defaults filled in.
struct EvolveConfig {
  std::string flow;  ///< mean_curvature | dziuk | bgn | coupled_diffusion | willmore | surface_diffusion |
                     ///< cahn_hilliard
  std::optional<Surface> surface;          ///< the exact initial surface, where one is given
  Mesh mesh;                               ///< P_k; on the surface, where there is one
  Vec3 origin = Vec3::Zero();              ///< of the mesh's coordinates in those of its file
  Vec3 disturbance_origin = Vec3::Zero();  ///< of the waves that disturb initial values
  std::vector<std::string> mesh_remarks;   ///< what was changed or chosen when the mesh was made
  NodalFields fields;                      ///< nodal values of the mesh file; nan where it has none
  std::vector<long> node_numbers;          ///< the file's own, of the first nodes; empty: 1, 2, ..
  MeshOrigin mesh_origin;                  ///< names elements as the mesh file does; no source: generated
  UniformSteps grid;
  bool start_given = false;               ///< whether grid.start comes from the file
  std::optional<AdaptiveSteps> adaptive;  ///< instead of `grid`, where the file asks for it
  Quadrature rule;
  MeanCurvatureFlow::Variant mean_curvature;
  WillmoreFlow::Variant willmore;
  bool willmore_theta = false;  ///< with the correction (3.7) of kll21
  struct {
    enum Problem { ellipsoid, phase_separation } problem = ellipsoid;
    double epsilon = 0.5;
    bool theta = false;                                ///< ellipsoid: with the correction (3.13) of bk22
    StartValues initial = StartValues::interpolation;  ///< ellipsoid
    double mean = 0, disturbance = 0.1;                ///< phase_separation
    int seed = 1;
  } cahn_hilliard;
  struct Coupled {
    enum Problem { growing_sphere, tumour_growth } problem = growing_sphere;
    CoupledDiffusionParameters parameters;
    CoupledDiffusionVariant variant;
    GrowingSphereProblem::Coupling coupling = GrowingSphereProblem::additive;  ///< of the growing sphere
    TumourGrowth::Kinetics kinetics;                                           ///< of the tumour
    double disturbance = 0.01;                                                 ///< of its steady state
    int seed = 1;
  } coupled;
  std::string nodal = "-", series;  ///< output files; "-" is standard output, empty: not wanted
  std::string checkpoint;           ///< a file from which a stopped run goes on; empty: not wanted
  SnapshotPlan snapshots;
  struct {
    std::optional<double> curvature_size, radius_ratio, normal_length;  ///< instead of the defaults
  } limits;                                                             ///< see RegularityLimits
};

/// Reads a configuration and makes its mesh. Paths in it are relative to the working directory. Throws
/// InputError, which names `source` and the key, for unknown keys (listing the known ones) and values of the
/// wrong type or range.
EvolveConfig evolve_config(const nlohmann::json& json, const std::string& source);

/// The keys with their defaults, for --help.
std::string evolve_config_help();

}  // namespace esfem
