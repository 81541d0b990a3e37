// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/mesh.hpp"

#include <map>
#include <set>

#include "experiments/harness/warn.hpp"
#include "solver/error.hpp"
#include "solver/mesh/curve.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/mesh/refine.hpp"
#include "solver/mesh/remesh.hpp"

namespace esfem {

namespace {

/// The keys of "mesh" that say what it is, with those that may stand beside them.
const std::map<std::string, std::set<std::string>> kinds = {
    {"file", {"curve", "refine", "remesh"}}, {"edge_length", {"grading"}}, {"subdivisions", {}}};

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

/// With edges of one length, or graded by curvature.
Mesh generated(const Surface& surface, const JsonReader& description) {
  const double edge_length = description.number("edge_length");
  const double nodes = nodes_at_most(surface, edge_length);
  if (nodes > 3e5 && nodes <= most_nodes)
    warn(description.where() +
         format(": edge_length = %g on a surface of radius %g makes up to %.1g corners of "
                "triangles, which takes minutes",
                edge_length, surface.bounding_radius, nodes));
  return headed(description.where(), [&] {
    return description.has("grading") ? generate_mesh(surface, edge_length, description.number("grading"))
                                      : generate_mesh(surface, edge_length);
  });
}

/// The mesh of this degree with the nodal values on it, and the file's numbers of its first nodes.
void raise_degree(ReadMesh& start, int degree) {
  const Mesh given = std::move(start.mesh);
  start.mesh = lagrange_mesh(given, degree);
  for (NodalField& field : start.fields) field.values = lagrange_values(given, field.values, start.mesh);
  const Eigen::Index n = given.nodes.rows();
  if (start.mesh.nodes.rows() < n || start.mesh.nodes.topRows(n) != given.nodes) start.node_numbers.clear();
}

/// Requested treatment of a mesh file.
struct FileTreatment {
  std::optional<double> remesh;  ///< edge length
  bool curve = false;
  double feature_angle = default_feature_angle;
  int refine = 0;  ///< how often each triangle is cut into four
};

FileTreatment file_treatment(const JsonReader& description) {
  FileTreatment treatment;
  if (description.has("remesh")) treatment.remesh = description.number("remesh");
  treatment.refine = description.integer_within("refine", 0, 0, 8);
  treatment.curve = description.is_object("curve") || description.truth_or("curve", false);
  if (!description.is_object("curve")) return treatment;
  const JsonReader curve(description.object("curve"), description.where() + ": curve");
  curve.accept_only({"feature_angle"});
  treatment.feature_angle = curve.number_or("feature_angle", default_feature_angle);
  if (!(treatment.feature_angle > 0 && treatment.feature_angle <= 180))
    throw InputError(format("%s: found feature_angle = %g; expected degrees, more than 0 and at most 180",
                            curve.where().c_str(), treatment.feature_angle));
  return treatment;
}

/// Cuts every triangle into four, on its own map. Returns the refined mesh as it is then.
RefinedMesh refine_file(ReadMesh& start, const std::string& file, int times) {
  RefinedMesh refined = refine(start.mesh, times);
  for (NodalField& field : start.fields) field.values = refined_values(start.mesh, field.values, refined);
  start.mesh = refined.mesh;
  start.origin = {};
  start.origin.source = file + ", refined";
  start.node_numbers.clear();
  return refined;
}

/// Linear in the triangles of the mesh that was remeshed.
Field values_at(const std::vector<MeshPoint>& points, const Mesh& mesh, const Field& values) {
  Field result(points.size(), values.cols());
  for (int i = 0; i < result.rows(); ++i)
    result.row(i) = points[i].weights.transpose() * values(mesh.elements.row(points[i].element), Eigen::all);
  return result;
}

/// The flat mesh of a file with edges of another length; its nodes lie on the smooth surface through the
/// file's corners if the mesh will be curved.
void remesh_file(ReadMesh& start, const std::string& file, const FileTreatment& treatment, int degree,
                 std::vector<std::string>& remarks) {
  const Mesh flat = std::move(start.mesh);
  RemeshedSurface found;
  try {
    found = remesh(flat, *treatment.remesh, treatment.feature_angle);
  } catch (const InputError& error) {
    throw InputError(file + ": " + error.what());
  }
  if (treatment.curve) {
    const SmoothSurface surface(flat, degree, treatment.feature_angle);
    for (int i = 0; i < found.mesh.nodes.rows(); ++i)
      found.mesh.nodes.row(i) = surface.point(found.on_input[i].element, found.on_input[i].weights);
  }
  start.origin = {};
  start.origin.source = file + ", remeshed";
  check_closed_surface(found.mesh, start.origin.source);
  for (NodalField& field : start.fields) field.values = values_at(found.on_input, flat, field.values);
  start.node_numbers.clear();
  const MeshQuality before = mesh_quality(flat.elements, flat.nodes),
                    after = mesh_quality(found.mesh.elements, found.mesh.nodes);
  remarks.push_back(format(
      "%s: remeshed with edges of about %g: %d nodes before, %d after; worst radius ratio %.2g before, %.2g "
      "after; %d of %d edges sharper than %g degrees kept; the volume changes by %.2g%%",
      file.c_str(), *treatment.remesh, int(flat.nodes.rows()), int(found.mesh.nodes.rows()),
      before.min_radius_ratio, after.min_radius_ratio, found.kept, found.sharp_edges, treatment.feature_angle,
      100 * found.relative_volume_change));
  start.mesh = std::move(found.mesh);
}

void curve_file(ReadMesh& start, const std::string& file, const FileTreatment& treatment, int degree,
                std::vector<std::string>& remarks) {
  const Mesh flat = start.mesh;
  CurvedMesh result = curved_mesh(flat, degree, treatment.feature_angle);
  std::string remark = format("%s: curved; %d of %d edges are sharper than %g degrees and kept", file.c_str(),
                              result.sharp_edges, result.edges, treatment.feature_angle);
  if (result.straight > 0)
    remark += format("; %d of %d nodes stay on the flat triangles, where the surface is too rough or coarse",
                     result.straight, int(result.mesh.nodes.rows()));
  remarks.push_back(remark);
  raise_degree(start, degree);
  start.mesh.nodes = result.mesh.nodes;  // numbered alike
  if (treatment.refine == 0) return;
  // The nodes of the finer elements lie on the smooth surface, not on the coarse elements that interpolate
  // it.
  const RefinedMesh refined = refine_file(start, file, treatment.refine);
  const SmoothSurface surface(flat, degree, treatment.feature_angle);
  for (int i = 0; i < start.mesh.nodes.rows(); ++i) {
    const double xi = refined.place(i, 0), eta = refined.place(i, 1);
    start.mesh.nodes.row(i) = surface.point(refined.element[i], {1 - xi - eta, xi, eta});
  }
}

EvolveMesh mesh_of_file(const JsonReader& description, std::optional<int> degree, bool on_surface) {
  const std::string file = description.text("file");
  const FileTreatment treatment = file_treatment(description);
  if (treatment.curve && on_surface)
    throw InputError(description.where() +
                     ": found curve, and a \"surface\" to which nodes are projected; "
                     "expected one of them");
  if (treatment.curve && degree.value_or(2) < 2)
    throw InputError(description.where() +
                     ": found curve and degree = 1; expected degree 2 to 4, or no curve");
  EvolveMesh result{read_mesh(file), {}};
  ReadMesh& start = result.start;
  if (!start.remark.empty()) result.remarks.push_back(file + ": " + start.remark);
  const bool flat = is_flat(start.mesh);
  if (!flat && !on_surface && (treatment.curve || treatment.remesh))
    throw InputError(file + ": the elements are curved; expected flat triangles for curve and remesh");
  const int k = degree.value_or(on_surface || treatment.curve ? 2 : flat ? 1 : start.mesh.degree);
  if (treatment.curve || treatment.remesh) raise_degree(start, 1);
  if (treatment.remesh) remesh_file(start, file, treatment, k, result.remarks);
  if (treatment.curve) {
    curve_file(start, file, treatment, k, result.remarks);
  } else {
    raise_degree(start, k);
    if (treatment.refine > 0) refine_file(start, file, treatment.refine);
  }
  if (!flat || on_surface || treatment.curve) return result;
  const char* const cure =
      "\"curve\": true beside \"file\" puts the nodes on a smooth surface through the corners";
  if (!degree)
    result.remarks.push_back(file + ": flat triangles, so degree 1 is taken; for degree 2 " + cure);
  else if (k > 1)
    result.remarks.push_back(format(
        "%s: flat triangles with elements of degree %d: edges are straight and creases stay, so that nu and "
        "H do not converge; %s",
        file.c_str(), k, cure));
  return result;
}

}  // namespace

std::set<std::string> mesh_keys() {
  std::set<std::string> known;
  for (const auto& [kind, others] : kinds) {
    known.insert(kind);
    known.insert(others.begin(), others.end());
  }
  return known;
}

void check_mesh_keys(const JsonReader& description, bool has_surface) {
  const std::set<std::string> known = mesh_keys();
  std::set<std::string> found, taken;
  description.accept_only(known);
  for (const auto& [kind, others] : kinds) {
    if (!description.has(kind)) continue;
    found.insert(kind);
    taken = others;
    taken.insert(kind);
  }
  for (const std::string& key : known)
    if (found.size() != 1 || (description.has(key) && taken.count(key) == 0))
      throw InputError(description.where() + ": found " + description.found() +
                       "; expected edge_length (with it grading), file (with it curve, refine, remesh) or "
                       "subdivisions");
  if (!has_surface && !description.has("file"))
    throw InputError(description.where() + ": " + *found.begin() +
                     " needs a \"surface\"; expected one, or a mesh with the key file");
}

EvolveMesh evolve_mesh(const JsonReader& description, std::optional<int> degree,
                       const std::optional<Surface>& surface) {
  check_mesh_keys(description, surface.has_value());
  EvolveMesh result;
  if (description.has("file")) {
    result = mesh_of_file(description, degree, surface.has_value());
  } else {
    const Mesh mesh =
        description.has("edge_length")
            ? generated(*surface, description)
            : subdivided(*surface, description.integer_within("subdivisions", 0, 0, 8), description.where());
    result.start.mesh = lagrange_mesh(mesh, degree.value_or(2));
  }
  if (surface) project_nodes(result.start.mesh, *surface);
  return result;
}

}  // namespace esfem
