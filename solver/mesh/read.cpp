// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/read.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>

#include "solver/error.hpp"
#include "solver/mesh/mesh_file.hpp"

namespace esfem {

namespace {

std::string lower_case_extension(const std::string& file) {
  const std::size_t dot = file.find_last_of("./\\");
  if (dot == std::string::npos || file[dot] != '.') return "";
  std::string extension = file.substr(dot + 1);
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

std::string content_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  // A directory opens, but cannot be read.
  if (!stream || stream.peek() == EOF || !(content << stream.rdbuf()))
    throw InputError(file + ": missing, empty or not readable, a mesh file expected");
  return content.str();
}

template <class Value>
void keep(std::vector<Value>& values, const std::vector<int>& kept) {
  if (values.empty()) return;
  std::vector<Value> result;
  for (int i : kept) result.push_back(values[i]);
  values = std::move(result);
}

/// Returns how many nodes were dropped. Nodes that an element names but that do not exist are left to the
/// check.
int drop_unused_nodes(MeshFile& read) {
  const int n = int(read.mesh.nodes.rows());
  std::vector<int> number(n, -1), kept;
  for (int i : read.mesh.elements.reshaped()) {
    if (i < 0 || i >= n) return 0;
    number[i] = 0;
  }
  for (int i = 0; i < n; ++i)
    if (number[i] == 0) {
      number[i] = int(kept.size());
      kept.push_back(i);
    }
  if (int(kept.size()) == n) return 0;
  const Field nodes = read.mesh.nodes(kept, Eigen::all);
  read.mesh.nodes = nodes;
  for (int& i : read.mesh.elements.reshaped()) i = number[i];
  // Numbers in errors stay those of the file.
  if (read.origin.node_tags.empty())
    for (int i = 0; i < n; ++i) read.origin.node_tags.push_back(i + 1);
  keep(read.origin.node_tags, kept);
  keep(read.origin.node_lines, kept);
  return n - int(kept.size());
}

}  // namespace

ReadMesh read_mesh(const std::string& file) {
  const std::string extension = lower_case_extension(file);
  const std::string known[] = {"msh", "off", "obj", "ply", "stl"};
  if (std::find(std::begin(known), std::end(known), extension) == std::end(known))
    throw InputError(format("%s: unknown mesh format '%s', .msh, .off, .obj, .ply or .stl expected",
                            file.c_str(), extension.c_str()));
  const std::string content = content_of(file);
  MeshFile read =
      extension == "msh" ? parse_msh(file, content) : parse_polygon_soup(file, content, extension);

  ReadMesh result;
  if (const int dropped = drop_unused_nodes(read))
    result.remark = format("%d node%s in no triangle: dropped", dropped, dropped > 1 ? "s" : "");
  if (check_closed_surface(read.mesh, read.origin))
    result.remark += (result.remark.empty() ? "" : "; ") + std::string("orientation was inward: turned");
  result.mesh = std::move(read.mesh);
  return result;
}

std::string check_closed_surface(Mesh& mesh, const std::string& source) {
  MeshOrigin origin;
  origin.source = source;
  return check_closed_surface(mesh, origin) ? "orientation was inward: turned" : "";
}

}  // namespace esfem
