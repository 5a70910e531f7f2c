#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/systems/model/finite_elements/elastic_solids.hpp"

namespace torsion::engine {
namespace {

namespace fs = std::filesystem;

/// A cache folder of its own, gone afterwards.
class SmoothComplianceCacheTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = fs::temp_directory_path() / "torsion_compliance_XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    setenv("TORSION_CACHE_DIR", name.c_str(), 1);  // NOLINT(concurrency-mt-unsafe): one thread
  }
  void TearDown() override {
    unsetenv("TORSION_CACHE_DIR");  // NOLINT(concurrency-mt-unsafe): one thread
    fs::remove_all(folder_);
  }

  /// The matrix; counts in `built_` when it was solved for.
  Eigen::MatrixXd load_or_build(const Elasticity& elasticity, std::uint32_t elements = 8) {
    ElasticSolid solid = block_solid({1.0, 1.0, 1.0}, elasticity.poisson_ratio);
    solid.elasticity = elasticity;
    const std::array<std::byte, 2> identity{std::byte{1}, std::byte{7}};
    const std::vector<Port> ports{top_port(1.0), {{0.5, 0.0, 0.6}, {1.0, 0.0, 0.0}}};
    bool solved = false;
    const auto result =
        load_or_build_smooth_compliance(solid, identity, ports, {elements, 1, [&](double) {
                                                                   solved = true;
                                                                 }});
    EXPECT_TRUE(result.ok());
    built_ += solved ? 1 : 0;
    return result ? result.value().matrix : Eigen::MatrixXd();
  }

  fs::path folder_;
  int built_ = 0;
};

TEST_F(SmoothComplianceCacheTest, SecondTimeIsLoadedAndScaledToTheModulus) {
  const Eigen::MatrixXd first = load_or_build({1e6, 0.4, 1000.0});
  EXPECT_EQ(built_, 1);
  const Eigen::MatrixXd again = load_or_build({1e6, 0.4, 1000.0});
  const Eigen::MatrixXd stiffer = load_or_build({4e6, 0.4, 500.0});
  EXPECT_EQ(built_, 1);
  EXPECT_EQ(again, first);  // a cache must not change a run
  EXPECT_LT((4.0 * stiffer - first).norm(), 1e-15 * first.norm());
}

TEST_F(SmoothComplianceCacheTest, OtherRatiosAndResolutionsAreBuiltAnew) {
  load_or_build({1e6, 0.4, 1000.0});
  load_or_build({1e6, 0.3, 1000.0});
  load_or_build({1e6, 0.4, 1000.0}, 10);
  EXPECT_EQ(built_, 3);
}

TEST_F(SmoothComplianceCacheTest, AFileOfAnotherSizeIsBuiltAnew) {
  const Eigen::MatrixXd first = load_or_build({1e6, 0.4, 1000.0});
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_)) {
    if (entry.is_regular_file()) {
      fs::resize_file(entry.path(), fs::file_size(entry.path()) / 2);
    }
  }
  EXPECT_EQ(load_or_build({1e6, 0.4, 1000.0}), first);
  EXPECT_EQ(built_, 2);
}

}  // namespace
}  // namespace torsion::engine
