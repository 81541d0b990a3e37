// SPDX-License-Identifier: GPL-3.0-or-later
// Mean curvature flow of a closed surface: shrink MESH TAU OUTPUT.vtu reads a mesh (Gmsh, OFF, OBJ, PLY, STL
// or VTU), takes 20 steps of kll19 (5.1) with BDF3, prints time, area and volume, and writes the last
// surface.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "esfem/flows/mean_curvature_flow.hpp"
#include "esfem/mesh/read.hpp"
#include "esfem/mesh/write_vtu.hpp"
#include "esfem/time/integrate.hpp"

namespace {

void shrink(const char* mesh_file, double tau, const char* output) {
  // The surface: S_h[x] of its mesh, and nu and H that fit its nodes, since no formula gives them.
  const esfem::Mesh mesh = esfem::read_mesh(mesh_file).mesh;
  const esfem::SurfaceSpace space(mesh);
  esfem::MeanCurvatureFlow::State state = esfem::discrete_mean_curvature_state(space, mesh.nodes);

  // The scheme: the first two steps, which BDF3 cannot take, are 16 smaller ones each.
  esfem::MeanCurvatureFlow flow(space, {});
  esfem::UniformSteps steps;
  steps.order = 3;
  steps.tau = tau;
  steps.steps = 20;
  steps.start = {esfem::Start::substeps, 16};

  // The run, observed after each step.
  std::printf("%-10s %-22s %s\n", "t", "area", "volume");
  esfem::integrate(flow, steps, {state}, [&](int, const esfem::MeanCurvatureFlow::State& now) {
    std::printf("%-10.4g %-22.16g %.16g\n", now.t, space.area(now.x), space.volume(now.x));
    state = now;
  });
  esfem::write_vtu(mesh.degree, mesh.elements, state.x, esfem::nodal_fields(state), {steps.steps, state.t},
                   output);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: shrink MESH TAU OUTPUT.vtu\n");
    return 1;
  }
  try {
    shrink(argv[1], std::atof(argv[2]), argv[3]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "shrink: %s\n", error.what());
    return 1;
  }
}
