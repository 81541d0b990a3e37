// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "solver/mesh/mesh.hpp"

namespace esfem {

/// A sphere with curved elements, nodes with numbers that need all digits.
inline Mesh curved_sphere(int degree, int subdivisions = 1) {
  Mesh mesh = lagrange_mesh(icosphere(1.0 / 3, subdivisions), degree);
  mesh.nodes.rowwise().normalize();
  return mesh;
}

inline std::string content(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// The error message of an action, in one line.
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

/// An empty folder for each test.
class Folder : public testing::Test {
 protected:
  Folder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + "_" + test->name();
    std::replace(name.begin(), name.end(), '/', '_');
    folder = std::filesystem::path(ESFEM_BINARY_DIR) / "test_vtu" / name;
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
  }
  std::string path(const std::string& name) const { return (folder / name).string(); }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }
  std::filesystem::path folder;
};

}  // namespace esfem
