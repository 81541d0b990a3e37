// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "solver/analysis/diagnostics.hpp"
#include "solver/geometry/discrete_curvature.hpp"
#include "solver/mesh/snapshot_collection.hpp"
#include "solver/time/checkpoint.hpp"

namespace esfem {

/// When a run's surface is written: at the first step at or after each of `times` and each multiple of
/// `every_time` (0: none), and at every `every`-th step (0: none); in any case at the start and at the end.
/// The steps of the run do not change.
struct SnapshotPlan {
  std::string pvd;             ///< the collection, "run.pvd"; empty: no snapshots are wanted
  std::vector<double> times;   ///< increasing
  int every = 0;               ///< in steps
  RunLabel run = {};           ///< description of the run in each snapshot
  Vec3 origin = Vec3::Zero();  ///< is added to the positions of snapshots
  double every_time = 0;       ///< in time
};

/// Records a run on one mesh: a time series, snapshots, and the newest surface. A step that cannot be
/// recorded changes none of them.
class RunRecorder {
 public:
  /// The newest surface with its nodal fields.
  struct Surface {
    int step = 0;        ///< its number in the run
    double t = 0;        ///< its time
    Field x;             ///< nodes, N x 3; empty as long as nothing is recorded
    NodalFields fields;  ///< of the flow
  };

  /// Whether the series have kappa_energy, which costs a factorisation a step.
  enum Energies { of_the_flow, of_flow_and_surface };

  /// The space must outlive the recorder. Throws InputError when the times of the plan are not increasing.
  RunRecorder(const SurfaceSpace& space, SnapshotPlan plan, Energies energies = of_the_flow);

  /// Records step n at time t with the flow's own nodal fields (v, nu, H, ..). Series: those of
  /// record_geometry; max_H and willmore_energy from H of a flow that evolves nu and H, else from that of the
  /// discrete surface (the H of BGN's scheme is a mean over the step); min_nu and max_nu of a flow's own nu;
  /// kappa_energy, 1/2 int |kappa|² of the discrete surface, which a flow's own H can drift away from.
  /// Snapshots have kappa of the discrete surface, too, and its nu and H where the flow has none.
  void record(int n, double t, const Field& x, NodalFields fields);
  /// The same with all nodal fields of a state.
  template <class State>
  void record(int n, const State& state) {
    record(n, state.t, state.x, nodal_fields(state));
  }

  /// Quantities of the newest surface from the flow's own nu and H, and from the surface itself.
  struct CurvatureComparison {
    double deviation;                    ///< DiscreteCurvature::deviation
    double energy;                       ///< 1/2 int H²
    double kappa_energy;                 ///< 1/2 int |kappa|²
    DiscreteCurvature::AreaRates rates;  ///< of the change of area
    double rate_difference() const;      ///< of the rates of area, relative to their scale
    double energy_difference() const;    ///< relative to kappa_energy
  };
  /// Compares them, where the flow has nu, H and v of its own; costs two factorisations.
  std::optional<CurvatureComparison> compare_curvature();

  /// Writes the newest surface as the last snapshot, unless it is written.
  void finish();

  /// What has been recorded; others may add series of their own.
  /// @{
  Series& series() { return series_; }
  const Series& series() const { return series_; }
  /// @}

  /// Whether a step has been recorded.
  bool empty() const { return newest_.x.size() == 0; }
  /// The surface of the last step recorded.
  const Surface& newest() const { return newest_; }

  /// A snapshot that has been written.
  struct Snapshot {
    double t;          ///< its time
    std::string file;  ///< without folder
  };
  /// Those of the collection, also from before a run was resumed.
  const std::vector<Snapshot>& snapshots() const { return snapshots_; }

  /// All that has been recorded, for CBOR.
  nlohmann::json progress() const;
  /// Resumes from there, whatever has been recorded until now. With another plan, its times and `every` apply
  /// from there on, and a new collection begins with the surface from which the run resumes, while the old
  /// one is left unchanged. Throws InputError, and changes nothing, when a snapshot's file is missing.
  void resume(const nlohmann::json& progress);

 private:
  bool is_due(int n, double t);
  bool pass_times(double t);
  double multiples(double t) const;
  void write_newest();

  const SurfaceSpace& space_;
  SnapshotPlan plan_;
  Energies energies_;
  std::size_t next_time_ = 0;
  std::optional<SnapshotCollection> collection_;
  nlohmann::json other_collections_ = nlohmann::json::object();  ///< of earlier plans
  DiscreteCurvature curvature_;
  Series series_;
  Surface newest_;
  std::vector<Snapshot> snapshots_;
};

/// A run that resumes from the checkpoint continues its records, too. The recorder must outlive the run.
void attach(Checkpoint& checkpoint, RunRecorder& recorder);

}  // namespace esfem
