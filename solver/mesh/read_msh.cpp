// SPDX-License-Identifier: GPL-3.0-or-later
// The sections of an MSH file: https://gmsh.info/doc/texinfo/gmsh.html#Gmsh-file-formats.
#include "solver/error.hpp"
#include "solver/mesh/msh_elements.hpp"
#include "solver/mesh/msh_records.hpp"

namespace esfem {

namespace {

/// Moves past the line that closes a section.
void close_section(MshRecords& records, const std::string& name) {
  records.close();
  const std::string end = "$End" + name;
  Lines& lines = records.lines;
  if (!lines.next()) lines.fail("the file ends here, " + end + " expected");
  if (lines.word(0) == end) return;
  // What stands there in a binary file need not be text.
  lines.fail((records.is_binary() ? "something else" : "'" + lines.word(0) + "'") + " found, " + end +
             " expected");
}

void add_node(Msh& msh, MshRecords& records, long tag, int tag_line) {
  if (!msh.node_of_tag.emplace(tag, int(msh.node_tags.size())).second) {
    const std::string what = format("node %ld a second time, every node once expected", tag);
    if (records.is_binary()) records.fail(what);
    throw InputError(format("%s: line %d: %s", msh.file.c_str(), tag_line, what.c_str()));
  }
  for (int i = 0; i < 3; ++i) msh.coordinates.push_back(records.coordinate());
  msh.node_tags.push_back(tag);
  if (!records.is_binary()) msh.node_lines.push_back(records.line());
}

void read_nodes_2(Msh& msh, MshRecords& records) {
  records.lines.expect("the number of nodes");
  const long n = records.lines.count(0, "number of nodes");
  records.open();
  for (long i = 0; i < n; ++i) {
    records.next(format("node %ld of %ld", i + 1, n));
    add_node(msh, records, records.integer("node number"), records.line());
    records.end();
  }
}

void read_nodes_4(Msh& msh, MshRecords& records) {
  records.open();
  records.next("the numbers of blocks and nodes");
  const long blocks = records.size_count("number of blocks"), total = records.size_count("number of nodes");
  records.size("smallest node number");
  records.size("largest node number");
  const std::size_t before = msh.node_tags.size();
  for (long block = 0; block < blocks; ++block) {
    records.next(format("the head of node block %ld of %ld", block + 1, blocks));
    const long dimension = records.integer_count("dimension");
    records.integer("number of the entity");
    const long parameters = records.integer("parametric") == 0 ? 0 : dimension;
    const long n = records.size_count("number of nodes in the block");
    records.end();
    std::vector<std::pair<long, int>> tags;
    for (long i = 0; i < n; ++i) {
      records.next(format("the number of node %ld of %ld", i + 1, n));
      tags.emplace_back(records.size("node number"), records.line());
      records.end();
    }
    for (const auto& [tag, line] : tags) {
      records.next(format("the coordinates of node %ld", tag));
      add_node(msh, records, tag, line);
      for (long i = 0; i < parameters; ++i) records.real("parameter of the node");
      records.end();
    }
  }
  const long found = long(msh.node_tags.size() - before);
  if (found != total) records.fail(format("%ld nodes in the blocks, %ld expected", found, total));
}

/// Points and lines are known, but not kept.
const MshElementType& readable_type(const MshRecords& records, long number) {
  const MshElementType* type = msh_element_type(number);
  if (type && (type->order > 0 || type->dimension < 2)) return *type;
  records.fail(
      format("element type %ld (%s), triangles with 3, 6, 10 or 15 nodes (types 2, 9, 21, 23), 4-node "
             "quadrangles (3) or the boundary of volume elements of types 4, 5, 6, 7, 11 expected",
             number, type ? type->name : "unknown"));
}

/// Reads the nodes of an element. node(): the next one of the record.
template <class Node>
void add_element(Msh& msh, const MshRecords& records, const MshElementType& type, long tag, long group,
                 Node node) {
  const std::size_t first = msh.element_nodes.size();
  for (int i = 0; i < type.nodes; ++i) msh.element_nodes.push_back(node());
  records.end();
  if (type.dimension > 1)
    msh.elements.push_back({&type, tag, records.line(), first, group});
  else
    msh.element_nodes.resize(first);
}

void read_elements_2(Msh& msh, MshRecords& records) {
  records.lines.expect("the number of elements");
  const long n = records.lines.count(0, "number of elements");
  const auto node = [&] { return records.integer("node"); };
  const auto group_of = [&](long tags) {
    const long group = tags > 0 ? records.integer("tag") : 0;
    for (long i = 1; i < tags; ++i) records.integer("tag");
    return group;
  };
  records.open();
  for (long i = 0; i < n;) {
    records.next(format("element %ld of %ld", i + 1, n));
    if (records.is_binary()) {
      const MshElementType& type = readable_type(records, records.integer("element type"));
      const long count = records.integer("number of elements"),
                 tags = records.integer_count("number of tags");
      if (count < 1 || count > n - i)
        records.fail(format("%ld elements in a block, 1 to %ld expected", count, n - i));
      for (const long end = i + count; i < end; ++i) {
        const long tag = records.integer("element number");
        const long group = group_of(tags);
        add_element(msh, records, type, tag, group, node);
      }
    } else {
      const long tag = records.integer("element number");
      const MshElementType& type = readable_type(records, records.integer("element type"));
      const long group = group_of(records.integer_count("number of tags"));
      add_element(msh, records, type, tag, group, node);
      ++i;
    }
  }
}

void read_elements_4(Msh& msh, MshRecords& records) {
  records.open();
  records.next("the numbers of blocks and elements");
  const long blocks = records.size_count("number of blocks");
  const long total = records.size_count("number of elements");
  records.size("smallest element number");
  records.size("largest element number");
  long found = 0;
  for (long block = 0; block < blocks; ++block) {
    records.next(format("the head of element block %ld of %ld", block + 1, blocks));
    records.integer("dimension");
    records.integer("number of the entity");
    const MshElementType& type = readable_type(records, records.integer("element type"));
    const long n = records.size_count("number of elements in the block");
    records.end();
    for (long i = 0; i < n; ++i) {
      records.next(format("element %ld of %ld", i + 1, n));
      const long tag = records.size("element number");
      add_element(msh, records, type, tag, 0, [&] { return records.size("node"); });
    }
    found += n;
  }
  if (found != total) records.fail(format("%ld elements in the blocks, %ld expected", found, total));
}

/// The text of a line, without the quotes around it.
std::string unquoted(const Lines& lines) {
  std::string text = lines.word(0);
  for (int i = 1; i < lines.size(); ++i) text += " " + lines.word(i);
  const bool quoted = text.size() > 1 && text.front() == '"' && text.back() == '"';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

void read_node_data(Msh& msh, MshRecords& records) {
  Lines& lines = records.lines;
  const auto count_of = [&](const char* what) {
    lines.expect("the " + std::string(what));
    return lines.count(0, what);
  };
  MshNodeData data;
  const long texts = count_of("number of string tags");
  for (long i = 0; i < texts; ++i) {
    lines.expect("a string tag");
    if (i == 0) data.name = unquoted(lines);
  }
  const long reals = count_of("number of real tags");
  for (long i = 0; i < reals; ++i) lines.expect("a real tag");
  const long integers = count_of("number of integer tags");
  if (integers < 3)
    lines.fail(format("%ld integer tags, at least 3 expected: time step, components, nodes", integers));
  std::vector<long> tags;
  for (long i = 0; i < integers; ++i) tags.push_back(count_of("integer tag"));
  data.components = int(std::min(tags[1], 9l));
  if (tags[1] != 1 && tags[1] != 3 && tags[1] != 9)
    lines.fail(format("%ld components a node, 1, 3 or 9 expected", tags[1]));
  records.open();
  for (long i = 0; i < tags[2]; ++i) {
    records.next(format("the values of node %ld of %ld", i + 1, tags[2]));
    data.nodes.push_back(records.integer("node number"));
    for (int j = 0; j < data.components; ++j) data.values.push_back(records.real("value"));
    records.end();
  }
  msh.node_data.push_back(std::move(data));
}

/// Reads the head of the file; returns the major version, 2 or 4.
int read_format(MshRecords& records) {
  Lines& lines = records.lines;
  const std::string save = " (save it with Mesh.MshFileVersion = 4.1)";
  const bool has_head = lines.next();
  if (has_head && lines.word(0) == "$NOD") lines.fail("MSH version 1, 2.2 or 4.1 expected" + save);
  if (!has_head || lines.word(0) != "$MeshFormat") lines.fail("no Gmsh file, $MeshFormat expected");
  lines.expect("the format's version");
  const std::string version = lines.word(0);
  const bool is_2 = version == "2" || version == "2.0" || version == "2.1" || version == "2.2";
  if (!is_2 && version != "4.1") lines.fail("MSH version " + version + ", 2.2 or 4.1 expected" + save);
  const long is_binary = lines.integer(1, "file type"), data_size = lines.integer(2, "data size");
  if (is_binary != 0 && is_binary != 1) lines.fail(format("file type %ld, 0 or 1 expected", is_binary));
  if (is_binary == 1) {
    if (data_size != 8) lines.fail(format("data size %ld, 8 expected", data_size));
    records.set_binary(false);
    records.open();
    const long one = records.integer("the number 1");
    if (one != 1 && one != 1 << 24) records.fail(format("%ld found, the number 1 expected", one));
    records.close();
    records.set_binary(one != 1);
  }
  close_section(records, "MeshFormat");
  return is_2 ? 2 : 4;
}

void skip_section(Lines& lines, const std::string& name) {
  while (lines.next())
    if (lines.word(0) == "$End" + name) return;
  lines.fail("the file ends here, $End" + name + " expected");
}

}  // namespace

MeshFile parse_msh(const std::string& file, const std::string& text) {
  MshRecords records(file, text);
  Lines& lines = records.lines;
  Msh msh;
  msh.file = file;
  const bool is_2 = read_format(records) == 2;
  bool has_nodes = false, has_elements = false;
  while (lines.next()) {
    const std::string head = lines.word(0), section = head.substr(1);
    if (head[0] != '$')
      lines.fail((records.is_binary() ? "something else" : "'" + head + "'") +
                 " found, the head of a section ($...) expected");
    if (section == "ParametricNodes")
      lines.fail("nodes with parameters, $Nodes expected (save it with Mesh.SaveParametric = 0)");
    if (section == "Nodes") {
      is_2 ? read_nodes_2(msh, records) : read_nodes_4(msh, records);
      has_nodes = true;
    } else if (section == "Elements") {
      is_2 ? read_elements_2(msh, records) : read_elements_4(msh, records);
      has_elements = true;
    } else if (section == "NodeData") {
      read_node_data(msh, records);
    } else {
      skip_section(lines, section);
      continue;
    }
    close_section(records, section);
  }
  if (!has_nodes) lines.fail("the file ends here, $Nodes expected");
  if (!has_elements) lines.fail("the file ends here, $Elements expected");
  return msh_surface(std::move(msh));
}

}  // namespace esfem
