// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "solver/nodal_field.hpp"
#include "solver/types.hpp"

namespace esfem {

/// Description of a run in its snapshots, in UTF-8; empty: none.
struct RunLabel {
  std::string flow;           ///< as `evolve` calls it
  std::string configuration;  ///< JSON: the configuration of the run
};

/// What a snapshot contains in addition to its surface.
struct SnapshotLabel {
  int step = 0;       ///< of the run, from 0
  double t = 0;       ///< time of the surface
  RunLabel run = {};  ///< the run that it belongs to
};

/// Writes a surface of degree 1..4 with nodal fields as a binary VTU file that ParaView opens: triangles (VTK
/// type 5), quadratic triangles (22), Lagrange triangles (69) for degree 3 and 4. elements: E x (k+1)(k+2)/2,
/// node order of fe/lagrange.hpp. The label is its field data: TimeValue (t, under the name that ParaView
/// takes for the time) and step; flow and configuration where they are not empty, one number a byte. The same
/// data give the same bytes. Whole or not at all. Throws InputError when a field has not one row a node or
/// the file cannot be written, NumericsError when a value is not finite.
void write_vtu(int degree, const Connectivity& elements, const Field& x, const NodalFields& fields,
               const SnapshotLabel& label, const std::string& file);

}  // namespace esfem
