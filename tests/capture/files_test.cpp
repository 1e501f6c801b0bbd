// SPDX-License-Identifier: Apache-2.0
// Files that appear whole or not at all.
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <array>
#include <csignal>
#include <fstream>
#include <span>
#include <thread>

#include "capture_support.h"

namespace slf::files_test {
namespace {

using test::TemporaryDirectory;
using ::testing::HasSubstr;

TEST(WriteFile, ReplacesTheOldFileAndKeepsItsMode) {
  const TemporaryDirectory directory;
  test::write_text(directory / "a", "old, and longer");
  ASSERT_EQ(::chmod((directory / "a").c_str(), 0640), 0);
  ASSERT_TRUE(write_file(directory / "a", "new", 3));
  EXPECT_EQ(test::read_text(directory / "a"), "new");
  struct stat status {};
  ASSERT_EQ(::stat((directory / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
  EXPECT_EQ(directory.num_entries(), 1u);
}

TEST(WriteFile, WritesPiecesOneAfterTheOther) {
  const TemporaryDirectory directory;
  const std::string head = "head ", body = "body";
  const std::array pieces = {std::as_bytes(std::span(head)), std::span<const std::byte>(),
                             std::as_bytes(std::span(body))};
  ASSERT_TRUE(write_file(directory / "a", pieces));
  EXPECT_EQ(test::read_text(directory / "a"), "head body");
}

TEST(WriteFile, FailsOnAFullDiskNamingFileAndCause) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const auto written = write_file("/dev/full", "x", 1);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::kUnwritable);
  EXPECT_EQ(written.error().message, "/dev/full: cannot be written: No space left on device");
}

TEST(WriteFile, FailsWithoutTheDirectoryAndOnADirectory) {
  const TemporaryDirectory directory;
  const auto missing = write_file(directory / "none/a", "x", 1);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Errc::kUnwritable);
  EXPECT_THAT(missing.error().message, HasSubstr("none/a: cannot be written: No such file"));
  const auto onto = write_file(directory.path(), "x", 1);
  ASSERT_FALSE(onto);
  EXPECT_THAT(onto.error().message, HasSubstr("Is a directory"));
  EXPECT_EQ(directory.num_entries(), 0u);
}

// A file size limit stands in for a full disk: the write fails half way.
TEST(WriteFile, AFailedWriteLeavesTheOldFileAndNoOther) {
  const TemporaryDirectory directory;
  test::write_text(directory / "a", "old");
  const std::string much(1 << 20, 'x');
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{4096, before.rlim_max};
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto written = write_file(directory / "a", much.data(), much.size());
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  ::signal(SIGXFSZ, handler);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::kUnwritable);
  EXPECT_THAT(written.error().message, HasSubstr("/a: cannot be written: File too large"));
  EXPECT_EQ(test::read_text(directory / "a"), "old");
  EXPECT_EQ(directory.num_entries(), 1u);
}

TEST(WriteFile, GoesThroughSymbolicLinks) {
  const TemporaryDirectory directory;
  test::write_text(directory / "real/a", "old");
  std::filesystem::create_symlink(directory / "real/a", directory / "link");
  ASSERT_TRUE(write_file(directory / "link", "new", 3));
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "link"));
  EXPECT_EQ(test::read_text(directory / "real/a"), "new");
}

TEST(WriteFile, GoesThroughSymbolicLinksThatLeadToNothingYet) {
  const TemporaryDirectory directory;
  std::filesystem::create_symlink("real", directory / "link");
  ASSERT_TRUE(write_file(directory / "link", "new", 3));
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "link"));
  EXPECT_EQ(test::read_text(directory / "real"), "new");
}

TEST(WriteFile, LinksThatLeadToEachOtherStay) {
  const TemporaryDirectory directory;
  std::filesystem::create_symlink("b", directory / "a");
  std::filesystem::create_symlink("a", directory / "b");
  EXPECT_FALSE(write_file(directory / "a", "new", 3));
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "a"));
  EXPECT_EQ(directory.num_entries(), 2u);
}

TEST(WriteFile, WritesIntoDevicesAndPipesThemselves) {
  EXPECT_TRUE(write_file("/dev/null", "x", 1));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  const TemporaryDirectory directory;
  ASSERT_EQ(::mkfifo((directory / "pipe").c_str(), 0600), 0);
  std::thread writer([&] { EXPECT_TRUE(write_file(directory / "pipe", "through", 7)); });
  // Not by read_file, which refuses pipes: the writer would wait for ever.
  std::ifstream reader(directory / "pipe");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(reader), {}), "through");
  writer.join();
  EXPECT_TRUE(std::filesystem::is_fifo(directory / "pipe"));
}

TEST(ReadFile, RefusesMoreThanTheLimitAndDirectories) {
  const TemporaryDirectory directory;
  test::write_text(directory / "a", "12345");
  EXPECT_TRUE(read_file(directory / "a", 5));
  const auto large = read_file(directory / "a", 4);
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, Errc::kLimitExceeded);
  const auto folder = read_file(directory.path());
  ASSERT_FALSE(folder);
  EXPECT_EQ(folder.error().code, Errc::kUnreadable);
}

}  // namespace
}  // namespace slf::files_test
