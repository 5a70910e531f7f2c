#include "app/output_file.hpp"

#include <array>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/app/program.hpp"
#include "tests/app/small_disk.hpp"

namespace torsion::engine {
namespace {

using test::Folder;
using test::read_text;
using test::write_text;

TEST(OutputFileTest, AppearsWholeWithItsFolders) {
  const Folder folder;
  const std::string path = folder / "a/b/file.txt";
  Result<OutputFile> file = OutputFile::create(path);
  ASSERT_TRUE(file.ok());
  file.value().write("first ");
  file.value().write("second");
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(file.value().commit().ok());
  EXPECT_EQ(read_text(path), "first second");
}

TEST(OutputFileTest, LeavesTheOldFileWhenItIsNotCommitted) {
  const Folder folder;
  const std::string path = folder / "file.txt";
  write_text(path, "old");
  {
    Result<OutputFile> file = OutputFile::create(path);
    ASSERT_TRUE(file.ok());
    file.value().write("new");
  }
  EXPECT_EQ(read_text(path), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(OutputFileTest, RefusesTheNameOfAFolder) {
  const Folder folder;
  const Result<OutputFile> file = OutputFile::create(folder.path());
  ASSERT_FALSE(file.ok());
  EXPECT_NE(file.error().text.find("it is a folder"), std::string::npos);
}

TEST(OutputFileTest, WritesToADeviceAndReplacesItNot) {
  const Folder folder;
  std::filesystem::create_symlink("/dev/null", folder / "null");
  for (const std::string& path : {std::string("/dev/null"), folder / "null"}) {
    Result<OutputFile> file = OutputFile::create(path);
    ASSERT_TRUE(file.ok()) << file.error().text;
    file.value().write("x");
    EXPECT_TRUE(file.value().commit().ok());
    EXPECT_TRUE(std::filesystem::is_character_file(path)) << path;
  }
  Result<OutputFile> full = OutputFile::create("/dev/full");
  ASSERT_TRUE(full.ok()) << full.error().text;
  full.value().write("x");
  EXPECT_FALSE(full.value().commit().ok());
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(OutputFileTest, WritesToAPipeIfSomebodyReadsIt) {
  const Folder folder;
  const std::string path = folder / "pipe";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const Result<OutputFile> unread = OutputFile::create(path);
  ASSERT_FALSE(unread.ok());
  EXPECT_NE(unread.error().text.find("nobody reads"), std::string::npos) << unread.error().text;
  const int reader = ::open(path.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  Result<OutputFile> file = OutputFile::create(path);
  ASSERT_TRUE(file.ok()) << file.error().text;
  file.value().write("through");
  EXPECT_TRUE(file.value().commit().ok());
  std::array<char, 16> read{};
  EXPECT_EQ(::read(reader, read.data(), read.size()), 7);
  ::close(reader);
  EXPECT_TRUE(std::filesystem::is_fifo(path));
}

TEST(OutputFileTest, ReplacesWhatALinkLeadsToAndNotTheLink) {
  const Folder folder;
  write_text(folder / "file.txt", "old");
  std::filesystem::create_symlink(folder / "file.txt", folder / "link");
  Result<OutputFile> file = OutputFile::create(folder / "link");
  ASSERT_TRUE(file.ok()) << file.error().text;
  file.value().write("new");
  EXPECT_TRUE(file.value().commit().ok());
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(read_text(folder / "file.txt"), "new");
}

TEST(OutputFileTest, RefusesAFolderBelowAFile) {
  const Folder folder;
  write_text(folder / "file", "x");
  const Result<OutputFile> file = OutputFile::create(folder / "file/below.txt");
  ASSERT_FALSE(file.ok());
  EXPECT_NE(file.error().text.find("cannot be written"), std::string::npos);
}

TEST(OutputFileTest, OneWithoutANameIsCopiedAndGoesOn) {
  const Folder folder;
  Result<OutputFile> unnamed = OutputFile::create_unnamed();
  ASSERT_TRUE(unnamed) << unnamed.error().text;
  std::string all;
  for (int part = 0; part < 3; ++part) {
    const std::string bytes(700'000, static_cast<char>('a' + part));
    all += bytes;
    unnamed.value().write(bytes);
    Result<OutputFile> copy = OutputFile::create(folder / "copy");
    ASSERT_TRUE(copy);
    ASSERT_TRUE(unnamed.value().copy_to(copy.value()));
    ASSERT_TRUE(copy.value().commit());
    EXPECT_TRUE(read_text(folder / "copy") == all) << part;
  }
}

TEST(OutputFileTest, TwoForTheSamePlaceDoNotMix) {
  const Folder folder;
  const std::string path = folder / "file.txt";
  Result<OutputFile> first = OutputFile::create(path);
  Result<OutputFile> second = OutputFile::create(path);
  ASSERT_TRUE(first && second);
  first.value().write("first");
  second.value().write("second");
  ASSERT_TRUE(first.value().commit());
  EXPECT_EQ(read_text(path), "first");
  ASSERT_TRUE(second.value().commit());
  EXPECT_EQ(read_text(path), "second");
}

TEST(OutputFileTest, OfSeveralAllAppearOrNone) {
  const Folder folder;
  for (const bool fits : {false, true}) {
    std::vector<OutputFile> files;
    for (const char* name : {"first", "second"}) {
      Result<OutputFile> file = OutputFile::create(folder / name);
      ASSERT_TRUE(file) << file.error().text;
      files.push_back(std::move(file).value());
    }
    files[0].write("short");
    // Less than a buffer: only its end shows that there is no room.
    files[1].write(std::string(3000, 'x'));
    const Result<Done> done = [&] {
      const test::SmallDisk small(fits ? 4000 : 2000);  // bytes
      return OutputFile::commit_all(files);
    }();
    EXPECT_EQ(done.ok(), fits);
    EXPECT_EQ(std::filesystem::exists(folder / "first"), fits);
    EXPECT_EQ(std::filesystem::exists(folder / "second"), fits);
    if (!fits) {
      EXPECT_NE(done.error().text.find("second: cannot be written"), std::string::npos)
          << done.error().text;
    }
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
}

}  // namespace
}  // namespace torsion::engine
