#include "app/output_file.hpp"

#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <unistd.h>

namespace torsion {
namespace {

class OutputFileTest : public testing::Test {
 protected:
  OutputFileTest()
      : folder_(std::filesystem::temp_directory_path() /
                ("torsion_output_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~OutputFileTest() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string text(const std::filesystem::path& path) const {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  std::filesystem::path folder_;
};

TEST_F(OutputFileTest, AppearsWholeWithItsFolders) {
  const std::filesystem::path path = folder_ / "a" / "b" / "file.txt";
  Result<OutputFile> file = OutputFile::create(path);
  ASSERT_TRUE(file.ok());
  file.value().write("first ");
  file.value().write("second");
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(file.value().commit().ok());
  EXPECT_EQ(text(path), "first second");
}

TEST_F(OutputFileTest, LeavesTheOldFileWhenItIsNotCommitted) {
  const std::filesystem::path path = folder_ / "file.txt";
  std::ofstream(path) << "old";
  {
    Result<OutputFile> file = OutputFile::create(path);
    ASSERT_TRUE(file.ok());
    file.value().write("new");
  }
  EXPECT_EQ(text(path), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(OutputFileTest, RefusesTheNameOfAFolder) {
  const Result<OutputFile> folder = OutputFile::create(folder_);
  ASSERT_FALSE(folder.ok());
  EXPECT_NE(folder.error().text.find("it is a folder"), std::string::npos);
}

TEST_F(OutputFileTest, RefusesAFolderBelowAFile) {
  std::ofstream(folder_ / "file") << "x";
  const Result<OutputFile> file = OutputFile::create(folder_ / "file" / "below.txt");
  ASSERT_FALSE(file.ok());
  EXPECT_NE(file.error().text.find("cannot be written"), std::string::npos);
}

}  // namespace
}  // namespace torsion
