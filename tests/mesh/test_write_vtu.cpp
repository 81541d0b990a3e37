// SPDX-License-Identifier: GPL-3.0-or-later
// What needs no reader; test_vtu_files.py reads the files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>

#include "solver/error.hpp"
#include "solver/mesh/write_vtu.hpp"
#include "tests/mesh/test_folder.hpp"

namespace esfem::test_write_vtu {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

const SnapshotLabel label = {7, 0.1, {"mean_curvature", "{\"tau\": 0.1}"}};

void write(const Mesh& mesh, const std::string& file) {
  write_vtu(mesh.degree, mesh.elements, mesh.nodes, {{"v", mesh.nodes}}, label, file);
}

class WriteVtu : public Folder {};
class WriteVtuDegree : public Folder, public testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, WriteVtuDegree, testing::Values(1, 2, 3, 4));

}  // namespace

TEST_F(WriteVtu, HeadSaysWhatFollows) {
  Connectivity elements(1, 3);
  elements << 0, 1, 2;
  const Field x = Field::Identity(3, 3);
  write_vtu(1, elements, x, {{"H", x.col(0)}, {"v", x}}, {7, 0.1, {"mcf", ""}}, path("a.vtu"));
  const std::string expected = R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<UnstructuredGrid>
<FieldData>
<DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="appended" offset="0"/>
<DataArray type="Int32" Name="step" NumberOfTuples="1" format="appended" offset="16"/>
<DataArray type="UInt8" Name="flow" NumberOfTuples="3" format="appended" offset="28"/>
</FieldData>
<Piece NumberOfPoints="3" NumberOfCells="1">
<PointData>
<DataArray type="Float64" Name="H" format="appended" offset="39"/>
<DataArray type="Float64" Name="v" NumberOfComponents="3" format="appended" offset="71"/>
</PointData>
<Points>
<DataArray type="Float64" Name="Points" NumberOfComponents="3" format="appended" offset="151"/>
</Points>
<Cells>
<DataArray type="Int32" Name="connectivity" format="appended" offset="231"/>
<DataArray type="Int64" Name="offsets" format="appended" offset="251"/>
<DataArray type="UInt8" Name="types" format="appended" offset="267"/>
</Cells>
</Piece>
</UnstructuredGrid>
<AppendedData encoding="raw">
_)";
  const std::string text = content(path("a.vtu")), end = "\n</AppendedData>\n</VTKFile>\n";
  EXPECT_EQ(text.substr(0, expected.size()), expected);
  EXPECT_EQ(text.size(), expected.size() + 276 + end.size());
  EXPECT_EQ(text.substr(text.size() - end.size()), end);
  EXPECT_EQ(text.substr(expected.size() + 28, 11), std::string("\3\0\0\0\0\0\0\0mcf", 11));
}

TEST_P(WriteVtuDegree, TheSameDataGiveTheSameBytes) {
  write(curved_sphere(GetParam()), path("a.vtu"));
  write(curved_sphere(GetParam()), path("b.vtu"));
  EXPECT_EQ(content(path("a.vtu")), content(path("b.vtu")));
  Mesh other = curved_sphere(GetParam());
  other.nodes(5, 1) = std::nextafter(other.nodes(5, 1), 2);
  write(other, path("b.vtu"));
  EXPECT_NE(content(path("a.vtu")), content(path("b.vtu")));
}

TEST_F(WriteVtu, RefusesNamesThatXmlCannotHave) {
  const Mesh mesh = curved_sphere(1);
  const auto write_as = [&](const std::string& name) {
    write_vtu(1, mesh.elements, mesh.nodes, {{name, mesh.nodes.col(0)}}, label, path("a.vtu"));
  };
  for (const std::string name : {"a&b", "a<b", "a>b", "a\"b", "a\nb", ""})
    EXPECT_THAT(complaint<InputError>([&] { write_as(name); }),
                HasSubstr("a.vtu: field 1 (counted from 1) has a name"))
        << name;
  EXPECT_THAT(files(), ElementsAre());
  for (const std::string name : {"|A|²", "mean curvature", "'κ', 100%"}) {
    write_as(name);
    EXPECT_THAT(content(path("a.vtu")), HasSubstr("Name=\"" + name + "\""));
  }
}

TEST_F(WriteVtu, RefusesSizesThatDoNotFit) {
  const Mesh mesh = curved_sphere(2);
  const int n = int(mesh.nodes.rows());
  const auto refused = [&](int degree, const Connectivity& elements, const Field& x,
                           const NodalFields& fields) {
    return complaint<InputError>([&] { write_vtu(degree, elements, x, fields, label, path("a.vtu")); });
  };
  EXPECT_THAT(refused(5, mesh.elements, mesh.nodes, {}), HasSubstr("degree 5"));
  EXPECT_THAT(refused(0, mesh.elements, mesh.nodes, {}), HasSubstr("degree 0"));
  EXPECT_THAT(refused(3, mesh.elements, mesh.nodes, {}),
              AllOf(HasSubstr("a.vtu: "), HasSubstr("10 expected")));
  EXPECT_THAT(refused(2, mesh.elements, mesh.nodes.leftCols(2), {}), HasSubstr("x has 2 columns"));
  EXPECT_THAT(refused(2, mesh.elements, mesh.nodes.topRows(n - 1), {}),
              HasSubstr(format("has node %d (both counted from 1), 1 to %d expected", n, n - 1)));
  Connectivity negative = mesh.elements;
  negative(7, 2) = -1;
  EXPECT_THAT(refused(2, negative, mesh.nodes, {}), HasSubstr("element 8 has node 0"));

  EXPECT_THAT(refused(2, mesh.elements, mesh.nodes, {{"u", Field::Zero(n - 1, 1)}}),
              HasSubstr(format("field 'u' has %d rows, one for each of %d nodes expected", n - 1, n)));
  EXPECT_THAT(refused(2, mesh.elements, mesh.nodes, {{"u", Field::Zero(n, 2)}}),
              HasSubstr("field 'u' has 2 columns, 1 or 3 expected"));
  EXPECT_THAT(refused(2, mesh.elements, mesh.nodes, {{"u", mesh.nodes}, {"u", mesh.nodes}}),
              HasSubstr("two fields have the name 'u'"));
  EXPECT_THAT(files(), ElementsAre());
}

TEST_F(WriteVtu, RefusesWhatIsNotFiniteAndKeepsTheOldFile) {
  const Mesh mesh = curved_sphere(2);
  write(mesh, path("a.vtu"));
  const std::string old = content(path("a.vtu"));
  for (const double bad : {NAN, INFINITY, -INFINITY}) {
    Field wrong = mesh.nodes;
    wrong(4, 2) = bad;
    EXPECT_THAT(complaint<NumericsError>([&] {
                  write_vtu(2, mesh.elements, mesh.nodes, {{"v", wrong}}, label, path("a.vtu"));
                }),
                AllOf(HasSubstr("a.vtu: field 'v' is "), HasSubstr("at node 5 ")));
    EXPECT_THAT(
        complaint<NumericsError>([&] { write_vtu(2, mesh.elements, wrong, {}, label, path("a.vtu")); }),
        AllOf(HasSubstr("a.vtu: x is "), HasSubstr("at node 5 ")));
    EXPECT_THAT(complaint<NumericsError>([&] {
                  write_vtu(2, mesh.elements, mesh.nodes, {}, {7, bad, {}}, path("a.vtu"));
                }),
                AllOf(HasSubstr("a.vtu: a snapshot at time "), HasSubstr("a finite time expected")));
  }
  EXPECT_EQ(content(path("a.vtu")), old);
  EXPECT_THAT(files(), ElementsAre("a.vtu"));
}

TEST_F(WriteVtu, RefusesBadPlaces) {
  const Mesh mesh = curved_sphere(1);
  EXPECT_THAT(complaint<InputError>([&] { write(mesh, path("no/a.vtu")); }),
              AllOf(HasSubstr("no/a.vtu: cannot be written"), HasSubstr("No such file")));
  write(mesh, path("a.vtu"));
  EXPECT_THAT(complaint<InputError>([&] { write(mesh, path("a.vtu/b.vtu")); }),
              HasSubstr("cannot be written"));
  EXPECT_THAT(complaint<InputError>([&] { write(mesh, folder.string()); }), HasSubstr("cannot be written"));
  EXPECT_THAT(files(), ElementsAre("a.vtu"));
}

TEST_F(WriteVtu, KeepsTheOldFileWhenTheNewOneFindsNoRoom) {
  write(curved_sphere(1), path("a.vtu"));
  const std::string old = content(path("a.vtu"));
  // Stands for a full disk.
  rlimit limit;
  getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit small = {1000, limit.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string message = complaint<InputError>([&] { write(curved_sphere(2), path("a.vtu")); });
  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(message, HasSubstr("a.vtu: cannot be written"));
  EXPECT_EQ(content(path("a.vtu")), old);
  EXPECT_THAT(files(), ElementsAre("a.vtu"));
}

}  // namespace esfem::test_write_vtu
