#include "systems/model/prepare.hpp"

#include <algorithm>
#include <numeric>
#include <thread>

#include "systems/contact/law.hpp"
#include "systems/contact/support/support_fit.hpp"
#include "systems/contact/tool_motion.hpp"
#include "systems/geometry/bounds.hpp"
#include "systems/geometry/distance_field.hpp"
#include "systems/geometry/sample_surface.hpp"
#include "systems/geometry/unite_meshes.hpp"
#include "systems/half_space/influence.hpp"
#include "systems/half_space/layer.hpp"
#include "systems/math/frames.hpp"
#include "systems/model/cache.hpp"
#include "systems/model/choose_models.hpp"

namespace torsion::engine {
namespace {

constexpr std::uint32_t kSamplesPerTool = 2000;
// r_th over the mean distance to a sample's farthest neighbour: neighbours in one contact are
// always linked, and two contacts a few samples apart are not.
constexpr double kThresholdOverSpacing = 1.2;
constexpr double kHighestRate = 1e6;  // Hz

/// Everything that is computed before the tables' sizes are known.
struct Built {
  std::vector<BuiltField> fields;        // in the order of mesh parts: bodies', then tools'
  std::vector<SampledSurface> surfaces;  // one for each tool
};

std::uint32_t threads_of(const PrepareOptions& options) {
  return options.threads > 0 ? options.threads : std::max(1U, std::thread::hardware_concurrency());
}

SurfaceMesh in_part_frame(const PartDescription& part, SurfaceMesh mesh) {
  for (glm::dvec3& position : mesh.positions) {
    position = to_inner(part.shape.pose, position);
  }
  return mesh;
}

Result<Done> build_fields(std::span<const PartDescription> parts, const PrepareOptions& options,
                          std::vector<BuiltField>& fields) {
  const FieldOptions field_options{.threads = threads_of(options)};
  for (const PartDescription& part : parts) {
    if (part.shape.kind != ShapeKind::kMesh) {
      continue;
    }
    const SurfaceMesh mesh = in_part_frame(part, part.surface);
    const SurfaceMesh solid =
        part.solid != nullptr ? in_part_frame(part, *part.solid) : SurfaceMesh{};
    const FieldOfMesh wanted{mesh, part.solid != nullptr ? solid : mesh};
    Result<BuiltField> field = options.use_cache
                                   ? load_or_build_distance_field(wanted, field_options)
                                   : build_distance_field(wanted, field_options);
    if (!field) {
      return Error{"node '" + part.node + "': " + field.error().text};
    }
    fields.push_back(std::move(field).value());
  }
  return Done{};
}

Result<Built> build(const SceneDescription& scene, const PrepareOptions& options) {
  Built built;
  for (const BodyDescription& body : scene.bodies) {
    const Result<Done> done = build_fields(body.parts, options, built.fields);
    if (!done) {
      return done.error();
    }
  }
  for (const ToolDescription& tool : scene.tools) {
    const Result<Done> done = build_fields(tool.parts, options, built.fields);
    if (!done) {
      return done.error();
    }
    built.surfaces.push_back(sample_surface(tool.parts, kSamplesPerTool));
  }
  return built;
}

/// Of all tables that do not depend on the models.
Capacities capacities_of(const SceneDescription& scene, const Built& built) {
  Capacities needed;
  needed.bodies = static_cast<std::uint32_t>(scene.bodies.size());
  needed.tools = static_cast<std::uint32_t>(scene.tools.size());
  for (const BodyDescription& body : scene.bodies) {
    needed.parts += static_cast<std::uint32_t>(body.parts.size());
    needed.fixed_volumes += static_cast<std::uint32_t>(body.fixed_volumes.size());
  }
  for (const ToolDescription& tool : scene.tools) {
    needed.parts += static_cast<std::uint32_t>(tool.parts.size());
  }
  needed.fields = static_cast<std::uint32_t>(built.fields.size());
  for (const BuiltField& field : built.fields) {
    needed.field_nodes += static_cast<std::uint32_t>(field.nodes.size());
    needed.field_bricks += static_cast<std::uint32_t>(field.bricks.size());
    needed.field_creases += static_cast<std::uint32_t>(field.creases.size());
  }
  for (const SampledSurface& surface : built.surfaces) {
    needed.samples += static_cast<std::uint32_t>(surface.samples.size());
    needed.balls += static_cast<std::uint32_t>(surface.balls.size());
  }
  needed.anchors = needed.bodies * kAnchorsPerBody;
  needed.regions = needed.bodies * kMaxRegionsPerBody;
  return needed;
}

/// Appends `rows` to a table; the capacity was counted before, so they fit.
template <class T, class AnyTable>
Range append_rows(AnyTable& table, std::span<const T> rows) {
  const std::optional<Range> range = table.append(static_cast<std::uint32_t>(rows.size()));
  TORSION_ASSERT(range.has_value());
  std::ranges::copy(rows, table.template rows<T>(*range).begin());
  return *range;
}

std::uint32_t append_field(Model& model, const BuiltField& built) {
  DistanceField field = built.header;
  field.coarse_nodes.first = append_rows<DistanceNode>(model.field_nodes, built.nodes).first;
  field.bricks = append_rows<DistanceBrick>(model.field_bricks, built.bricks);
  field.creases = append_rows<DistanceCrease>(model.field_creases, built.creases);
  return append_rows<DistanceField>(model.fields, {&field, 1}).first;
}

/// @param next_field  which of the built fields the next mesh part uses; in and out
Range append_parts(Model& model, std::span<const PartDescription> parts, const Built& built,
                   std::size_t& next_field) {
  const Range range{model.parts.size(), static_cast<std::uint32_t>(parts.size())};
  for (const PartDescription& part : parts) {
    ShapePart shape = part.shape;
    shape.field =
        shape.kind == ShapeKind::kMesh ? append_field(model, built.fields[next_field++]) : kNoRow;
    append_rows<ShapePart>(model.parts, {&shape, 1});
  }
  return range;
}

double default_threshold(const Model& model) {
  const auto samples = model.samples.column<SurfaceSample>();
  const double sum =
      std::transform_reduce(samples.begin(), samples.end(), 0.0, std::plus<>{},
                            [](const SurfaceSample& sample) { return sample.spacing; });
  return samples.empty() ? 0.0 : kThresholdOverSpacing * sum / static_cast<double>(samples.size());
}

void append_tool(Model& model, const ToolDescription& tool, const SampledSurface& surface,
                 const Built& built, std::size_t& next_field) {
  OwnedRows owned;
  owned.parts = append_parts(model, tool.parts, built, next_field);
  owned.samples = append_rows<SurfaceSample>(model.samples, surface.samples);
  owned.balls = append_rows<SurfaceBall>(model.balls, surface.balls);
  const std::uint32_t row = model.tools.append()->first;
  model.tools.at<MassProperties>(row) = tool.mass;
  model.tools.at<OwnedRows>(row) = owned;
  model.tools.at<Bounds>(row) = bounds_of(tool.parts);
}

void append_body(Model& model, const BodyDescription& body, const Built& built,
                 std::size_t& next_field) {
  OwnedRows owned;
  owned.parts = append_parts(model, body.parts, built, next_field);
  FixedRegion fixed = body.fixed;
  fixed.volumes = append_rows<FixedVolume>(model.fixed_volumes, body.fixed_volumes);
  const std::uint32_t row = model.bodies.append()->first;
  model.bodies.at<Pose>(row) = body.pose;
  model.body_scripts.push_back(body.script);
  model.bodies.at<Elasticity>(row) = body.elasticity;
  model.bodies.at<Friction>(row) = body.friction;
  model.bodies.at<FixedRegion>(row) = fixed;
  model.bodies.at<BodyModels>(row) = body.models;
  model.bodies.at<OwnedRows>(row) = owned;
  model.bodies.at<Bounds>(row) = bounds_of(body.parts);
}

/// The tables that do not depend on models: shapes, bodies, tools.
void append_scene(Model& model, const SceneDescription& scene, const Built& built) {
  std::size_t next_field = 0;
  for (const BodyDescription& body : scene.bodies) {
    append_body(model, body, built, next_field);
  }
  for (std::size_t tool = 0; tool < scene.tools.size(); ++tool) {
    append_tool(model, scene.tools[tool], built.surfaces[tool], built, next_field);
  }
  for (BodyModels& models : model.bodies.column<BodyModels>()) {
    models.region_threshold = std::max(models.region_threshold, default_threshold(model));
  }
}

std::vector<ModelChoice> choose_all(const Model& model, const PrepareOptions& options) {
  std::vector<ModelChoice> choices;
  for (std::uint32_t row = 0; row < model.bodies.size(); ++row) {
    choices.push_back(choose_models(model.bodies.at<BodyModels>(row), options,
                                    expect_contact(model, row, options.expected_poses),
                                    model.bodies.at<Elasticity>(row).poisson_ratio));
  }
  return choices;
}

/// Anchors and matrices of all bodies with body model compliance; empty for the others. Where it
/// can't be built and was not demanded, the choice becomes skeleton.
Result<std::vector<PreparedCompliance>> build_compliances(const Model& model,
                                                          const SceneDescription& scene,
                                                          std::span<ModelChoice> choices,
                                                          const PrepareOptions& options) {
  std::vector<PreparedCompliance> all(choices.size());
  const auto compliant =
      static_cast<double>(std::ranges::count_if(choices, [](const ModelChoice& choice) {
        return choice.models.body == BodyModel::kCompliance;
      }));
  double done = 0.0;  // bodies
  const auto progress = [&](double share) {
    if (options.progress) {
      options.progress((done + share) / compliant);
    }
  };
  for (std::uint32_t row = 0; row < choices.size(); ++row) {
    if (choices[row].models.body == BodyModel::kCompliance) {
      Result<PreparedCompliance> built =
          prepare_compliance(scene.bodies[row], model, row, choices[row].place, threads_of(options),
                             options.use_cache, progress);
      done += 1.0;
      if (!built && choices[row].body_is_auto) {
        choices[row].models.body = BodyModel::kSkeleton;
        choices[row].body_why = "auto: " + built.error().text;
        continue;
      }
      if (!built) {
        return built.error();
      }
      all[row] = std::move(built).value();
    }
  }
  return all;
}

/// Whether the contacts of the body see it as a layer.
bool has_kernel(const Model& model, std::uint32_t row, const BodyModels& models) {
  return models.body == BodyModel::kCompliance && is_layer(model, row);
}

bool keeps(const BodyModels& models, KeptColumns columns) {
  return contact_law(models.contact).keeps == columns;
}

/// Whether regions on the body may need influence tables of their own.
bool has_own_tables(const Model& model, std::uint32_t row, const BodyModels& models) {
  return keeps(models, KeptColumns::kSurfaceCells) && models.body == BodyModel::kCompliance &&
         (is_layer(model, row) || may_bend(model, row));
}

/// Numbers of rows in `influences` that a body needs.
struct InfluenceRows {
  std::uint32_t tables = 0;
  std::uint32_t kernel = 0;
};
InfluenceRows influence_rows(const Model& model, std::uint32_t row, const BodyModels& models,
                             std::uint32_t side) {
  const std::size_t tables =
      keeps(models, KeptColumns::kSurfaceCells) ? influence_count(side) : std::size_t{0};
  const std::size_t kernel = has_kernel(model, row, models) ? kLayerKernelSize : 0;
  return {static_cast<std::uint32_t>(tables), static_cast<std::uint32_t>(kernel)};
}

void append_influences(Model& model, std::uint32_t row, const BodyModels& models) {
  static_assert(sizeof(Influence) == sizeof(double));
  const std::uint32_t side = model.settings.grid_side;
  const double poisson_ratio = model.bodies.at<Elasticity>(row).poisson_ratio;
  const auto append = [&model](std::uint32_t count, const auto& fill) {
    const Range range = *model.influences.append(count);
    if (count > 0) {
      fill(std::span(&model.influences.rows<Influence>(range).front().value, count));
    }
    return range;
  };
  const InfluenceRows needed = influence_rows(model, row, models, side);
  OwnedRows& owned = model.bodies.at<OwnedRows>(row);
  owned.influences = append(needed.tables, [&](std::span<double> values) {
    fill_influences(poisson_ratio, side, values);
  });
  owned.layer_kernel = append(
      needed.kernel, [&](std::span<double> values) { fill_layer_kernel(poisson_ratio, values); });
}

/// Appends what the chosen models of a body need.
void append_models(Model& model, std::uint32_t row, const BodyDescription& body,
                   const PreparedCompliance& compliant, ModelChoice& choice) {
  OwnedRows& owned = model.bodies.at<OwnedRows>(row);
  if (!compliant.anchors.empty()) {
    owned.anchors = append_rows<AnchorRest>(model.anchors, compliant.anchors);
    owned.ports = append_rows<CompliancePort>(model.ports, compliant.ports);
    owned.compliance = append_rows<ComplianceValue>(model.compliance, compliant.values);
    const auto sections = static_cast<std::uint32_t>(compliant.anchors.size()) * kBeamStations;
    append_rows<BeamSection>(model.sections, std::vector<BeamSection>(sections));
  } else if (choice.models.body == BodyModel::kCompliance) {
    choice.models.body = BodyModel::kNone;
    choice.body_why = "hardly any of the body is free";
  }
  if (choice.models.body == BodyModel::kSkeleton) {
    const Range volumes = model.bodies.at<FixedRegion>(row).volumes;
    const PreparedAnchors prepared = prepare_anchors(body, model, owned.parts, volumes);
    if (prepared.anchors.empty()) {
      choice.models.body = BodyModel::kNone;
      choice.body_why = "all of the body is fixed";
    }
    owned.anchors = append_rows<AnchorRest>(model.anchors, prepared.anchors);
    append_rows<BeamSection>(model.sections, prepared.sections);
  }
  append_influences(model, row, choice.models);
  model.bodies.at<BodyModels>(row) = choice.models;
}

/// Chooses models and fills all tables that depend on them.
Result<Done> append_choices(PreparedWorld& prepared, const SceneDescription& scene,
                            const PrepareOptions& options, Capacities capacities) {
  Model& model = prepared.world.model;
  prepared.choices = choose_all(model, options);
  Settings settings = options.settings;
  settings.grid_side =
      settings.grid_side == 0 ? choose_grid_side(prepared.choices) : settings.grid_side;
  for (std::uint32_t row = 0; row < model.bodies.size(); ++row) {
    const BodyModels& models = prepared.choices[row].models;
    const InfluenceRows influences = influence_rows(model, row, models, settings.grid_side);
    capacities.influences += influences.tables + influences.kernel;
    capacities.patch_bodies += keeps(models, KeptColumns::kSurfaceCells) ? 1U : 0U;
    capacities.mdr_bodies += keeps(models, KeptColumns::kSpringLayers) ? 1U : 0U;
    if (has_own_tables(model, row, models)) {
      capacities.layer_influences =
          static_cast<std::uint32_t>(layer_influence_count(settings.grid_side));
    }
  }
  const Result<std::vector<PreparedCompliance>> compliances =
      build_compliances(model, scene, prepared.choices, options);
  if (!compliances) {
    return compliances.error();
  }
  for (const PreparedCompliance& compliant : compliances.value()) {
    capacities.ports += static_cast<std::uint32_t>(compliant.ports.size());
    capacities.compliance_values += static_cast<std::uint32_t>(compliant.values.size());
  }
  model.reserve_models(capacities, settings);
  for (std::uint32_t row = 0; row < model.bodies.size(); ++row) {
    append_models(model, row, scene.bodies[row], compliances.value()[row], prepared.choices[row]);
  }
  prepared.world.state.reserve(capacities, settings);
  place_bodies(model, prepared.world.state);
  model.dt = 1.0 / options.rate;
  return Done{};
}

/// The scene with one solid in place of meshes that overlap.
/// @param united  out: nodes of those meshes
Result<SceneDescription> with_unions(const SceneDescription& scene,
                                     std::vector<std::string>& united) {
  SceneDescription solid = scene;
  const auto unite = [&united](std::vector<PartDescription>& parts,
                               bool with_others) -> Result<Done> {
    Result<std::vector<std::string>> nodes = unite_parts(parts, with_others);
    if (!nodes) {
      return nodes.error();
    }
    united.insert(united.end(), nodes.value().begin(), nodes.value().end());
    return Done{};
  };
  for (BodyDescription& body : solid.bodies) {
    if (const Result<Done> done = unite(body.parts, true); !done) {
      return done.error();
    }
  }
  for (ToolDescription& tool : solid.tools) {
    if (const Result<Done> done = unite(tool.parts, false); !done) {
      return done.error();
    }
  }
  return solid;
}

}  // namespace

Result<PreparedWorld> prepare_world(const SceneDescription& scene, const PrepareOptions& options) {
  if (!(options.rate > 0.0 && options.rate <= kHighestRate)) {
    return Error{"the rate must be above 0 and at most 1e6 Hz, it is " +
                 std::to_string(options.rate)};
  }
  if (options.settings.grid_side > kMaxGridSide) {
    return Error{"the grid must have 1 to " + std::to_string(kMaxGridSide) +
                 " cells along a side, it has " + std::to_string(options.settings.grid_side)};
  }
  PreparedWorld prepared;
  const Result<SceneDescription> united = with_unions(scene, prepared.united_nodes);
  if (!united) {
    return united.error();
  }
  const SceneDescription& solid = united.value();
  const Result<Built> built = build(solid, options);
  if (!built) {
    return built.error();
  }
  Model& model = prepared.world.model;
  const Capacities capacities = capacities_of(solid, built.value());
  model.reserve(capacities, Settings{1, 0});
  append_scene(model, solid, built.value());
  const Result<Done> done = append_choices(prepared, solid, options, capacities);
  if (!done) {
    return done.error();
  }
  return prepared;
}

Result<PreparedWorld> prepare_unit_world(const SceneDescription& scene,
                                         const PrepareOptions& options) {
  SceneDescription unit = scene;
  for (BodyDescription& body : unit.bodies) {
    body.elasticity.youngs_modulus = 1.0;
  }
  return prepare_world(unit, options);
}

World world_of_materials(const World& unit, const SceneDescription& scene) {
  World world = unit;
  Model& model = world.model;
  for (std::uint32_t row = 0; row < model.bodies.size(); ++row) {
    const BodyDescription& body = scene.bodies[row];
    TORSION_ASSERT(body.elasticity.poisson_ratio == model.bodies.at<Elasticity>(row).poisson_ratio);
    model.bodies.at<Elasticity>(row) = body.elasticity;
    model.bodies.at<Friction>(row) = body.friction;
    // A compliance is the only table that a modulus is in: as load_or_build_smooth_compliance does.
    for (ComplianceValue& value :
         model.compliance.rows<ComplianceValue>(model.bodies.at<OwnedRows>(row).compliance)) {
      value.value /= body.elasticity.youngs_modulus;
    }
  }
  for (std::uint32_t row = 0; row < model.tools.size(); ++row) {
    model.tools.at<MassProperties>(row) = scene.tools[row].mass;
  }
  return world;
}

}  // namespace torsion::engine
