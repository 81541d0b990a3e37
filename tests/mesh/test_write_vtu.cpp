// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <vtkCell.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/mesh/mesh.hpp"
#include "solver/mesh/write_vtu.hpp"

using namespace esfem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

namespace {

/// A sphere with curved elements, nodes with numbers that need all digits.
Mesh curved_sphere(int degree, int subdivisions = 1) {
  Mesh mesh = lagrange_mesh(icosphere(1.0 / 3, subdivisions), degree);
  mesh.nodes.rowwise().normalize();
  return mesh;
}

/// Fields with numbers that only binary files keep.
std::vector<PointField> sample_fields(const Mesh& mesh) {
  Field H = mesh.nodes.rowwise().sum() / 7, v = -mesh.nodes.array().exp().matrix();
  using Limits = std::numeric_limits<double>;
  H.topRows(4) << Limits::denorm_min(), Limits::max(), -0.0, std::nextafter(1.0, 2.0);
  return {{"H", H}, {"v", v}};
}

void write(const Mesh& mesh, const std::string& file) {
  write_vtu(mesh.degree, mesh.elements, mesh.nodes, sample_fields(mesh), file);
}

vtkSmartPointer<vtkUnstructuredGrid> read(const std::string& file) {
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  return reader->GetOutput();
}

/// The values of an array of doubles; empty when it is none.
Field values(vtkDataArray* array) {
  if (!array || array->GetDataType() != VTK_DOUBLE) return Field();
  Field values(array->GetNumberOfTuples(), array->GetNumberOfComponents());
  for (int i = 0; i < values.rows(); ++i)
    for (int l = 0; l < values.cols(); ++l) values(i, l) = array->GetComponent(i, l);
  return values;
}

bool same_bits(const Field& a, const Field& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// Largest distance between VTK's cells and the element maps at a few points of each element.
double distance_of_maps(vtkUnstructuredGrid* grid, const Mesh& mesh) {
  Eigen::Matrix<double, Eigen::Dynamic, 2> points(6, 2);
  points << 0.2, 0.3, 0.7, 0.1, 0.05, 0.9, 0.5, 0, 0, 0.15, 0.4, 0.6;
  const Eigen::MatrixXd shape = shape_functions(mesh.degree, points).value;
  std::vector<double> weights(mesh.elements.cols());
  double distance = 0;
  for (int e = 0; e < mesh.elements.rows(); ++e)
    for (int q = 0; q < points.rows(); ++q) {
      const double parameters[3] = {points(q, 0), points(q, 1), 0};
      int sub_cell = 0;
      Vec3 x;
      grid->GetCell(e)->EvaluateLocation(sub_cell, parameters, x.data(), weights.data());
      for (int i = 0; i < mesh.elements.cols(); ++i)
        x -= shape(q, i) * mesh.nodes.row(mesh.elements(e, i)).transpose();
      distance = std::max(distance, x.norm());
    }
  return distance;
}

std::string content(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

template <class Error, class Action>
std::string complaint(Action action) {
  try {
    action();
    return "no error";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
}

/// Time and file of each snapshot of a collection.
std::vector<std::pair<double, std::string>> snapshots(const std::string& pvd) {
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(pvd.c_str()));
  std::vector<std::pair<double, std::string>> found;
  if (!root || std::string(root->GetName()) != "VTKFile") return found;
  EXPECT_STREQ(root->GetAttribute("type"), "Collection");
  vtkXMLDataElement* collection = root->FindNestedElementWithName("Collection");
  for (int i = 0; collection && i < collection->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement* snapshot = collection->GetNestedElement(i);
    EXPECT_STREQ(snapshot->GetName(), "DataSet");
    EXPECT_STREQ(snapshot->GetAttribute("part"), "0");
    found.emplace_back(std::stod(snapshot->GetAttribute("timestep")), snapshot->GetAttribute("file"));
  }
  return found;
}

/// An empty folder for each test.
class Folder : public testing::Test {
 protected:
  Folder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + "_" + test->name();
    std::replace(name.begin(), name.end(), '/', '_');
    folder = fs::path(ESFEM_BINARY_DIR) / "test_vtu" / name;
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  std::string path(const std::string& name) const { return (folder / name).string(); }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }
  fs::path folder;
};

class WriteVtu : public Folder {};
class WriteVtuDegree : public Folder, public testing::WithParamInterface<int> {};
class Snapshots : public Folder {};
INSTANTIATE_TEST_SUITE_P(Degrees, WriteVtuDegree, testing::Values(1, 2, 3, 4));

}  // namespace

TEST_P(WriteVtuDegree, IsReadBackToTheLastBit) {
  const Mesh mesh = curved_sphere(GetParam());
  write(mesh, path("a.vtu"));
  const auto grid = read(path("a.vtu"));
  EXPECT_TRUE(same_bits(values(grid->GetPoints()->GetData()), mesh.nodes));
  ASSERT_EQ(grid->GetNumberOfCells(), mesh.elements.rows());
  const int type = GetParam() == 1 ? 5 : GetParam() == 2 ? 22 : 69;
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    EXPECT_EQ(grid->GetCellType(e), type);
    vtkIdList* nodes = grid->GetCell(e)->GetPointIds();
    ASSERT_EQ(nodes->GetNumberOfIds(), mesh.elements.cols());
    for (int i = 0; i < mesh.elements.cols(); ++i) EXPECT_EQ(nodes->GetId(i), mesh.elements(e, i));
  }
  EXPECT_EQ(grid->GetPointData()->GetNumberOfArrays(), 2);
  for (const auto& [name, expected] : sample_fields(mesh))
    EXPECT_TRUE(same_bits(values(grid->GetPointData()->GetArray(name.c_str())), expected)) << name;
  EXPECT_THAT(files(), ElementsAre("a.vtu"));
}

TEST_P(WriteVtuDegree, CellsAreTheElementMaps) {
  const Mesh mesh = curved_sphere(GetParam());
  write(mesh, path("a.vtu"));
  EXPECT_LT(distance_of_maps(read(path("a.vtu")), mesh), 1e-12);
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

TEST_F(WriteVtu, TheCheckSeesAWrongNodeOrder) {
  // Two nodes of an edge, or two inner ones.
  const int swapped[][3] = {{2, 3, 4}, {3, 3, 4}, {3, 7, 8}, {4, 12, 13}, {4, 13, 14}};
  for (const auto& [degree, a, b] : swapped) {
    const Mesh mesh = curved_sphere(degree);
    Mesh wrong = mesh;
    wrong.elements.col(a).swap(wrong.elements.col(b));
    write(wrong, path("a.vtu"));
    EXPECT_GT(distance_of_maps(read(path("a.vtu")), mesh), 1e-2) << degree << ", " << a;
  }
}

TEST_F(WriteVtu, RefusesNamesThatXmlCannotHave) {
  const Mesh mesh = curved_sphere(1);
  const auto write_as = [&](const std::string& name) {
    write_vtu(1, mesh.elements, mesh.nodes, {{name, mesh.nodes.col(0)}}, path("a.vtu"));
  };
  for (const std::string name : {"a&b", "a<b", "a>b", "a\"b", "a\nb", ""})
    EXPECT_THAT(complaint<InputError>([&] { write_as(name); }),
                HasSubstr("a.vtu: field 1 (counted from 1) has a name"))
        << name;
  EXPECT_THAT(files(), ElementsAre());
  for (const std::string name : {"|A|²", "mean curvature", "'κ', 100%"}) {
    write_as(name);
    const auto grid = read(path("a.vtu"));
    ASSERT_EQ(grid->GetPointData()->GetNumberOfArrays(), 1);
    EXPECT_EQ(grid->GetPointData()->GetArrayName(0), name);
  }
}

TEST_F(WriteVtu, RefusesSizesThatDoNotFit) {
  const Mesh mesh = curved_sphere(2);
  const int n = int(mesh.nodes.rows());
  const auto refused = [&](int degree, const Connectivity& elements, const Field& x,
                           const std::vector<PointField>& fields) {
    return complaint<InputError>([&] { write_vtu(degree, elements, x, fields, path("a.vtu")); });
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
                  write_vtu(2, mesh.elements, mesh.nodes, {{"v", wrong}}, path("a.vtu"));
                }),
                AllOf(HasSubstr("a.vtu: field 'v' is "), HasSubstr("at node 5 ")));
    EXPECT_THAT(complaint<NumericsError>([&] { write_vtu(2, mesh.elements, wrong, {}, path("a.vtu")); }),
                AllOf(HasSubstr("a.vtu: x is "), HasSubstr("at node 5 ")));
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

TEST_F(WriteVtu, StartsNoThreadAndPrintsNothing) {
  // In a process of its own, where nothing else has started VTK's threads before.
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto threads = [] {
    return std::distance(fs::directory_iterator("/proc/self/task"), fs::directory_iterator());
  };
  const auto started = [&] {
    const auto before = threads();
    write(curved_sphere(2, 4), path("a.vtu"));
    return int(threads() - before);
  };
  EXPECT_EXIT(std::exit(started()), testing::ExitedWithCode(0), testing::Eq(""));
  const std::string backend = vtkSMPTools::GetBackend();
  const int most = vtkSMPTools::GetEstimatedNumberOfThreads();
  write(curved_sphere(2), path("a.vtu"));
  EXPECT_EQ(vtkSMPTools::GetBackend(), backend);
  EXPECT_EQ(vtkSMPTools::GetEstimatedNumberOfThreads(), most);
}

TEST_F(Snapshots, AreListedAfterEachStep) {
  const Mesh mesh = curved_sphere(3);
  const std::string pvd = path("new/folders/run.pvd");
  SnapshotCollection collection(pvd, 3, mesh.elements);
  EXPECT_TRUE(fs::is_directory(folder / "new/folders"));
  std::vector<std::pair<double, std::string>> expected;
  for (const double t : {0.0, 1e-17, 0.1, 0.1 + 0.2, 1.0 / 3}) {
    const Field x = (1 + t) * mesh.nodes;
    const std::string name = collection.add(t, x, {{"nu", mesh.nodes}});
    EXPECT_EQ(name, format("run_%04zu.vtu", expected.size()));
    expected.emplace_back(t, name);
    EXPECT_EQ(snapshots(pvd), expected);
    const auto grid = read((folder / "new/folders" / name).string());
    EXPECT_TRUE(same_bits(values(grid->GetPoints()->GetData()), x));
    EXPECT_TRUE(same_bits(values(grid->GetPointData()->GetArray("nu")), mesh.nodes));
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "new/folders"), fs::directory_iterator()), 6);
}

TEST_F(Snapshots, AFailedOneIsNotListed) {
  const Mesh mesh = curved_sphere(1);
  SnapshotCollection collection(path("run.pvd"), 1, mesh.elements);
  collection.add(0, mesh.nodes, {});
  Field wrong = mesh.nodes;
  wrong(0, 0) = NAN;
  EXPECT_THROW(collection.add(1, wrong, {}), NumericsError);
  EXPECT_THROW(collection.add(1, mesh.nodes, {{"u", wrong.topRows(3)}}), InputError);
  EXPECT_THROW(collection.add(NAN, mesh.nodes, {}), NumericsError);
  EXPECT_THAT(files(), ElementsAre("run.pvd", "run_0000.vtu"));
  EXPECT_THAT(snapshots(path("run.pvd")), ElementsAre(testing::Pair(0, "run_0000.vtu")));
  EXPECT_EQ(collection.add(2, mesh.nodes, {}), "run_0001.vtu");
  EXPECT_THAT(snapshots(path("run.pvd")),
              ElementsAre(testing::Pair(0, "run_0000.vtu"), testing::Pair(2, "run_0001.vtu")));
}

TEST_F(Snapshots, AnotherCollectionGoesOn) {
  const Mesh mesh = curved_sphere(1);
  const auto add = [&](SnapshotCollection& collection, double t) {
    return std::make_pair(t, collection.add(t, (1 + t) * mesh.nodes, {}));
  };
  SnapshotCollection whole(path("run.pvd"), 1, mesh.elements);
  std::vector<std::pair<double, std::string>> list;
  for (const double t : {0.0, 0.1, 1.0 / 3}) list.push_back(add(whole, t));
  const std::string expected = content(path("run.pvd"));

  fs::remove(path("run_0002.vtu"));
  SnapshotCollection resumed(path("run.pvd"), 1, mesh.elements);
  EXPECT_THAT(complaint<InputError>([&] { resumed.resume(list); }),
              AllOf(HasSubstr("run_0002.vtu"), HasSubstr("is missing")));
  resumed.resume({list[0], list[1]});
  EXPECT_THAT(snapshots(path("run.pvd")), ElementsAre(list[0], list[1]));
  EXPECT_EQ(add(resumed, 1.0 / 3), list[2]);
  EXPECT_EQ(content(path("run.pvd")), expected);
  EXPECT_THAT(files(), ElementsAre("run.pvd", "run_0000.vtu", "run_0001.vtu", "run_0002.vtu"));
}

TEST_F(Snapshots, NoneIsThereWhenItCannotBeListed) {
  const Mesh mesh = curved_sphere(1);
  SnapshotCollection collection(path("run.pvd"), 1, mesh.elements);
  fs::create_directory(path("run.pvd"));
  EXPECT_THAT(complaint<InputError>([&] { collection.add(0, mesh.nodes, {}); }),
              HasSubstr("run.pvd: cannot be written"));
  fs::remove(path("run.pvd"));
  EXPECT_EQ(collection.add(0, mesh.nodes, {}), "run_0000.vtu");
  EXPECT_EQ(snapshots(path("run.pvd")).size(), 1u);
}

TEST_F(Snapshots, NamesMayHaveAnyCharacters) {
  const Mesh mesh = curved_sphere(1);
  const std::string stem = "τ = 0.1 & \"<R>\"";
  SnapshotCollection collection(path(stem + ".pvd"), 1, mesh.elements);
  collection.add(0, mesh.nodes, {});
  EXPECT_THAT(snapshots(path(stem + ".pvd")), ElementsAre(testing::Pair(0, stem + "_0000.vtu")));
  EXPECT_THAT(files(), ElementsAre(stem + ".pvd", stem + "_0000.vtu"));
}

TEST_F(Snapshots, RefuseOtherNamesAndPlaces) {
  const Mesh mesh = curved_sphere(1);
  const auto refused = [&](const std::string& name) {
    return complaint<InputError>([&] { SnapshotCollection(name, 1, mesh.elements); });
  };
  for (const char* name : {"", "run", "run.vtu", "run.pvd.xml", "run.PVD", ".pvd", "pvd", "run.pvd/"})
    EXPECT_THAT(refused(name), AllOf(HasSubstr(format("'%s'", name)), HasSubstr("ends in .pvd"))) << name;
  std::ofstream(path("file")) << "no folder";
  EXPECT_THAT(refused(path("file/run.pvd")), AllOf(HasSubstr("file: "), HasSubstr("cannot be made")));
  EXPECT_THAT(files(), ElementsAre("file"));
}
