// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "solver/error.hpp"
#include "solver/mesh/snapshot_collection.hpp"
#include "tests/mesh/test_folder.hpp"

using namespace esfem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

namespace {

std::string unescaped(std::string text) {
  const std::pair<const char*, const char*> entities[] = {
      {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&amp;", "&"}};
  for (const auto& [entity, character] : entities)
    text = std::regex_replace(text, std::regex(entity), character);
  return text;
}

/// Time and file of each snapshot of a collection.
std::vector<std::pair<double, std::string>> snapshots(const std::string& pvd) {
  static const std::regex element(R"re(<DataSet timestep="([^"]*)" part="0" file="([^"]*)"/>)re");
  const std::string text = content(pvd);
  std::vector<std::pair<double, std::string>> found;
  for (std::sregex_iterator match(text.begin(), text.end(), element), end; match != end; ++match)
    found.emplace_back(std::stod((*match)[1]), unescaped((*match)[2]));
  return found;
}

class Snapshots : public Folder {
 protected:
  /// A run of so many steps, each of them a snapshot.
  void run(int steps) const {
    SnapshotCollection collection(path("run.pvd"), 1, mesh.elements);
    for (int n = 0; n < steps; ++n) collection.add(n, n, mesh.nodes, {});
  }
  const Mesh mesh = curved_sphere(1);
};

}  // namespace

TEST_F(Snapshots, TheListIsXml) {
  run(2);
  EXPECT_EQ(content(path("run.pvd")), R"(<?xml version="1.0"?>
<VTKFile type="Collection" version="0.1">
  <Collection>
    <DataSet timestep="0" part="0" file="run_0000.vtu"/>
    <DataSet timestep="1" part="0" file="run_0001.vtu"/>
  </Collection>
</VTKFile>
)");
}

TEST_F(Snapshots, AreListedAfterEachStep) {
  const Mesh mesh = curved_sphere(3);
  const std::string pvd = path("new/folders/run.pvd");
  const RunLabel label = {"bgn", "{}"};
  SnapshotCollection collection(pvd, 3, mesh.elements, label);
  EXPECT_TRUE(fs::is_directory(folder / "new/folders"));
  std::vector<std::pair<double, std::string>> expected;
  for (const double t : {0.0, 1e-17, 0.1, 0.1 + 0.2, 1.0 / 3}) {
    const Field x = (1 + t) * mesh.nodes;
    const int n = 10 * int(expected.size());
    const std::string name = collection.add(n, t, x, {{"nu", mesh.nodes}});
    EXPECT_EQ(name, format("run_%04zu.vtu", expected.size()));
    expected.emplace_back(t, name);
    EXPECT_EQ(snapshots(pvd), expected);
    write_vtu(3, mesh.elements, x, {{"nu", mesh.nodes}}, {n, t, label}, path("single.vtu"));
    EXPECT_EQ(content((folder / "new/folders" / name).string()), content(path("single.vtu")));
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "new/folders"), fs::directory_iterator()), 6);
}

TEST_F(Snapshots, AFailedOneIsNotListed) {
  SnapshotCollection collection(path("run.pvd"), 1, mesh.elements);
  collection.add(0, 0, mesh.nodes, {});
  Field wrong = mesh.nodes;
  wrong(0, 0) = NAN;
  EXPECT_THROW(collection.add(1, 1, wrong, {}), NumericsError);
  EXPECT_THROW(collection.add(1, 1, mesh.nodes, {{"u", wrong.topRows(3)}}), InputError);
  EXPECT_THROW(collection.add(0, NAN, mesh.nodes, {}), NumericsError);
  EXPECT_THAT(files(), ElementsAre("run.pvd", "run_0000.vtu"));
  EXPECT_THAT(snapshots(path("run.pvd")), ElementsAre(testing::Pair(0, "run_0000.vtu")));
  EXPECT_EQ(collection.add(2, 2, mesh.nodes, {}), "run_0001.vtu");
  EXPECT_THAT(snapshots(path("run.pvd")),
              ElementsAre(testing::Pair(0, "run_0000.vtu"), testing::Pair(2, "run_0001.vtu")));
}

TEST_F(Snapshots, AnotherCollectionGoesOn) {
  const auto add = [&](SnapshotCollection& collection, double t) {
    return std::make_pair(t, collection.add(0, t, (1 + t) * mesh.nodes, {}));
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
  SnapshotCollection collection(path("run.pvd"), 1, mesh.elements);
  fs::create_directory(path("run.pvd"));
  EXPECT_THAT(complaint<InputError>([&] { collection.add(0, 0, mesh.nodes, {}); }),
              HasSubstr("run.pvd: cannot be written"));
  fs::remove(path("run.pvd"));
  EXPECT_EQ(collection.add(0, 0, mesh.nodes, {}), "run_0000.vtu");
  EXPECT_EQ(snapshots(path("run.pvd")).size(), 1u);
}

TEST_F(Snapshots, NamesMayHaveAnyCharacters) {
  const std::string stem = "τ = 0.1 & \"<R>\"";
  SnapshotCollection collection(path(stem + ".pvd"), 1, mesh.elements);
  collection.add(0, 0, mesh.nodes, {});
  EXPECT_THAT(snapshots(path(stem + ".pvd")), ElementsAre(testing::Pair(0, stem + "_0000.vtu")));
  EXPECT_THAT(files(), ElementsAre(stem + ".pvd", stem + "_0000.vtu"));
}

TEST_F(Snapshots, RefuseOtherNamesAndPlaces) {
  const auto refused = [&](const std::string& name) {
    return complaint<InputError>([&] { SnapshotCollection(name, 1, mesh.elements); });
  };
  for (const char* name : {"", "run", "run.vtu", "run.pvd.xml", "run.PVD", ".pvd", "pvd", "run.pvd/"})
    EXPECT_THAT(refused(name), AllOf(HasSubstr(format("'%s'", name)), HasSubstr("ends in .pvd"))) << name;
  std::ofstream(path("file")) << "no folder";
  EXPECT_THAT(refused(path("file/run.pvd")), AllOf(HasSubstr("file: "), HasSubstr("cannot be made")));
  EXPECT_THAT(refused(path("a\nb.pvd")), AllOf(HasSubstr("a?b.pvd': "), HasSubstr("visible characters")));
  EXPECT_THAT(files(), ElementsAre("file"));
}

TEST_F(Snapshots, ThoseOfALongerRunGoWithTheFirstOfTheNext) {
  run(3);
  const std::vector<std::string> strangers = {"other_0001.vtu",   "run_01.vtu",        "run_0001.vtk",
                                              "run_00012.vtu",    "run_000a.vtu",      "run_.vtu",
                                              "run_0001.vtu.bak", "run_0001_0001.vtu", "my_run_0001.vtu"};
  for (const std::string& name : strangers) std::ofstream(path(name)) << "somebody's";
  std::ofstream(path("run_0123.vtu")) << "of a run before";
  std::ofstream(path("run_12345.vtu")) << "of a long run before";
  fs::create_directory(path("run_0004.vtu"));
  fs::create_symlink(path("other_0001.vtu"), path("run_0005.vtu"));
  const std::vector<std::string> before = files();
  const std::string list = content(path("run.pvd"));

  SnapshotCollection next(path("run.pvd"), 1, mesh.elements);
  Field wrong = mesh.nodes;
  wrong(0, 0) = NAN;
  EXPECT_THROW(next.add(0, 0, wrong, {}), NumericsError);
  EXPECT_EQ(files(), before) << "a run without a snapshot costs nothing";
  EXPECT_EQ(content(path("run.pvd")), list);

  next.add(0, 0.5, mesh.nodes, {});
  std::vector<std::string> expected = strangers;
  for (const char* name : {"run.pvd", "run_0000.vtu", "run_0004.vtu", "run_0005.vtu"})
    expected.push_back(name);
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(files(), expected);
  EXPECT_THAT(snapshots(path("run.pvd")), ElementsAre(testing::Pair(0.5, "run_0000.vtu")));
  std::ofstream(path("run_0002.vtu")) << "written meanwhile";
  next.add(1, 1, mesh.nodes, {});
  EXPECT_TRUE(fs::exists(path("run_0002.vtu"))) << "the folder is cleared once";
}

TEST_F(Snapshots, AResumedRunKeepsItsOwnAndNoLaterOnes) {
  run(5);
  SnapshotCollection resumed(path("run.pvd"), 1, mesh.elements);
  resumed.resume({{0, "run_0000.vtu"}, {1, "run_0001.vtu"}});
  EXPECT_EQ(files().size(), 6u) << "nothing is lost before its first snapshot";
  resumed.add(2, 2, mesh.nodes, {});
  EXPECT_THAT(files(), ElementsAre("run.pvd", "run_0000.vtu", "run_0001.vtu", "run_0002.vtu"));
}

TEST_F(Snapshots, InTheWorkingFolder) {
  const fs::path before = fs::current_path();
  fs::current_path(folder);
  std::ofstream("run_0003.vtu") << "of a run before";
  SnapshotCollection("run.pvd", 1, mesh.elements).add(0, 0, mesh.nodes, {});
  fs::current_path(before);
  EXPECT_THAT(files(), ElementsAre("run.pvd", "run_0000.vtu"));
}
