// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "solver/mesh/mesh_file.hpp"

namespace esfem {

/// An element type of Gmsh: https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format.
struct MshElementType {
  int number;        ///< in the file
  int dimension;     ///< 0 of points to 3 of volumes
  int nodes;         ///< of an element
  int order;         ///< of the element map; 0 where these elements are not read
  const char* name;  ///< "10-node triangle"

  /// Of volume elements that are read: the nodes of each face, outward, corners first.
  std::vector<std::vector<int>> faces = {};

  /// The corners of a surface element.
  int corners() const { return number == 3 ? 4 : 3; }
};

/// The type with this number in the file; nullptr for those that are not known.
const MshElementType* msh_element_type(long number);

/// An element of the file; points and lines are not kept.
struct MshElement {
  const MshElementType* type;  ///< of the table; not nullptr
  long tag;                    ///< its number in the file
  int line;                    ///< 0 in a binary file
  std::size_t first;           ///< of its nodes in Msh::element_nodes
  long group = 0;              ///< physical group, in MSH 2
};

/// Values at nodes: a section $NodeData.
struct MshNodeData {
  std::string name;            ///< the first string of the section
  int components;              ///< values a node: 1, 3 or 9
  std::vector<long> nodes;     ///< tags
  std::vector<double> values;  ///< node by node
};

/// What an MSH file says, nodes and elements by the file's own numbers (tags).
struct Msh {
  std::string file;                           ///< its name, for errors
  std::vector<double> coordinates;            ///< three a node
  std::vector<long> node_tags;                ///< in the order of the coordinates
  std::vector<int> node_lines;                ///< empty in a binary file
  std::unordered_map<long, int> node_of_tag;  ///< tag -> place in node_tags
  std::vector<MshElement> elements;           ///< of surfaces and volumes
  std::vector<long> element_nodes;            ///< tags of their nodes, element by element
  std::vector<MshNodeData> node_data;         ///< in the order of the file
};

/// The surface of an MSH file: its triangles, 4-node quadrangles cut into two. Where the file has volume
/// elements, their boundary: the faces that belong to one of them only, under the numbers of the file's
/// triangles and quadrangles where these are the same. Elements that are there once for each of several
/// physical groups (MSH 2.2) are taken once. Throws InputError when there is no surface element, for elements
/// of several orders, and when a node is missing.
MeshFile msh_surface(Msh&& msh);

}  // namespace esfem
