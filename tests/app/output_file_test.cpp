#include "app/output_file.hpp"

#include <gtest/gtest.h>

#include "tests/app/program.hpp"

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

}  // namespace
}  // namespace torsion
