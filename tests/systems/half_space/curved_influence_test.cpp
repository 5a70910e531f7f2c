// What curvature adds to a half-space's response: the closed form against the same way gone in
// numbers, and against the exact twists of a sphere.

#include "systems/half_space/curved_influence.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/half_space/layer.hpp"

namespace torsion::engine {
namespace {

using std::numbers::pi;

using Complex = std::complex<double>;

constexpr int kHighest = 9;   // wave of the angle; with one more on the way the results end at 4
constexpr int kSamples = 32;  // of a turn: more than twice as many

/// Coefficients of exp(i m angle), m from -kHighest to kHighest.
struct Waves {
  std::array<Complex, 2 * kHighest + 1> each{};

  [[nodiscard]] Complex at(int m) const {
    return std::abs(m) <= kHighest ? each[static_cast<std::size_t>(m + kHighest)] : Complex(0.0);
  }
};

template <class Coefficient>
Waves make_waves(const Coefficient& coefficient) {
  Waves waves;
  for (int m = -kHighest; m <= kHighest; ++m) {
    waves.each[static_cast<std::size_t>(m + kHighest)] = coefficient(m);
  }
  return waves;
}

template <class Function>
Waves sampled(const Function& function) {
  return make_waves([&](int m) {
    Complex sum(0.0);
    for (int sample = 0; sample < kSamples; ++sample) {
      const double angle = 2.0 * pi * sample / kSamples;
      sum += function(angle) / kSamples * std::polar(1.0, -m * angle);
    }
    return sum;
  });
}

Complex times_cosine(const Waves& waves, int m) {
  return 0.5 * (waves.at(m - 1) + waves.at(m + 1));
}
Complex times_sine(const Waves& waves, int m) {
  return Complex(0.0, -0.5) * (waves.at(m - 1) - waves.at(m + 1));
}

/// (-i)^|m|: a wave m of the angle over r is 2 pi (-i)^|m| the same wave over k in Fourier's space.
Complex quarter_turns(int m) {
  return std::pow(Complex(0.0, -1.0), std::abs(m));
}

double below(const SurfaceCurvature& curvature, double angle) {  // the surface, over r^2
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return 0.5 * (curvature.xx * c * c + 2.0 * curvature.xy * c * s + curvature.yy * s * s);
}

/// Stresses along the surface by a unit force along an axis, times r^2: xx, xy, yy. Johnson,
/// Contact Mechanics, 1985, (3.19) and (3.75) at z = 0.
std::array<double, 3> surface_stress(int axis, double nu, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const double n = 1.0 - 2.0 * nu;
  const double unit = 0.5 / pi;
  if (axis == 0) {
    return {unit * (-3.0 * c * c * c + n * (3.0 * c * c * c - 2.0 * c)),
            unit * (-3.0 * c * c * s + n * (3.0 * c * c * s - s)),
            unit * (-3.0 * c * s * s + n * 3.0 * c * s * s)};
  }
  if (axis == 1) {
    return {unit * (-3.0 * s * c * c + n * 3.0 * s * c * c),
            unit * (-3.0 * s * s * c + n * (3.0 * s * s * c - c)),
            unit * (-3.0 * s * s * s + n * (3.0 * s * s * s - 2.0 * s))};
  }
  return {unit * n * (c * c - s * s), unit * n * 2.0 * s * c, unit * n * (s * s - c * c)};
}

/// By a unit force along an axis: what taking off the tractions moves along x, y and z, waves over
/// k^2 in Fourier's space. Shear modulus 1.
std::array<Waves, 3> taken_off(int axis, const SurfaceCurvature& curvature, double nu) {
  std::array<Waves, 3> slope;  // of h times the stresses, along the angle
  for (std::size_t part = 0; part < 3; ++part) {
    const Waves waves = sampled([&](double angle) {
      return below(curvature, angle) * surface_stress(axis, nu, angle)[part];
    });
    slope[part] = make_waves([&](int m) { return Complex(0.0, m) * waves.at(m); });
  }
  // -d/dx = sin d/dangle / r and -d/dy = -cos d/dangle / r of what does not depend on r.
  const auto traction = [](const Waves& by_x, const Waves& by_y) {
    return make_waves([&](int m) {
      return 2.0 * pi * quarter_turns(m) * (times_sine(by_x, m) - times_cosine(by_y, m));
    });
  };
  const Waves x = traction(slope[0], slope[1]);
  const Waves y = traction(slope[1], slope[2]);
  // The half-space deflects by (1 - nu) / k along the wave, 1 / k across it, and sinks by
  // -i (1 - 2 nu) / (2 k) times what is along it.
  const Waves along = make_waves([&](int m) { return times_cosine(x, m) + times_sine(y, m); });
  return {make_waves([&](int m) { return x.at(m) - nu * times_cosine(along, m); }),
          make_waves([&](int m) { return y.at(m) - nu * times_sine(along, m); }),
          make_waves([&](int m) { return Complex(0.0, nu - 0.5) * along.at(m); })};
}

/// Back from Fourier's space, at a distance and angle: exp(i m angle) / k^2 is i^|m| exp(i m angle)
/// / (2 pi |m|), for m = 0 -ln r / (2 pi).
double back(const Waves& waves, double distance, double angle) {
  Complex sum = -waves.at(0) * std::log(distance) / (2.0 * pi);
  for (int m = 1; m <= kHighest; ++m) {
    sum += std::conj(quarter_turns(m)) / (2.0 * pi * m) *
           (waves.at(m) * std::polar(1.0, m * angle) + waves.at(-m) * std::polar(1.0, -m * angle));
  }
  return sum.real();
}

/// What a unit force along x or y moves along x or y by, in numbers: with h times the slope down of
/// the half-space's own displacement, which is minus the slope along the surface of its depression
/// (1 - 2 nu) x / (4 pi r^2).
double sideways(int force, int motion, const SurfaceCurvature& curvature, double nu,
                double distance, double angle) {
  const double c2 = std::cos(2.0 * angle);
  const double wave = force != motion ? std::sin(2.0 * angle) : (force == 0 ? c2 : -c2);
  return back(taken_off(force, curvature, nu)[static_cast<std::size_t>(motion)], distance, angle) +
         (1.0 - 2.0 * nu) / (4.0 * pi) * below(curvature, angle) * wave;
}

TEST(CurvedInfluenceTest, ClosedFormIsThePerturbationOfTheBoundary) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const double nu : {0.0, 0.2, 0.3, 0.45, 0.5}) {
    const SurfaceCurvature curvature{uniform(random), uniform(random), uniform(random)};
    const CurvedResponse response = curved_response(curvature, nu);
    for (int place = 0; place < 8; ++place) {
      const double distance = std::exp(uniform(random));
      const double angle = pi * uniform(random);
      const glm::dvec2 offset(distance * std::cos(angle), distance * std::sin(angle));
      const auto found = [&](std::size_t kind) {
        return curved_displacement(response[kind], offset, 1.0) / (8.0 * pi);
      };
      EXPECT_NEAR(found(0), back(taken_off(2, curvature, nu)[2], distance, angle), 1e-14) << nu;
      EXPECT_NEAR(found(1), sideways(0, 0, curvature, nu, distance, angle), 1e-14) << nu;
      EXPECT_NEAR(found(3), sideways(1, 1, curvature, nu, distance, angle), 1e-14) << nu;
      // By x on y and by y on x differ where nu < 0.5, for a force's axes are those of the surface
      // under it; a table of reciprocal displacements has their mean.
      EXPECT_NEAR(found(2),
                  0.5 * (sideways(0, 1, curvature, nu, distance, angle) +
                         sideways(1, 0, curvature, nu, distance, angle)),
                  1e-14)
          << nu;
    }
  }
}

TEST(CurvedInfluenceTest, ASphereTwistsAsItsModes) {
  // A sphere's toroidal modes deflect by R / (G (n - 1)), whatever nu (Love, Theory of Elasticity,
  // 1927, 182). With k = (n + 1/2) / R that is 1 / (G k), the half-space's, and 3 / (2 G R k^2).
  // A ring that is sheared around sees motion across the wave alone: of a force on it along the
  // angle, it goes round by 3 / (2 R) times the integral of J1(k)^2 / k dk / (2 pi), 1 / (4 pi).
  const double radius = 2.0;
  for (const double nu : {0.2, 0.5}) {
    const CurvedResponse response = curved_response({1.0 / radius, 0.0, 1.0 / radius}, nu);
    constexpr int kPlaces = 20000;
    double mean = 0.0;
    for (int place = 0; place < kPlaces; ++place) {
      const double angle = 2.0 * pi * (place + 0.5) / kPlaces;
      const glm::dvec2 at(std::cos(angle), std::sin(angle));
      const glm::dvec2 offset = at - glm::dvec2(1.0, 0.0);
      // The force is along y, the ring's motion along (-sin, cos): not of the plane of the force
      // but of the sphere there, whose slope has a share of the depression (1 - 2 nu) y / (4 pi
      // r^2).
      const double along_x = curved_displacement(response[2], offset, 1.0);
      const double along_y = curved_displacement(response[3], offset, 1.0);
      const double depression = (1.0 - 2.0 * nu) * offset.y / (4.0 * pi * glm::dot(offset, offset));
      const glm::dvec2 along(-at.y, at.x);
      mean += ((at.x * along_y - at.y * along_x) / (8.0 * pi) +
               depression * glm::dot(offset, along) / radius) /
              kPlaces;
    }
    EXPECT_NEAR(mean, 3.0 / (2.0 * radius) / (4.0 * pi), 1e-4 * mean) << nu;
  }
}

TEST(CurvedInfluenceTest, TablesAddWhatTheCurvatureDoes) {
  constexpr std::uint32_t kSide = 6;
  constexpr double kNu = 0.5;
  std::vector<double> half_space(influence_count(kSide));
  fill_influences(kNu, kSide, half_space);
  const InfluenceTables plane = influence_tables(half_space, kSide, 1);
  const CurvedResponse response = curved_response({3.0, 1.0, 2.0}, kNu);
  const glm::dvec2 cell(2e-3, 1e-3);
  std::vector<double> values(layer_influence_count(kSide));
  fill_curved_influences(plane, response, cell, 0.01, values);
  const InfluenceTables curved = layer_influence_tables(values, kSide);
  for (const auto& [i, j] : {std::pair{3U, 1U}, std::pair{0U, 5U}, std::pair{5U, 5U}}) {
    const glm::dvec2 offset = cell * glm::dvec2(i, j);
    for (std::size_t kind = 0; kind < kCurvedKinds; ++kind) {
      const std::size_t at = curved.index(0, 0, i, j);
      // A cell's force is its pressure times its area; the table's unit is the cell's length over
      // the shear modulus. Within a cell it hardly varies.
      const double wanted = curved_displacement(response[kind], offset, 0.01) / (8.0 * pi) * cell.y;
      EXPECT_NEAR(curved.kinds[kind][at] - plane.kinds[kind][at], wanted, 3e-2 * 3.0 * cell.y / pi)
          << kind;
      // Reciprocity: the same seen from the other cell.
      EXPECT_EQ(curved.kinds[kind][at], curved.kinds[kind][curved.index(i, j, 0, 0)]);
      // On the other side in x alone.
      const std::size_t across = curved.index(i, 0, 0, j);
      const double there =
          curved_displacement(response[kind], {-offset.x, offset.y}, 0.01) / (8.0 * pi) * cell.y;
      EXPECT_NEAR(curved.kinds[kind][across] - plane.kinds[kind][across], there,
                  3e-2 * 3.0 * cell.y / pi)
          << kind;
      EXPECT_EQ(curved.kinds[kind][across], curved.kinds[kind][curved.index(0, j, i, 0)]);
    }
  }
}

TEST(CurvedInfluenceTest, AFlatSurfaceIsTheHalfSpace) {
  const CurvedResponse response = curved_response({}, 0.3);
  for (const CurvedKind& kind : response) {
    EXPECT_EQ(curved_displacement(kind, {1e-3, -2e-3}, 0.01), 0.0);
    EXPECT_EQ(curved_mean(kind, 1e-3, 0.01), 0.0);
  }
}

TEST(CurvedInfluenceTest, MeanOverADiscIsThatOfItsPlaces) {
  // Places of the density 1 / sqrt(1 - r^2): equal steps of sqrt(1 - r^2), golden angles; two
  // different sets, so that no place meets itself.
  const CurvedResponse response = curved_response({4.0, 0.0, 2.0}, 0.5);
  constexpr int kPlaces = 700;
  const auto place = [](int i, int count, double turn) {
    const double rest = (i + 0.5) / count;
    const double angle = 2.39996322972865332 * i + turn;
    return 1e-3 * std::sqrt(1.0 - rest * rest) * glm::dvec2(std::cos(angle), std::sin(angle));
  };
  double mean = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    for (int j = 0; j < kPlaces + 1; ++j) {
      mean += curved_displacement(response[1], place(i, kPlaces, 0.0) - place(j, kPlaces + 1, 1.0),
                                  0.01);
    }
  }
  mean /= kPlaces * (kPlaces + 1.0);
  EXPECT_NEAR(curved_mean(response[1], 1e-3, 0.01), mean, 2e-3 * mean);
}

}  // namespace
}  // namespace torsion::engine
