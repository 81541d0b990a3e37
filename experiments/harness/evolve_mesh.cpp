// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/evolve_mesh.hpp"

#include "solver/error.hpp"
#include "solver/mesh/generate.hpp"

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

/// The mesh of this degree with the nodal values on it, and the file's numbers of its first nodes.
void raise_degree(ReadMesh& start, int degree) {
  const Mesh given = std::move(start.mesh);
  start.mesh = lagrange_mesh(given, degree);
  for (PointField& field : start.fields) field.values = lagrange_values(given, field.values, start.mesh);
  const Eigen::Index n = given.nodes.rows();
  if (start.mesh.nodes.rows() < n || start.mesh.nodes.topRows(n) != given.nodes) start.node_numbers.clear();
}

}  // namespace

ReadMesh evolve_mesh(const JsonReader& description, int degree, const std::optional<Surface>& surface) {
  const std::string key = description.only_key({"file", "edge_length", "subdivisions"});
  if (key != "file" && !surface) {
    throw InputError(description.where() + ": " + key +
                     " needs a \"surface\"; expected one, or a mesh with the key file");
  }
  ReadMesh start;
  if (key == "file") {
    start = read_mesh(description.text("file"));
  } else if (key == "edge_length") {
    start.mesh = generate_mesh(*surface, description.number("edge_length"));
  } else {
    start.mesh =
        subdivided(*surface, description.integer_within("subdivisions", 0, 0, 8), description.where());
  }
  raise_degree(start, degree);
  if (surface) project_nodes(start.mesh, *surface);
  return start;
}

}  // namespace esfem
