// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/read.hpp"

#include <cctype>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include "solver/error.hpp"
#include "solver/mesh/mesh_file.hpp"
#include "solver/mesh/repair.hpp"

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

std::string joined(const std::vector<std::string>& remarks) {
  std::string text;
  for (const std::string& remark : remarks)
    if (!remark.empty()) text += (text.empty() ? "" : "; ") + remark;
  return text;
}

using Parser = MeshFile (*)(const std::string& file, const std::string& content);

Parser parser_of(const std::string& file) {
  const std::string extension = lower_case_extension(file);
  const std::pair<const char*, Parser> parsers[] = {{"msh", parse_msh}, {"vtu", parse_vtu},
                                                    {"off", parse_off}, {"obj", parse_obj},
                                                    {"ply", parse_ply}, {"stl", parse_stl}};
  for (const auto& [known, parser] : parsers)
    if (extension == known) return parser;
  if (extension == "pvd")
    throw InputError(file + ": a list of snapshots; expected one of the .vtu files beside it that it names");
  throw InputError(
      format("%s: unknown mesh format '%s', .msh, .off, .obj, .ply, .stl or .vtu (of evolve) expected; "
             "plots/convert_mesh.py IN OUT.msh converts what meshio reads (VTK, VTU, XDMF, ...)",
             file.c_str(), extension.c_str()));
}

std::vector<long> numbers_of(const MeshOrigin& origin) {
  for (std::size_t i = 0; i < origin.node_tags.size(); ++i)
    if (origin.node_tags[i] != long(i) + 1) return origin.node_tags;
  return {};
}

}  // namespace

std::string repair_and_check(MeshFile& file) {
  repair(file);
  try {
    file.remarks.push_back(check_closed_surface(file.mesh, file.origin));
  } catch (const InputError& error) {
    if (file.remarks.empty()) throw;
    throw InputError(std::string(error.what()) + " (before: " + joined(file.remarks) + ")");
  }
  return joined(file.remarks);
}

ReadMesh read_mesh(const std::string& file) {
  const Parser parse = parser_of(file);
  MeshFile read = parse(file, content_of(file));
  const std::string remark = repair_and_check(read);
  std::vector<long> node_numbers = numbers_of(read.origin);
  return {std::move(read.mesh),   remark, std::move(read.fields), std::move(node_numbers),
          std::move(read.origin), read.t};
}

std::string check_closed_surface(Mesh& mesh, const std::string& source) {
  MeshOrigin origin;
  origin.source = source;
  return check_closed_surface(mesh, origin);
}

}  // namespace esfem
