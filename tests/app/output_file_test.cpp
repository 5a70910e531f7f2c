#include "app/output_file.hpp"

#include <gtest/gtest.h>

#include "tests/app/program.hpp"
#include "tests/app/small_disk.hpp"

namespace torsion {
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
}  // namespace torsion
