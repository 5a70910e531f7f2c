#include "render/pipelines.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ecs/components.hpp"
#include "ecs/draw_material.hpp"
#include "render/overlay_draw_list.hpp"
#include "shaders/arrow.frag.hpp"
#include "shaders/arrow.vert.hpp"
#include "shaders/body.frag.hpp"
#include "shaders/body.vert.hpp"
#include "shaders/cut_out_shadow.frag.hpp"
#include "shaders/cut_out_shadow.vert.hpp"
#include "shaders/deform.comp.hpp"
#include "shaders/ground.frag.hpp"
#include "shaders/ground.vert.hpp"
#include "shaders/normals.comp.hpp"
#include "shaders/overlay.frag.hpp"
#include "shaders/overlay.vert.hpp"
#include "shaders/shadow.vert.hpp"
#include "shaders/shared.h"
#include "shaders/tool.frag.hpp"
#include "shaders/tool.vert.hpp"

namespace torsion::engine {
namespace {

using Code = std::span<const std::uint32_t>;

vk::raii::ShaderModule make_module(const Gpu& gpu, Code code) {
  return {gpu.device,
          vk::ShaderModuleCreateInfo{.codeSize = code.size_bytes(), .pCode = code.data()}};
}

/// What differs between the graphics pipelines.
struct Recipe {
  Code vertex = {};
  Code fragment = {};  // empty: depth only
  std::span<const vk::VertexInputBindingDescription> bindings = {};
  std::span<const vk::VertexInputAttributeDescription> attributes = {};
  vk::Format color_format = vk::Format::eUndefined;
  vk::Format depth_format = kDepthFormat;
  vk::SampleCountFlagBits samples = vk::SampleCountFlagBits::e1;
  vk::CullModeFlags cull = vk::CullModeFlagBits::eBack;
  bool dynamic_cull = false;  // each draw says it
  bool write_color = true;
  bool write_depth = true;
  bool test_depth = true;
  bool blend = false;  // 3 of the shaders' constants: glass
  bool depth_bias = false;
  // Constants of the shaders.
  bool quick = false;    // 0: the overlay's whole pixels, less work a pixel
  bool cut_out = false;  // 1: pixels of little alpha are left out
  std::uint32_t read_textures = kReadTextures.back();  // 2
};

vk::PipelineColorBlendAttachmentState blend_state(const Recipe& recipe) {
  using Component = vk::ColorComponentFlagBits;
  vk::PipelineColorBlendAttachmentState state{
      .blendEnable = recipe.blend ? VK_TRUE : VK_FALSE,
      .srcColorBlendFactor = vk::BlendFactor::eSrcAlpha,
      .dstColorBlendFactor = vk::BlendFactor::eOneMinusSrcAlpha,
      .colorBlendOp = vk::BlendOp::eAdd,
      .srcAlphaBlendFactor = vk::BlendFactor::eZero,  // the picture stays opaque
      .dstAlphaBlendFactor = vk::BlendFactor::eOne,
      .alphaBlendOp = vk::BlendOp::eAdd,
  };
  if (recipe.write_color) {
    state.colorWriteMask = Component::eR | Component::eG | Component::eB | Component::eA;
  }
  return state;
}

vk::PipelineRasterizationStateCreateInfo rasterization_state(const Recipe& recipe) {
  // The bias keeps a lit surface from shadowing itself: a constant for rounding, and the slope for
  // the half texel that a comparison may lie beside its pixel.
  return {
      .polygonMode = vk::PolygonMode::eFill,
      .cullMode = recipe.cull,
      .frontFace = vk::FrontFace::eCounterClockwise,
      .depthBiasEnable = recipe.depth_bias ? VK_TRUE : VK_FALSE,
      .depthBiasConstantFactor = 2.0F,
      .depthBiasSlopeFactor = 2.5F,
      .lineWidth = 1.0F,
  };
}

vk::raii::Pipeline make_graphics_pipeline(const Gpu& gpu, vk::PipelineLayout layout,
                                          const Recipe& recipe) {
  const vk::raii::ShaderModule vertex = make_module(gpu, recipe.vertex);
  vk::raii::ShaderModule fragment = nullptr;
  const std::array<std::uint32_t, 4> values = {
      recipe.quick ? VK_TRUE : VK_FALSE, recipe.cut_out ? VK_TRUE : VK_FALSE, recipe.read_textures,
      recipe.blend ? VK_TRUE : VK_FALSE};
  constexpr std::uint32_t kSize = sizeof(std::uint32_t);
  constexpr std::array<vk::SpecializationMapEntry, 4> kEntries = {
      {{0, 0, kSize}, {1, kSize, kSize}, {2, 2 * kSize, kSize}, {3, 3 * kSize, kSize}}};
  const vk::SpecializationInfo constants{.mapEntryCount = kEntries.size(),
                                         .pMapEntries = kEntries.data(),
                                         .dataSize = sizeof values,
                                         .pData = values.data()};
  std::vector<vk::PipelineShaderStageCreateInfo> stages = {
      {.stage = vk::ShaderStageFlagBits::eVertex,
       .module = *vertex,
       .pName = "main",
       .pSpecializationInfo = &constants}};
  if (!recipe.fragment.empty()) {
    fragment = make_module(gpu, recipe.fragment);
    stages.push_back({.stage = vk::ShaderStageFlagBits::eFragment,
                      .module = *fragment,
                      .pName = "main",
                      .pSpecializationInfo = &constants});
  }
  const vk::PipelineVertexInputStateCreateInfo input{
      .vertexBindingDescriptionCount = static_cast<std::uint32_t>(recipe.bindings.size()),
      .pVertexBindingDescriptions = recipe.bindings.data(),
      .vertexAttributeDescriptionCount = static_cast<std::uint32_t>(recipe.attributes.size()),
      .pVertexAttributeDescriptions = recipe.attributes.data(),
  };
  const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology =
                                                              vk::PrimitiveTopology::eTriangleList};
  const vk::PipelineViewportStateCreateInfo viewport{.viewportCount = 1, .scissorCount = 1};
  const vk::PipelineRasterizationStateCreateInfo rasterization = rasterization_state(recipe);
  const vk::PipelineMultisampleStateCreateInfo multisample{.rasterizationSamples = recipe.samples};
  const vk::PipelineDepthStencilStateCreateInfo depth{
      .depthTestEnable = recipe.test_depth ? VK_TRUE : VK_FALSE,
      .depthWriteEnable = recipe.write_depth ? VK_TRUE : VK_FALSE,
      .depthCompareOp = vk::CompareOp::eLessOrEqual,
  };
  const bool has_color = recipe.color_format != vk::Format::eUndefined;
  const vk::PipelineColorBlendAttachmentState attachment = blend_state(recipe);
  const vk::PipelineColorBlendStateCreateInfo blend{.attachmentCount = has_color ? 1U : 0U,
                                                    .pAttachments = &attachment};
  constexpr std::array kDynamicStates = {vk::DynamicState::eViewport, vk::DynamicState::eScissor,
                                         vk::DynamicState::eCullMode};
  const vk::PipelineDynamicStateCreateInfo dynamic{
      .dynamicStateCount = recipe.dynamic_cull ? 3U : 2U, .pDynamicStates = kDynamicStates.data()};
  const vk::PipelineRenderingCreateInfo rendering{
      .colorAttachmentCount = has_color ? 1U : 0U,
      .pColorAttachmentFormats = &recipe.color_format,
      .depthAttachmentFormat = recipe.depth_format,
  };
  return {gpu.device, nullptr,
          vk::GraphicsPipelineCreateInfo{
              .pNext = &rendering,
              .stageCount = static_cast<std::uint32_t>(stages.size()),
              .pStages = stages.data(),
              .pVertexInputState = &input,
              .pInputAssemblyState = &assembly,
              .pViewportState = &viewport,
              .pRasterizationState = &rasterization,
              .pMultisampleState = &multisample,
              .pDepthStencilState = &depth,
              .pColorBlendState = &blend,
              .pDynamicState = &dynamic,
              .layout = layout,
          }};
}

/// Specialization constants of the compute shaders, by number; normals.comp has the first only.
struct ComputeConstants {
  vk::Bool32 texels = VK_TRUE;
  std::uint32_t regions = shared::kManyRegions;
};

vk::raii::Pipeline make_compute_pipeline(const Gpu& gpu, vk::PipelineLayout layout, Code code,
                                         const ComputeConstants& constants) {
  const vk::raii::ShaderModule module = make_module(gpu, code);
  const std::array<vk::SpecializationMapEntry, 2> entries = {{
      {0, offsetof(ComputeConstants, texels), sizeof constants.texels},
      {1, offsetof(ComputeConstants, regions), sizeof constants.regions},
  }};
  const vk::SpecializationInfo specialization{.mapEntryCount = entries.size(),
                                              .pMapEntries = entries.data(),
                                              .dataSize = sizeof constants,
                                              .pData = &constants};
  return {gpu.device, nullptr,
          vk::ComputePipelineCreateInfo{
              .stage = {.stage = vk::ShaderStageFlagBits::eCompute,
                        .module = *module,
                        .pName = "main",
                        .pSpecializationInfo = &specialization},
              .layout = layout,
          }};
}

vk::raii::DescriptorSetLayout make_bindings(
    const Gpu& gpu, std::span<const vk::DescriptorSetLayoutBinding> bindings) {
  return {gpu.device, vk::DescriptorSetLayoutCreateInfo{
                          .flags = vk::DescriptorSetLayoutCreateFlagBits::ePushDescriptorKHR,
                          .bindingCount = static_cast<std::uint32_t>(bindings.size()),
                          .pBindings = bindings.data(),
                      }};
}

vk::raii::PipelineLayout make_layout(const Gpu& gpu, const vk::raii::DescriptorSetLayout& bindings,
                                     vk::ShaderStageFlags stages, std::size_t constants) {
  const vk::DescriptorSetLayout set = *bindings;
  const vk::PushConstantRange range{.stageFlags = stages,
                                    .size = static_cast<std::uint32_t>(constants)};
  return {gpu.device, vk::PipelineLayoutCreateInfo{
                          .setLayoutCount = 1,
                          .pSetLayouts = &set,
                          .pushConstantRangeCount = 1,
                          .pPushConstantRanges = &range,
                      }};
}

void make_layouts(const Gpu& gpu, Pipelines& pipelines) {
  using Type = vk::DescriptorType;
  using Stage = vk::ShaderStageFlagBits;
  std::vector<vk::DescriptorSetLayoutBinding> compute;
  for (std::uint32_t binding = 0; binding < kStorageBindings + kTexelBindings; ++binding) {
    const Type type = binding < kStorageBindings ? Type::eStorageBuffer : Type::eUniformTexelBuffer;
    compute.push_back({binding, type, 1, Stage::eCompute});
  }
  pipelines.compute_bindings = make_bindings(gpu, compute);
  pipelines.compute_layout = make_layout(gpu, pipelines.compute_bindings, Stage::eCompute,
                                         sizeof(shared::DeformConstants));

  const std::array<vk::DescriptorSetLayoutBinding, 7> draw = {{
      {draw_binding::kUniforms, Type::eUniformBuffer, 1, Stage::eVertex | Stage::eFragment},
      {draw_binding::kShadowMap, Type::eCombinedImageSampler, 1, Stage::eFragment},
      {draw_binding::kColorMaps, Type::eCombinedImageSampler, 1, Stage::eFragment},
      {draw_binding::kContacts, Type::eStorageBuffer, 1, Stage::eVertex | Stage::eFragment},
      {draw_binding::kGlyphs, Type::eCombinedImageSampler, 1, Stage::eFragment},
      {draw_binding::kStudio, Type::eCombinedImageSampler, 1, Stage::eVertex | Stage::eFragment},
      {draw_binding::kTextures, Type::eCombinedImageSampler, kTextureRoles,
       Stage::eVertex | Stage::eFragment},
  }};
  pipelines.draw_bindings = make_bindings(gpu, draw);
  pipelines.draw_layout =
      make_layout(gpu, pipelines.draw_bindings, Stage::eVertex | Stage::eFragment,
                  sizeof(shared::DrawConstants));
}

/// `count` vertex buffers of one vec4 each: binding i is location i. Perhaps one more with
/// VertexPaint, which has the next two locations.
struct RowInput {
  explicit RowInput(std::uint32_t count, bool paint = false) {
    for (std::uint32_t i = 0; i < count; ++i) {
      bindings.push_back({i, sizeof(shared::vec4), vk::VertexInputRate::eVertex});
      attributes.push_back({i, i, vk::Format::eR32G32B32A32Sfloat, 0});
    }
    if (paint) {
      bindings.push_back({count, sizeof(VertexPaint), vk::VertexInputRate::eVertex});
      attributes.push_back({count, count, vk::Format::eR32G32Sfloat, offsetof(VertexPaint, uv)});
      attributes.push_back(
          {count + 1, count, vk::Format::eR32G32B32Sfloat, offsetof(VertexPaint, color)});
    }
  }
  std::vector<vk::VertexInputBindingDescription> bindings;
  std::vector<vk::VertexInputAttributeDescription> attributes;
};

vk::raii::Pipeline make_overlay_pipeline(const Gpu& gpu, vk::PipelineLayout layout,
                                         vk::Format color_format, vk::Format depth_format,
                                         vk::SampleCountFlagBits samples, bool quick) {
  const std::array<vk::VertexInputBindingDescription, 1> bindings = {
      {{0, sizeof(OverlayVertex), vk::VertexInputRate::eVertex}}};
  const std::array<vk::VertexInputAttributeDescription, 3> attributes = {{
      {0, 0, vk::Format::eR32G32Sfloat, offsetof(OverlayVertex, x)},
      {1, 0, vk::Format::eR32G32Sfloat, offsetof(OverlayVertex, u)},
      {2, 0, vk::Format::eR8G8B8A8Unorm, offsetof(OverlayVertex, rgba)},
  }};
  return make_graphics_pipeline(gpu, layout,
                                {.vertex = k_overlay_vert,
                                 .fragment = k_overlay_frag,
                                 .bindings = bindings,
                                 .attributes = attributes,
                                 .color_format = color_format,
                                 .depth_format = depth_format,
                                 .samples = samples,
                                 .cull = vk::CullModeFlagBits::eNone,
                                 .write_depth = false,
                                 .test_depth = false,
                                 .blend = true,
                                 .quick = quick});
}

/// @param recipe  of what is solid
/// @param glass   some of it may be seen through
SurfacePipelines make_surface_pipelines(const Gpu& gpu, vk::PipelineLayout layout, Recipe recipe,
                                        const SurfaceNeeds& needs, bool glass) {
  SurfacePipelines pipelines;
  recipe.dynamic_cull = true;
  for (std::size_t row = 0; row < kReadTextures.size(); ++row) {
    vk::raii::Pipeline& solid = pipelines.solid.emplace_back(nullptr);
    vk::raii::Pipeline& blended = pipelines.glass.emplace_back(nullptr);
    if (needs.read[row]) {
      recipe.read_textures = kReadTextures[row];
      recipe.blend = false;
      solid = make_graphics_pipeline(gpu, layout, recipe);
      recipe.blend = true;
      blended = glass ? make_graphics_pipeline(gpu, layout, recipe) : nullptr;
    }
  }
  recipe.read_textures = kReadTextures.back();
  recipe.blend = false;
  recipe.cut_out = true;
  pipelines.cut_out = needs.cut_out ? make_graphics_pipeline(gpu, layout, recipe) : nullptr;
  recipe.cut_out = false;
  recipe.fragment = {};
  recipe.write_color = false;
  pipelines.glass_depth = glass ? make_graphics_pipeline(gpu, layout, recipe) : nullptr;
  return pipelines;
}

/// Positions and texture coordinates alone, of vertex buffers as RowInput(1, true) has them.
std::array<vk::VertexInputAttributeDescription, 2> cut_out_attributes() {
  return {{{0, 0, vk::Format::eR32G32B32A32Sfloat, 0},
           {1, 1, vk::Format::eR32G32Sfloat, offsetof(VertexPaint, uv)}}};
}

}  // namespace

vk::raii::Pipeline make_overlay_pipeline(const Gpu& gpu, const Pipelines& pipelines,
                                         vk::Format color_format) {
  return make_overlay_pipeline(gpu, *pipelines.draw_layout, color_format, vk::Format::eUndefined,
                               vk::SampleCountFlagBits::e1, true);
}

std::size_t read_textures_row(std::uint32_t textures) {
  std::size_t row = 0;
  while ((textures & ~kReadTextures[row]) != 0) {
    ++row;
  }
  return row;
}

Pipelines make_pipelines(const Gpu& gpu, vk::Format color_format, vk::SampleCountFlagBits samples,
                         const SurfaceNeeds& needs, bool quick, bool texels) {
  Pipelines pipelines;
  make_layouts(gpu, pipelines);
  ComputeConstants constants{.texels = texels ? VK_TRUE : VK_FALSE};
  for (const std::uint32_t regions :
       {shared::kNoRegion, shared::kOneRegion, shared::kManyRegions}) {
    constants.regions = regions;
    pipelines.deform.push_back(
        make_compute_pipeline(gpu, *pipelines.compute_layout, k_deform_comp, constants));
  }
  pipelines.normals =
      make_compute_pipeline(gpu, *pipelines.compute_layout, k_normals_comp, constants);

  const RowInput positions(1);
  const RowInput tool_rows(2, true);
  const RowInput body_rows(3, true);
  const RowInput arrow_rows(3);
  const vk::PipelineLayout layout = *pipelines.draw_layout;
  pipelines.shadow = make_graphics_pipeline(gpu, layout,
                                            {.vertex = k_shadow_vert,
                                             .bindings = positions.bindings,
                                             .attributes = positions.attributes,
                                             .dynamic_cull = true,
                                             .depth_bias = true});
  const RowInput painted_positions(1, true);
  const auto cut_out = cut_out_attributes();
  pipelines.cut_out_shadow = make_graphics_pipeline(gpu, layout,
                                                    {.vertex = k_cut_out_shadow_vert,
                                                     .fragment = k_cut_out_shadow_frag,
                                                     .bindings = painted_positions.bindings,
                                                     .attributes = cut_out,
                                                     .dynamic_cull = true,
                                                     .depth_bias = true});
  Recipe recipe{.vertex = k_ground_vert,
                .fragment = k_ground_frag,
                .color_format = color_format,
                .samples = samples,
                .quick = quick};
  pipelines.ground = make_graphics_pipeline(gpu, layout, recipe);

  recipe.bindings = body_rows.bindings;
  recipe.attributes = body_rows.attributes;
  recipe.vertex = k_body_vert;
  recipe.fragment = k_body_frag;
  pipelines.body = make_surface_pipelines(gpu, layout, recipe, needs, needs.glass_bodies);
  recipe.bindings = arrow_rows.bindings;
  recipe.attributes = arrow_rows.attributes;
  recipe.vertex = k_arrow_vert;
  recipe.fragment = k_arrow_frag;
  pipelines.arrow = make_graphics_pipeline(gpu, layout, recipe);

  recipe.bindings = tool_rows.bindings;
  recipe.attributes = tool_rows.attributes;
  recipe.vertex = k_tool_vert;
  recipe.fragment = k_tool_frag;
  pipelines.tool = make_surface_pipelines(gpu, layout, recipe, needs, true);

  pipelines.overlay =
      make_overlay_pipeline(gpu, layout, color_format, kDepthFormat, samples, false);
  return pipelines;
}

}  // namespace torsion::engine
