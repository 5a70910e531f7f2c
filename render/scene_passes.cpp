#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "render/barriers.hpp"
#include "render/recording.hpp"

namespace torsion::engine {
namespace {

using Commands = vk::raii::CommandBuffer;

constexpr float kClearTool = 0.13F;  // alpha of a glass tool where one looks straight through it

/// How a group of triangles covers what is behind it.
enum class Cover : std::uint8_t { kSolid, kCutOut, kGlass };

Cover tool_cover(const DrawMaterial& material, ToolLook look) {
  if (look == ToolLook::kGlass) {
    return Cover::kGlass;
  }
  switch (material.alpha_mode) {
    case AlphaMode::kMask:
      return Cover::kCutOut;
    case AlphaMode::kOpaque:
      return Cover::kSolid;
    case AlphaMode::kUnsaid:
    case AlphaMode::kBlend:
      break;
  }
  return look == ToolLook::kOpaque ? Cover::kSolid : Cover::kGlass;
}

Cover body_cover(const DrawMaterial& material) {
  switch (material.alpha_mode) {
    case AlphaMode::kMask:
      return Cover::kCutOut;
    case AlphaMode::kBlend:
      return Cover::kGlass;
    case AlphaMode::kUnsaid:
    case AlphaMode::kOpaque:
      break;
  }
  return Cover::kSolid;
}

/// Alpha of a tool: its material's, unless that was not made to be seen through and is all the
/// same.
float tool_alpha(const DrawMaterial& material, Cover cover) {
  const bool own = cover != Cover::kGlass || material.alpha_mode == AlphaMode::kBlend;
  return own ? material.color.w : kClearTool;
}

void draw_triangles(const Commands& commands, const DrawRange& drawn, Range triangles) {
  commands.drawIndexed(3 * triangles.count, 1, 3 * triangles.first,
                       static_cast<std::int32_t>(drawn.vertices.first), 0);
}

/// The bits of a material.
std::uint32_t draw_bits(const FrameInputs& inputs, std::uint32_t material) {
  const float strength = inputs.frame.materials[material].occlusion_strength;
  return inputs.textures.bits(material) | static_cast<std::uint32_t>(std::lround(255.0F * strength))
                                              << shared::kOcclusionShift;
}

/// Which groups of triangles one pipeline draws.
struct Selection {
  Cover cover = Cover::kSolid;
  bool textured = true;            // the shaders read textures
  std::optional<std::size_t> row;  // of kReadTextures; none: all

  [[nodiscard]] bool has(std::uint32_t textures) const {
    return !row || read_textures_row(textures) == *row;
  }
};

/// Placement and look of each selected group of triangles, of each row of `things`.
/// @param cover_of  of a material
/// @param f  f(row, material, constants) may add to the constants before the draw
template <class Things, class CoverOf, class F>
void draw_each(const Commands& commands, const FrameInputs& inputs, const Things& things,
               const Table<DrawGroup>& groups, const Selection& selection, CoverOf&& cover_of,
               F&& f) {
  for (std::uint32_t row = 0; row < things.size(); ++row) {
    const auto& drawn = things.template at<DrawRange>(row);
    for (const DrawGroup& group : groups.rows<DrawGroup>(drawn.groups)) {
      const DrawMaterial& material = inputs.frame.materials[group.material];
      if (group.triangles.count == 0 || cover_of(material) != selection.cover ||
          !selection.has(inputs.textures.bits(group.material))) {
        continue;
      }
      shared::DrawConstants constants{};
      set_pose(things.template at<Pose>(row), constants);
      constants.color = material.color;
      constants.surface = {material.metallic, material.roughness, material.scattering,
                           material.alpha_cutoff};
      constants.emission = glm::vec4(material.emission, material.normal_scale);
      constants.rows.w = draw_bits(inputs, group.material);
      f(row, material, constants);
      if (selection.textured) {
        push_textures(commands, inputs, group.material);
      }
      push_constants(commands, inputs.pipelines.draw_layout, kDrawStages, constants);
      commands.setCullMode(material.double_sided ? vk::CullModeFlagBits::eNone
                                                 : vk::CullModeFlagBits::eBack);
      draw_triangles(commands, drawn, group.triangles);
    }
  }
}

/// Draws with the pipelines of one cover.
/// @param draw  draw(selection): all that is selected
template <class F>
void draw_with(const Commands& commands, const SurfacePipelines& pipelines, Cover cover, F&& draw) {
  const auto draw_by = [&](const vk::raii::Pipeline& pipeline, const Selection& selection) {
    if (*pipeline) {
      bind(commands, pipeline);
      draw(selection);
    }
  };
  switch (cover) {
    case Cover::kCutOut:
      draw_by(pipelines.cut_out, {cover, true, {}});
      return;
    case Cover::kGlass:
      draw_by(pipelines.glass_depth, {cover, true, {}});
      break;
    case Cover::kSolid:
      break;
  }
  const auto& by_textures = cover == Cover::kGlass ? pipelines.glass : pipelines.solid;
  for (std::size_t row = 0; row < kReadTextures.size(); ++row) {
    draw_by(by_textures[row], {cover, true, row});
  }
}

void draw_bodies(const Commands& commands, const FrameInputs& inputs, Cover cover) {
  if (inputs.frame.bodies.empty()) {
    return;
  }
  const SceneBuffers& buffers = inputs.buffers;
  bind_vertices(commands, {*buffers.positions.handle, *buffers.normals.handle, *buffers.rest.handle,
                           *buffers.paint.handle});
  commands.bindIndexBuffer(*buffers.body_indices.handle, 0, vk::IndexType::eUint32);
  const auto add = [&](std::uint32_t row, const DrawMaterial& /*material*/,
                       shared::DrawConstants& constants) {
    constants.grid = inputs.extent.grids[row];
    if (!inputs.options.grid) {
      constants.grid.w = 0.0F;
    }
    const Range spots = inputs.contacts[row];
    constants.rows.x = spots.first;
    constants.rows.y = spots.count;
    constants.rows.z = static_cast<std::uint32_t>(inputs.options.heat_map);
  };
  draw_with(commands, inputs.pipelines.body, cover, [&](const Selection& selection) {
    draw_each(commands, inputs, inputs.frame.bodies, inputs.frame.body_groups, selection,
              body_cover, add);
  });
}

void draw_tools(const Commands& commands, const FrameInputs& inputs, Cover cover) {
  if (inputs.frame.tools.empty()) {
    return;
  }
  const SceneBuffers& buffers = inputs.buffers;
  bind_vertices(commands, {*buffers.tool_positions.handle, *buffers.tool_normals.handle,
                           *buffers.tool_paint.handle});
  commands.bindIndexBuffer(*buffers.tool_indices.handle, 0, vk::IndexType::eUint32);
  const auto cover_of = [&](const DrawMaterial& material) {
    return tool_cover(material, inputs.options.tools);
  };
  const auto add = [&](std::uint32_t row, const DrawMaterial& material,
                       shared::DrawConstants& constants) {
    constants.grid = inputs.extent.tool_centers[row];
    constants.color.w = tool_alpha(material, cover);
    constants.rows.w |= inputs.options.grid ? shared::kMarks : 0U;
  };
  draw_with(commands, inputs.pipelines.tool, cover, [&](const Selection& selection) {
    draw_each(commands, inputs, inputs.frame.tools, inputs.frame.tool_groups, selection, cover_of,
              add);
  });
}

/// All that casts a shadow and covers so, into its half of the map.
void draw_shadows(const Commands& commands, const FrameInputs& inputs, Cover cover) {
  const bool cut_out = cover == Cover::kCutOut;
  bind(commands, cut_out ? inputs.pipelines.cut_out_shadow : inputs.pipelines.shadow);
  const auto draw = [&](const auto& things, const auto& groups, const auto& cover_of,
                        vk::Buffer positions, vk::Buffer paint, vk::Buffer indices) {
    if (things.empty()) {
      return;
    }
    if (cut_out) {
      bind_vertices(commands, {positions, paint});
    } else {
      bind_vertices(commands, {positions});
    }
    commands.bindIndexBuffer(indices, 0, vk::IndexType::eUint32);
    draw_each(commands, inputs, things, groups, {cover, cut_out, {}}, cover_of,
              [](std::uint32_t /*row*/, const DrawMaterial& /*material*/,
                 shared::DrawConstants& /*constants*/) {});
  };
  const SceneBuffers& buffers = inputs.buffers;
  draw(inputs.frame.bodies, inputs.frame.body_groups, body_cover, *buffers.positions.handle,
       *buffers.paint.handle, *buffers.body_indices.handle);
  draw(
      inputs.frame.tools, inputs.frame.tool_groups,
      [&](const DrawMaterial& material) { return tool_cover(material, inputs.options.tools); },
      *buffers.tool_positions.handle, *buffers.tool_paint.handle, *buffers.tool_indices.handle);
}

void draw_arrows(const Commands& commands, const FrameInputs& inputs) {
  if (inputs.arrow_vertices == 0) {
    return;
  }
  bind(commands, inputs.pipelines.arrow);
  const SlotBuffers& slot = inputs.slot;
  bind_vertices(commands, {slot.arrow_positions.handle(), slot.arrow_normals.handle(),
                           slot.arrow_colors.handle()});
  commands.draw(inputs.arrow_vertices, 1, 0, 0);
}

vk::RenderingAttachmentInfo color_attachment(const Frame& target, const Surfaces& surfaces,
                                             const shared::vec4& background) {
  vk::RenderingAttachmentInfo color{
      .imageView = target.view,
      .imageLayout = vk::ImageLayout::eColorAttachmentOptimal,
      .loadOp = vk::AttachmentLoadOp::eClear,
      .storeOp = vk::AttachmentStoreOp::eStore,
      .clearValue = vk::ClearValue(vk::ClearColorValue(
          std::array<float, 4>{background.x, background.y, background.z, background.w})),
  };
  if (*surfaces.color.view) {
    color.imageView = *surfaces.color.view;
    color.resolveMode = vk::ResolveModeFlagBits::eAverage;
    color.resolveImageView = target.view;
    color.resolveImageLayout = vk::ImageLayout::eColorAttachmentOptimal;
    color.storeOp = vk::AttachmentStoreOp::eDontCare;
  }
  return color;
}

vk::RenderingAttachmentInfo depth_attachment(const Image2d& image, vk::AttachmentStoreOp store) {
  return {
      .imageView = *image.view,
      .imageLayout = vk::ImageLayout::eDepthAttachmentOptimal,
      .loadOp = vk::AttachmentLoadOp::eClear,
      .storeOp = store,
      .clearValue = vk::ClearValue(vk::ClearDepthStencilValue{1.0F, 0}),
  };
}

}  // namespace

void record_shadow(const Commands& commands, const FrameInputs& inputs) {
  const Image2d& map = inputs.surfaces.shadow_map;
  sampled_to_shadow_target(commands, *map.handle);
  const vk::RenderingAttachmentInfo depth = depth_attachment(map, vk::AttachmentStoreOp::eStore);
  commands.beginRendering(vk::RenderingInfo{
      .renderArea = {{0, 0}, map.extent}, .layerCount = 1, .pDepthAttachment = &depth});
  push_draw_bindings(commands, inputs, false);
  // What is opaque left, glass right: light.glsl says why.
  const std::uint32_t side = map.extent.height;
  set_view(commands, {{0, 0}, {side, side}});
  draw_shadows(commands, inputs, Cover::kSolid);
  draw_shadows(commands, inputs, Cover::kCutOut);
  set_view(commands, {{static_cast<std::int32_t>(side), 0}, {side, side}});
  draw_shadows(commands, inputs, Cover::kGlass);
  commands.endRendering();
  shadow_target_to_sampled(commands, *map.handle);
}

void record_draw(const Frame& target, const FrameInputs& inputs) {
  const Commands& commands = *target.commands;
  const Surfaces& surfaces = inputs.surfaces;
  to_color_target(commands, target.image);
  if (*surfaces.color.handle) {
    to_color_target(commands, *surfaces.color.handle);
  }
  to_depth_target(commands, *surfaces.depth.handle);
  const vk::RenderingAttachmentInfo color = color_attachment(target, surfaces, inputs.background);
  const vk::RenderingAttachmentInfo depth =
      depth_attachment(surfaces.depth, vk::AttachmentStoreOp::eDontCare);
  commands.beginRendering(vk::RenderingInfo{
      .renderArea = inputs.part,
      .layerCount = 1,
      .colorAttachmentCount = 1,
      .pColorAttachments = &color,
      .pDepthAttachment = &depth,
  });
  set_view(commands, {{0, 0}, target.extent});
  commands.setScissor(0, inputs.part);
  push_draw_bindings(commands, inputs, true);
  for (const Cover cover : {Cover::kSolid, Cover::kCutOut}) {
    draw_bodies(commands, inputs, cover);
    draw_tools(commands, inputs, cover);
  }
  draw_arrows(commands, inputs);
  if (inputs.options.ground) {
    bind(commands, inputs.pipelines.ground);
    commands.draw(6, 1, 0, 0);
  }
  draw_bodies(commands, inputs, Cover::kGlass);
  draw_tools(commands, inputs, Cover::kGlass);
  if (!inputs.overlay_apart) {
    const std::span<const OverlayClip> all = inputs.overlay == nullptr
                                                 ? std::span<const OverlayClip>{}
                                                 : std::span(inputs.overlay->clips);
    draw_overlay(commands, inputs, target.extent, inputs.pipelines.overlay, all);
  }
  commands.endRendering();
}

}  // namespace torsion::engine
