// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh and its nodal values come back from the files of write_vtu and write_msh to the last bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "solver/error.hpp"
#include "solver/mesh/mesh_file.hpp"
#include "solver/mesh/read.hpp"
#include "solver/mesh/write_vtu.hpp"
#include "tests/mesh/test_folder.hpp"

namespace esfem::test_read_vtu {

using testing::HasSubstr;
using testing::StartsWith;

namespace {

NodalFields fields_on(const Mesh& mesh) {
  return {{"H", mesh.nodes.col(0) / 3}, {"two words", mesh.nodes / 7}};
}

void write_sample(const Mesh& mesh, const std::string& file) {
  write_vtu(mesh.degree, mesh.elements, mesh.nodes, fields_on(mesh), {3, 0.1, {"dziuk", "{}"}}, file);
}

/// The complaint about the content with a text replaced.
std::string complaint_about(std::string content, const std::string& from, const std::string& to) {
  const std::size_t place = content.find(from);
  EXPECT_NE(place, content.npos) << from;
  content.replace(place, from.size(), to);
  return complaint<InputError>([&] { parse_vtu("a.vtu", content); });
}

}  // namespace

class ReadVtu : public Folder {};
class ReadVtuDegrees : public Folder, public testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(All, ReadVtuDegrees, testing::Values(1, 2, 3, 4));

TEST_P(ReadVtuDegrees, GivesTheSameBits) {
  const Mesh mesh = curved_sphere(GetParam());
  write_sample(mesh, path("a.vtu"));
  const ReadMesh read = read_mesh(path("a.vtu"));
  EXPECT_EQ(read.remark, "");
  EXPECT_EQ(read.mesh.degree, mesh.degree);
  EXPECT_EQ(read.mesh.nodes, mesh.nodes);
  EXPECT_EQ(read.mesh.elements, mesh.elements);
  const NodalFields expected = fields_on(mesh);
  EXPECT_EQ(read.t, 0.1);
  ASSERT_EQ(read.fields.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(read.fields[i].name, expected[i].name);
    EXPECT_EQ(read.fields[i].values, expected[i].values);
  }
}

TEST_P(ReadVtuDegrees, SoDoesMsh) {
  const Mesh mesh = curved_sphere(GetParam());
  write_msh(mesh, path("a.msh"));
  const ReadMesh read = read_mesh(path("a.msh"));
  EXPECT_EQ(read.remark, "");
  EXPECT_EQ(read.mesh.degree, mesh.degree);
  EXPECT_EQ(read.mesh.nodes, mesh.nodes);
  EXPECT_EQ(read.mesh.elements, mesh.elements);
}

TEST_F(ReadVtu, OtherFilesAreRefusedByLine) {
  write_sample(curved_sphere(2), path("a.vtu"));
  const std::string good = content(path("a.vtu"));
  EXPECT_EQ(complaint_about(good, "<Points>", "<Points>"), "no error");
  EXPECT_THAT(complaint_about(good, "<UnstructuredGrid>", "<PolyData>"),
              StartsWith("a.vtu: line 3: no VTU file of evolve, '<UnstructuredGrid>' expected; "
                         "plots/convert_mesh.py"));
  EXPECT_THAT(complaint_about(good, "format=\"appended\"", "format=\"ascii\""), HasSubstr("line 5: "));
  EXPECT_THAT(complaint_about(good, "UInt64", "UInt32"), HasSubstr("line 2: "));
  EXPECT_THAT(complaint_about(good, "raw", "base64"),
              HasSubstr("'<AppendedData encoding=\"raw\">' expected"));
  EXPECT_THAT(complaint_about(good, "\"Int32\" Name=\"connectivity\"", "\"Int64\" Name=\"connectivity\""),
              HasSubstr("connectivity of type Int32 expected"));
  EXPECT_THAT(complaint_about(good, "NumberOfPoints=\"", "NumberOfPoints=\"-"),
              HasSubstr("a number as NumberOfPoints expected"));
  EXPECT_THAT(complaint_about(good, "NumberOfPoints=\"", "NumberOfPoints=\"1"), HasSubstr(" bytes, "));
  EXPECT_THAT(complaint_about(good, "NumberOfCells=\"80\"", "NumberOfCells=\"60\""), HasSubstr("expected"));
  EXPECT_THAT(complaint_about(good, "LittleEndian", "BigEndian"), HasSubstr("expected"));
}

TEST_F(ReadVtu, CutOffAnywhereIsAnError) {
  write_sample(curved_sphere(1, 0), path("a.vtu"));
  const std::string whole = content(path("a.vtu"));
  EXPECT_EQ(complaint<InputError>([&] { parse_vtu("a.vtu", whole); }), "no error");
  const std::size_t end = whole.rfind("\n</AppendedData>");
  for (std::size_t length = 0; length < end; ++length)
    EXPECT_THROW(parse_vtu("a.vtu", whole.substr(0, length)), InputError) << length;
}

TEST_F(ReadVtu, TheOtherByteOrder) {
  const Mesh mesh = curved_sphere(1, 0);
  write_sample(mesh, path("a.vtu"));
  std::string text = content(path("a.vtu"));
  // The arrays as they follow each other, by the sizes of their numbers.
  std::size_t place = text.find("\n_") + 2;
  for (std::size_t size : {8, 4, 1, 1, 8, 8, 8, 4, 8, 1}) {
    const auto swap = [&](std::size_t bytes) {
      std::reverse(text.begin() + place, text.begin() + place + bytes);
      place += bytes;
    };
    std::uint64_t length;
    std::memcpy(&length, text.data() + place, 8);
    swap(8);
    for (std::size_t i = 0; i < length / size; ++i) swap(size);
  }
  const bool is_little = text.find("LittleEndian") != text.npos;
  const std::string from = is_little ? "LittleEndian" : "BigEndian";
  text.replace(text.find(from), from.size(), is_little ? "BigEndian" : "LittleEndian");
  const MeshFile read = parse_vtu("a.vtu", text);
  EXPECT_EQ(read.mesh.nodes, mesh.nodes);
  EXPECT_EQ(read.mesh.elements, mesh.elements);
  EXPECT_EQ(read.fields[1].values, fields_on(mesh)[1].values);
}

TEST_F(ReadVtu, OtherEndingsNameTheScript) {
  for (const char* name : {"a.vtk", "a.xdmf", "a"})
    EXPECT_THAT(complaint<InputError>([&] { read_mesh(path(name)); }),
                HasSubstr("plots/convert_mesh.py IN OUT.msh"));
}

}  // namespace esfem::test_read_vtu
