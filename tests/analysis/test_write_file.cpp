// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "solver/error.hpp"
#include "solver/write_file.hpp"

namespace esfem::test_write_file {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

struct WriteFile : testing::Test {
  const fs::path folder = fs::path(testing::TempDir()) / ("esfem_write_" + std::to_string(getpid()));

  WriteFile() { fs::create_directories(folder); }
  ~WriteFile() override { fs::remove_all(folder); }

  std::string path(const std::string& name) const { return (folder / name).string(); }
  std::string content(const std::string& name) const {
    std::ifstream stream(path(name));
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::ptrdiff_t count() const { return std::distance(fs::directory_iterator(folder), {}); }
  std::string refusal(const std::string& file) const {
    try {
      prepare_output(file);
      return "no error";
    } catch (const InputError& error) {
      return error.what();
    }
  }
};

TEST_F(WriteFile, AFailureLeavesWhatWasThere) {
  ASSERT_TRUE(fs::is_character_file("/dev/full")) << "Linux has one";
  EXPECT_THROW(write_file("/dev/full", "text"), InputError);
  EXPECT_THROW(write_file("/dev/full", std::string(1 << 20, 'x')), InputError);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(WriteFile, ALinkStaysOne) {
  write_file(path("target"), "old");
  fs::create_symlink("target", path("link"));
  prepare_output(path("link"));
  write_file(path("link"), "new");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(content("target"), "new");
  EXPECT_EQ(count(), 2);
}

TEST_F(WriteFile, IsPreparedWithItsFolders) {
  prepare_output(path("a/b/c.json"));
  EXPECT_TRUE(fs::is_directory(path("a/b")));
  EXPECT_TRUE(fs::is_empty(path("a/b")));
  write_file(path("old"), "old");
  prepare_output(path("old"));
  EXPECT_EQ(content("old"), "old");
  prepare_output("-");
  prepare_output("/dev/null");
}

TEST_F(WriteFile, WhatCannotBeWrittenIsRefused) {
  fs::create_directory(path("folder"));
  write_file(path("file"), "");
  EXPECT_THAT(refusal(path("folder")), HasSubstr("folder: cannot be written: it is a folder"));
  EXPECT_THAT(refusal(path("folder/")), HasSubstr("it is a folder"));
  EXPECT_THAT(refusal(path("file/a.json")), HasSubstr("file: this folder cannot be made"));
  EXPECT_THAT(refusal(""), HasSubstr("not the name of a file"));
  EXPECT_THAT(refusal(std::string("a\0b", 3)), HasSubstr("not the name of a file"));
  EXPECT_THAT(refusal(path(std::string(300, 'x'))), HasSubstr("File name too long"));
  EXPECT_THAT(refusal("/proc/a.json"), HasSubstr("/proc/a.json: cannot be written"));
  EXPECT_EQ(count(), 2);
}

TEST_F(WriteFile, WhatAKilledProcessHasLeftIsRemoved) {
  const pid_t process = fork();
  if (process == 0) _exit(0);
  waitpid(process, nullptr, 0);
  const auto temporary = [&](const std::string& name, pid_t of) {
    return path(format(".%s.%d.tmp", name.c_str(), of));
  };
  for (const std::string& file : {temporary("a.json", process), temporary("b.json", process),
                                  temporary("a.json", getppid()), path(".a.json.tmp"), path("a.json")})
    std::ofstream(file) << "half";
  prepare_output(path("a.json"));
  EXPECT_FALSE(fs::exists(temporary("a.json", process)));
  EXPECT_EQ(count(), 4) << "those of other files and running processes stay";
}

}  // namespace
}  // namespace esfem::test_write_file
