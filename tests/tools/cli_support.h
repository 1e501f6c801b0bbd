// SPDX-License-Identifier: Apache-2.0
// Runs the built program `slf` in a directory of its own. SLF_PROGRAM is the path of the program.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace slf {

struct Ran {
  int code = -1;  ///< exit code; 128 + signal where a signal ended it
  std::string out, err;
};

class CliTest : public testing::Test {
 protected:
  void SetUp() override {
    directory_ =
        std::filesystem::temp_directory_path() / ("slf_cli_test_" + std::to_string(getpid()));
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directories(directory_);
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  std::filesystem::path path(const std::string& name) const { return directory_ / name; }

  /// `before` comes first on the command line of the shell (e.g. "ulimit -f 1;").
  Ran slf(const std::string& arguments, const std::string& before = "") const {
    return shell(before + " '" SLF_PROGRAM "' " + arguments);
  }

  /// A command of the shell, within the directory.
  Ran shell(const std::string& command) const {
    const std::string whole =
        "cd '" + directory_.string() + "' && { " + command + "; } >.out 2>.err </dev/null";
    const int status = std::system(whole.c_str());
    Ran ran{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read(".out"),
            read(".err")};
    return ran;
  }

  std::string read(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(path(name), std::ios::binary) << content;
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(path(name)); }

  nlohmann::json parsed(const std::string& text) const {
    auto value = nlohmann::json::parse(text, nullptr, false);
    EXPECT_FALSE(value.is_discarded()) << text;
    return value;
  }

  /// Names in the directory (and below) that look like a temporary file.
  std::vector<std::string> leftovers() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(directory_))
      if (entry.path().filename().string().find(".tmp") != std::string::npos)
        names.push_back(entry.path().string());
    return names;
  }

  /// One line on standard error that names `file` and `cause`, nothing on standard output.
  static void expect_failure(const Ran& ran, int code, const std::string& file,
                             const std::string& cause) {
    EXPECT_EQ(ran.code, code) << ran.err;
    EXPECT_EQ(ran.out, "");
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    EXPECT_EQ(ran.err.rfind("slf: ", 0), 0u) << ran.err;
    EXPECT_NE(ran.err.find(file), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find(cause), std::string::npos) << ran.err;
  }

 private:
  std::filesystem::path directory_;
};

/// A directory `tiny` with a synthetic capture: 100 images of 48 x 48, 20 of them dense, some 1500
/// points.
class TinyCaptureTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    const Ran ran =
        slf("synth can -o tiny --size 48x48 --points 1500 --circles 5 --per-circle 20 "
            "--supersampling 1");
    ASSERT_EQ(ran.code, 0) << ran.err;
  }
};

}  // namespace slf
