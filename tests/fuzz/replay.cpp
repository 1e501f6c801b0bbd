// SPDX-License-Identifier: Apache-2.0
// Runs a target on files, or all files of directories, without libFuzzer: seeds and finds in the
// normal build. With --accepts-some first, fails where the target refuses every one of them: seeds
// of an older format try nothing but a refusal.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "tests/fuzz/fuzz.h"

namespace {

namespace fs = std::filesystem;

int run(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<char> text((std::istreambuf_iterator<char>(in)), {});
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  return LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<fs::path> files;
  const bool some = argc > 1 && std::string(argv[1]) == "--accepts-some";
  for (int i = some ? 2 : 1; i < argc; ++i) {
    if (!fs::is_directory(argv[i])) {
      files.emplace_back(argv[i]);
      continue;
    }
    for (const auto& entry : fs::directory_iterator(argv[i])) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    std::printf("%s\n", file.c_str());
    std::fflush(stdout);
    if (run(file) != 0) return 1;
  }
  std::printf("%zu inputs, accepted %zu times\n", files.size(), slf::fuzz::accepted_inputs);
  return files.empty() || (some && slf::fuzz::accepted_inputs == 0) ? 1 : 0;
}
