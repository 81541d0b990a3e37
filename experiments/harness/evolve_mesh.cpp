// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/evolve_mesh.hpp"

#include "solver/error.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/mesh/read.hpp"

namespace esfem {

namespace {

/// A subdivided icosahedron, as it is on a sphere, stretched for an ellipsoid.
Mesh subdivided(const Surface& surface, int subdivisions, const std::string& where) {
  if (surface.name == "sphere") return icosphere(surface.parameters.at("radius"), subdivisions);
  if (surface.name == "ellipsoid") {
    Mesh mesh = icosphere(1, subdivisions);
    const auto& axes = surface.parameters;
    mesh.nodes *= Vec3(axes.at("a"), axes.at("b"), axes.at("c")).asDiagonal();
    return mesh;
  }
  throw InputError(where + ": subdivisions make a sphere or an ellipsoid, not a " + surface.name +
                   "; expected edge_length or file");
}

}  // namespace

std::tuple<Mesh, std::string> evolve_mesh(const JsonReader& description, int degree,
                                          const std::optional<Surface>& surface) {
  const std::string key = description.only_key({"file", "edge_length", "subdivisions"});
  if (key != "file" && !surface) {
    throw InputError(description.where() + ": " + key +
                     " needs a \"surface\"; expected one, or a mesh with the key file");
  }
  Mesh mesh;
  std::string remark;
  if (key == "file") {
    ReadMesh found = read_mesh(description.text("file"));
    mesh = std::move(found.mesh);
    remark = found.remark;
  } else if (key == "edge_length") {
    mesh = generate_mesh(*surface, description.number("edge_length"));
  } else {
    mesh = subdivided(*surface, description.integer_within("subdivisions", 0, 0, 8), description.where());
  }
  mesh = lagrange_mesh(mesh, degree);
  if (surface) project_nodes(mesh, *surface);
  return {std::move(mesh), remark};
}

}  // namespace esfem
