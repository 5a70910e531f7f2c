#include "systems/geometry/sample_surface.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include <glm/geometric.hpp>

#include "systems/math/lanes.hpp"

namespace torsion::engine {
namespace {

constexpr std::uint32_t kCandidatesPerSample = 6;
constexpr double kPieceOverSpacing =
    0.4;  // longest edge of what is given to one leaf: bounds how much it is too large
constexpr std::uint32_t kMostPieces =
    400'000;  // a mesh of slivers keeps larger balls rather than a longer load

struct SampleCandidate {
  glm::dvec3 position;
  glm::dvec3 normal;
  std::uint32_t part;
};

/// Points spread over the pieces by area: equal steps through the areas, and within each piece the
/// R2 sequence (Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018).
std::vector<SampleCandidate> candidates_on(std::span<const SurfaceTriangle> pieces,
                                           const PartSolids& solids, double total_area,
                                           std::uint32_t count) {
  std::vector<SampleCandidate> candidates;
  candidates.reserve(count);
  std::size_t piece = 0;
  double end = pieces[0].area;
  for (std::uint32_t k = 0; k < count; ++k) {
    const double place = (k + 0.5) / count * total_area;
    while (place > end && piece + 1 < pieces.size()) {
      end += pieces[++piece].area;
    }
    double u = std::fmod(0.5 + k * 0.7548776662466927, 1.0);
    double v = std::fmod(0.5 + k * 0.5698402909980532, 1.0);
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const auto& [a, b, c] = pieces[piece].corner;
    const glm::dvec3 point = a + u * (b - a) + v * (c - a);
    if (!solids.inside_others(point, pieces[piece].part, 0.0)) {
      candidates.push_back({point, pieces[piece].normal, pieces[piece].part});
    }
  }
  return candidates;
}

/// The candidates as columns of float for the search below: place, and normal times the samples'
/// spacing. So points on the two sides of a crease or of a thin wall count as a spacing or two
/// apart.
struct CandidateColumns {
  std::array<std::vector<float>, 6> column;
  std::vector<float> squared_distance;  // to the nearest of the chosen
};

CandidateColumns columns_of(std::span<const SampleCandidate> candidates, double spacing) {
  CandidateColumns columns;
  const glm::dvec3 origin = candidates[0].position;
  for (int axis = 0; axis < 3; ++axis) {
    auto& place = columns.column[static_cast<std::size_t>(axis)];
    auto& normal = columns.column[static_cast<std::size_t>(axis) + 3];
    for (const SampleCandidate& candidate : candidates) {
      place.push_back(static_cast<float>((candidate.position[axis] - origin[axis]) / spacing));
      normal.push_back(static_cast<float>(candidate.normal[axis]));
    }
  }
  columns.squared_distance.assign(candidates.size(), std::numeric_limits<float>::infinity());
  return columns;
}

/// Lowers each distance to the one to `chosen` where that is smaller.
/// @return the row that is farthest then
TORSION_WIDEST std::size_t lower_distances(CandidateColumns& columns, std::size_t chosen) {
  constexpr std::size_t kBlock = 256;  // rows among which the farthest is looked for by its value
  const auto& [x, y, z, nx, ny, nz] = columns.column;
  const std::array<float, 6> to{x[chosen],  y[chosen],  z[chosen],
                                nx[chosen], ny[chosen], nz[chosen]};
  const auto square = [](float value) {
    return value * value;
  };
  std::vector<float>& nearest = columns.squared_distance;
  std::int32_t most = -1;
  std::size_t most_block = 0;
  for (std::size_t first = 0; first < nearest.size(); first += kBlock) {
    const std::size_t end = std::min(first + kBlock, nearest.size());
    std::int32_t most_here = -1;  // not negative, so that bits compare as their values
    for (std::size_t i = first; i < end; ++i) {
      const float squared = square(x[i] - to[0]) + square(y[i] - to[1]) + square(z[i] - to[2]) +
                            square(nx[i] - to[3]) + square(ny[i] - to[4]) + square(nz[i] - to[5]);
      nearest[i] = squared < nearest[i] ? squared : nearest[i];
      most_here = std::max(most_here, std::bit_cast<std::int32_t>(nearest[i]));
    }
    most_block = most_here > most ? first : most_block;
    most = std::max(most, most_here);
  }
  const auto place = nearest.begin() + static_cast<std::ptrdiff_t>(most_block);
  return static_cast<std::size_t>(std::find(place, nearest.end(), std::bit_cast<float>(most)) -
                                  nearest.begin());
}

/// Takes again and again the candidate that is farthest from all taken so far: Gonzalez,
/// "Clustering to minimize the maximum intercluster distance", 1985. The largest hole is at most
/// twice the smallest possible.
std::vector<std::uint32_t> spread_out(std::span<const SampleCandidate> candidates, double spacing,
                                      std::uint32_t count) {
  CandidateColumns columns = columns_of(candidates, spacing);
  std::vector<std::uint32_t> chosen;
  std::size_t next = 0;
  while (chosen.size() < std::min<std::size_t>(count, candidates.size())) {
    chosen.push_back(static_cast<std::uint32_t>(next));
    next = lower_distances(columns, next);
    if (!(columns.squared_distance[next] > 0.0F)) {
      break;
    }
  }
  return chosen;
}

glm::dvec3 snapped(const PartDescription& part, glm::dvec3 point) {
  if (part.shape.kind == ShapeKind::kMesh) {
    return point;
  }
  for (int step = 0; step < 2;
       ++step) {  // one is exact but for rounding; an ellipsoid's far from it gains by two
    const Distance distance = exact_distance(part.shape, point);
    point -= distance.value * distance.gradient;
  }
  return point;
}

/// Fills neighbours and spacing.
void find_neighbours(std::span<SurfaceSample> samples) {
  for (std::uint32_t own = 0; own < samples.size(); ++own) {
    std::array<double, kSampleNeighbours> squared{};
    squared.fill(std::numeric_limits<double>::infinity());
    auto& neighbours = samples[own].neighbours;
    std::fill(std::begin(neighbours), std::end(neighbours), kNoRow);
    for (std::uint32_t other = 0; other < samples.size(); ++other) {
      const glm::dvec3 difference = samples[other].position - samples[own].position;
      const double distance = glm::dot(difference, difference);
      if (other == own || distance >= squared.back()) {
        continue;
      }
      std::size_t place = kSampleNeighbours - 1;
      for (; place > 0 && squared[place - 1] > distance; --place) {
        squared[place] = squared[place - 1];
        neighbours[place] = neighbours[place - 1];
      }
      squared[place] = distance;
      neighbours[place] = other;
    }
    const std::size_t count = std::min<std::size_t>(kSampleNeighbours, samples.size() - 1);
    samples[own].spacing = count > 0 ? std::sqrt(squared[count - 1]) : 0.0;
  }
}

/// Assigns every piece to a leaf near it, whose ball then grows to hold it. Pieces with edges
/// longer than `longest_edge` are halved first.
class LeafCover {
 public:
  LeafCover(std::span<SurfaceBall> balls, std::span<const SurfaceSample> samples,
            double longest_edge)
      : balls_(balls), squared_edge_(longest_edge * longest_edge), radius_(samples.size(), 0.0) {
    for (const SurfaceSample& sample : samples) {
      centers_.push_back(sample.position);
    }
  }

  void cover(const SurfaceTriangle& piece, int most_halvings) {
    const auto& [a, b, c] = piece.corner;
    cover(a, b, c, piece.bulge, most_halvings);
  }

  [[nodiscard]] double radius(std::uint32_t sample) const { return radius_[sample]; }

 private:
  void cover(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double bulge,
             int most_halvings) {
    const auto squared = [](const glm::dvec3& from, const glm::dvec3& to) {
      return glm::dot(to - from, to - from);
    };
    const double ab = squared(a, b);
    const double bc = squared(b, c);
    const double ca = squared(c, a);
    if (bc > ab && bc >= ca) {
      return cover_rotated(b, c, a, bc, bulge, most_halvings);
    }
    if (ca > ab) {
      return cover_rotated(c, a, b, ca, bulge, most_halvings);
    }
    return cover_rotated(a, b, c, ab, bulge, most_halvings);
  }

  /// The same for a triangle whose longest edge is ab.
  void cover_rotated(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                     double squared_ab, double bulge, int most_halvings) {
    if (squared_ab > squared_edge_ && most_halvings > 0) {
      const glm::dvec3 middle = 0.5 * (a + b);
      cover(a, middle, c, bulge, most_halvings - 1);
      cover(middle, b, c, bulge, most_halvings - 1);
      return;
    }
    last_ = nearest_leaf(balls_, centers_, (a + b + c) / 3.0, last_);
    const glm::dvec3& center = centers_[last_];
    const double reach =
        std::max({glm::distance(center, a), glm::distance(center, b), glm::distance(center, c)});
    radius_[last_] = std::max(radius_[last_], (reach + bulge) * (1.0 + 1e-12));
  }

  std::span<const SurfaceBall> balls_;
  double squared_edge_;
  std::vector<double> radius_;
  std::vector<glm::dvec3> centers_;
  std::uint32_t last_ = 0;
};

void cover_surface(std::span<const SurfaceTriangle> pieces, double spacing,
                   SampledSurface& surface) {
  const double budget = static_cast<double>(kMostPieces) / static_cast<double>(pieces.size());
  const int most_halvings =
      std::max(2, static_cast<int>(std::floor(std::log2(std::max(budget, 1.0)))));
  LeafCover cover(surface.balls, surface.samples, kPieceOverSpacing * spacing);
  for (const SurfaceTriangle& piece : pieces) {
    cover.cover(piece, most_halvings);
  }
  for (SurfaceBall& ball : surface.balls) {
    if (ball.sample != kNoRow) {
      ball.radius = cover.radius(ball.sample);
    }
  }
  fit_balls(surface.balls);
}

}  // namespace

SampledSurface sample_surface(std::span<const PartDescription> parts, std::uint32_t target_count) {
  SampledSurface surface;
  const PartSolids solids(parts);
  const std::vector<SurfaceTriangle> pieces = surface_pieces(parts, solids, target_count);
  const double area =
      std::accumulate(pieces.begin(), pieces.end(), 0.0,
                      [](double sum, const SurfaceTriangle& piece) { return sum + piece.area; });
  if (pieces.empty() || target_count == 0) {
    return surface;
  }
  const std::vector<SampleCandidate> candidates =
      candidates_on(pieces, solids, area, kCandidatesPerSample * target_count);
  if (candidates.empty()) {
    return surface;
  }
  const double spacing = std::sqrt(area / target_count);
  std::vector<glm::dvec3> positions;
  for (const std::uint32_t row : spread_out(candidates, spacing, target_count)) {
    positions.push_back(snapped(parts[candidates[row].part], candidates[row].position));
  }
  PointTree tree = point_tree(positions);
  surface.balls = std::move(tree.balls);
  for (const std::uint32_t row : tree.order) {
    SurfaceSample sample;
    sample.position = positions[row];
    surface.samples.push_back(sample);
  }
  find_neighbours(surface.samples);
  cover_surface(pieces, spacing, surface);
  return surface;
}

}  // namespace torsion::engine
