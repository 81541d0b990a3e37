// SPDX-License-Identifier: GPL-3.0-or-later
#include <unordered_map>

#include "solver/error.hpp"
#include "solver/mesh/lines.hpp"
#include "solver/mesh/mesh_file.hpp"

namespace esfem {

namespace {

bool lower_dimensional(long type) {
  for (long known : {1, 8, 15, 26, 27, 28, 62, 63, 64, 65, 66})
    if (type == known) return true;
  return false;
}

std::string type_name(long type) {
  switch (type) {
  case 3:
    return "4-node quadrangle";
  case 4:
    return "4-node tetrahedron";
  case 5:
    return "8-node hexahedron";
  case 6:
    return "6-node prism";
  case 7:
    return "5-node pyramid";
  case 10:
    return "9-node quadrangle";
  case 11:
    return "10-node tetrahedron";
  case 16:
    return "8-node quadrangle";
  case 20:
    return "9-node triangle";
  case 21:
    return "10-node triangle";
  case 22:
    return "12-node triangle";
  case 23:
    return "15-node triangle";
  default:
    return "another element";
  }
}

/// The parts of an MSH file as they are read; elements by node tags.
struct Msh {
  std::vector<double> coordinates;
  std::vector<long> corners;  ///< of all triangles, one after the other
  std::unordered_map<long, int> node_of_tag;
  MeshOrigin origin;
  int nodes_per_triangle = 0;
};

void add_node(Msh& msh, const Lines& lines, long tag, int tag_line, int first_word) {
  if (!msh.node_of_tag.emplace(tag, int(msh.origin.node_tags.size())).second)
    throw InputError(format("%s: line %d: node %ld a second time, every node once expected",
                            msh.origin.source.c_str(), tag_line, tag));
  for (int i = 0; i < 3; ++i) msh.coordinates.push_back(lines.coordinate(first_word + i));
  msh.origin.node_tags.push_back(tag);
  msh.origin.node_lines.push_back(lines.number());
}

/// The element on the current line, whose nodes start at a word; points and lines are skipped.
void add_element(Msh& msh, const Lines& lines, long type, int first_word) {
  if (lower_dimensional(type)) return;
  if (type != 2 && type != 9)
    lines.fail(format("element type %ld (%s), a 3-node (2) or a 6-node (9) triangle expected", type,
                      type_name(type).c_str()));
  const int nodes = type == 2 ? 3 : 6;
  if (msh.nodes_per_triangle != 0 && msh.nodes_per_triangle != nodes)
    lines.fail(format("a %d-node triangle after %d-node triangles, one type expected", nodes,
                      msh.nodes_per_triangle));
  msh.nodes_per_triangle = nodes;
  if (lines.size() != first_word + nodes)
    lines.fail(format("%d words found, %d expected", lines.size(), first_word + nodes));
  for (int i = 0; i < nodes; ++i) msh.corners.push_back(lines.integer(first_word + i, "node"));
  msh.origin.element_tags.push_back(lines.integer(0, "element number"));
  msh.origin.element_lines.push_back(lines.number());
}

void read_nodes_2(Msh& msh, Lines& lines) {
  lines.expect("the number of nodes");
  const long n = lines.count(0, "number of nodes");
  for (long i = 0; i < n; ++i) {
    lines.expect(format("node %ld of %ld", i + 1, n));
    add_node(msh, lines, lines.integer(0, "node number"), lines.number(), 1);
  }
}

void read_elements_2(Msh& msh, Lines& lines) {
  lines.expect("the number of elements");
  const long n = lines.count(0, "number of elements");
  for (long i = 0; i < n; ++i) {
    lines.expect(format("element %ld of %ld", i + 1, n));
    const long tags = lines.count(2, "number of tags");
    if (tags > lines.size()) lines.fail(format("%ld tags announced, %d words found", tags, lines.size()));
    add_element(msh, lines, lines.integer(1, "element type"), 3 + int(tags));
  }
}

void read_nodes_4(Msh& msh, Lines& lines) {
  lines.expect("the numbers of blocks and nodes");
  const long blocks = lines.count(0, "number of blocks"), total = lines.count(1, "number of nodes");
  const std::size_t before = msh.origin.node_tags.size();
  for (long block = 0; block < blocks; ++block) {
    lines.expect(format("the head of node block %ld of %ld", block + 1, blocks));
    const long n = lines.count(3, "number of nodes in the block");
    std::vector<std::pair<long, int>> tags;
    for (long i = 0; i < n; ++i) {
      lines.expect(format("the number of node %ld of %ld", i + 1, n));
      if (lines.size() != 1) lines.fail(format("%d words found, one node number expected", lines.size()));
      tags.emplace_back(lines.integer(0, "node number"), lines.number());
    }
    for (const auto& [tag, line] : tags) {
      lines.expect(format("the coordinates of node %ld", tag));
      add_node(msh, lines, tag, line, 0);
    }
  }
  const long found = long(msh.origin.node_tags.size() - before);
  if (found != total) lines.fail(format("%ld nodes in the blocks, %ld expected", found, total));
}

void read_elements_4(Msh& msh, Lines& lines) {
  lines.expect("the numbers of blocks and elements");
  const long blocks = lines.count(0, "number of blocks"), total = lines.count(1, "number of elements");
  long found = 0;
  for (long block = 0; block < blocks; ++block) {
    lines.expect(format("the head of element block %ld of %ld", block + 1, blocks));
    const long type = lines.integer(2, "element type"), n = lines.count(3, "number of elements in the block");
    for (long i = 0; i < n; ++i) {
      lines.expect(format("element %ld of %ld", i + 1, n));
      add_element(msh, lines, type, 1);
    }
    found += n;
  }
  if (found != total) lines.fail(format("%ld elements in the blocks, %ld expected", found, total));
}

/// Goes behind the line that closes a section.
void close_section(Lines& lines, const std::string& name) {
  const std::string end = "$End" + name;
  if (!lines.next()) lines.fail("the file ends here, " + end + " expected");
  if (lines.word(0) != end) lines.fail("'" + lines.word(0) + "' found, " + end + " expected");
}

/// Reads the head of the file; returns the major version, 2 or 4.
int read_format(Lines& lines) {
  if (!lines.next() || lines.word(0) != "$MeshFormat") lines.fail("no Gmsh file, $MeshFormat expected");
  lines.expect("the format's version");
  const std::string version = lines.word(0);
  if (lines.integer(1, "file type") != 0)
    lines.fail("binary MSH file, ASCII expected (save it with Mesh.Binary = 0, or gmsh -save -bin 0)");
  if (version != "2.2" && version != "4.1")
    lines.fail("MSH version " + version + ", 2.2 or 4.1 expected (save it with Mesh.MshFileVersion = 4.1)");
  close_section(lines, "MeshFormat");
  return version == "2.2" ? 2 : 4;
}

void skip_section(Lines& lines, const std::string& name) {
  while (lines.next())
    if (lines.word(0) == "$End" + name) return;
  lines.fail("the file ends here, $End" + name + " expected");
}

}  // namespace

MeshFile parse_msh(const std::string& file, const std::string& text) {
  Lines lines(file, text);
  Msh msh;
  msh.origin.source = file;
  const int version = read_format(lines);
  bool has_nodes = false, has_elements = false;
  while (lines.next()) {
    if (lines.word(0)[0] != '$')
      lines.fail("'" + lines.word(0) + "' found, the head of a section ($...) expected");
    const std::string section = lines.word(0).substr(1);
    if (section == "Nodes") {
      version == 2 ? read_nodes_2(msh, lines) : read_nodes_4(msh, lines);
      has_nodes = true;
      close_section(lines, section);
    } else if (section == "Elements") {
      version == 2 ? read_elements_2(msh, lines) : read_elements_4(msh, lines);
      has_elements = true;
      close_section(lines, section);
    } else {
      skip_section(lines, section);
    }
  }
  if (!has_nodes) lines.fail("the file ends here, $Nodes expected");
  if (!has_elements) lines.fail("the file ends here, $Elements expected");
  if (msh.corners.empty()) lines.fail("no triangle (element type 2 or 9) in the file, at least one expected");

  MeshFile result;
  result.mesh.degree = msh.nodes_per_triangle == 3 ? 1 : 2;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  result.mesh.nodes = Eigen::Map<const Rows>(msh.coordinates.data(), msh.coordinates.size() / 3, 3);
  const int columns = msh.nodes_per_triangle;
  result.mesh.elements.resize(msh.corners.size() / columns, columns);
  for (std::size_t i = 0; i < msh.corners.size(); ++i) {
    const auto node = msh.node_of_tag.find(msh.corners[i]);
    const int e = int(i) / columns;
    if (node == msh.node_of_tag.end())
      throw InputError(format("%s: %s: node %ld is not in $Nodes, a node of the file expected", file.c_str(),
                              msh.origin.element(e).c_str(), msh.corners[i]));
    result.mesh.elements(e, int(i) % columns) = node->second;
  }
  result.origin = std::move(msh.origin);
  return result;
}

}  // namespace esfem
