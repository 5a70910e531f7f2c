#include "render/renderer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "render/arrows.hpp"
#include "render/barriers.hpp"
#include "render/frame_view.hpp"
#include "render/material_textures.hpp"
#include "render/offscreen_target.hpp"
#include "render/passes.hpp"
#include "render/pipelines.hpp"
#include "render/scene_buffers.hpp"
#include "render/surfaces.hpp"
#include "render/window_target.hpp"

namespace torsion::engine {
namespace {

constexpr std::uint32_t kSlots = Renderer::kFramesInFlight;
constexpr std::uint32_t kTimestamps = 9;  // one before and after each pass of PassTimes
constexpr std::uint32_t kLargestSide =
    16384;  // pixels: what every Vulkan 1.3 desktop driver allows

Error described(const vk::SystemError& error, const char* doing) {
  return Error{std::string("Vulkan failed while ") + doing + ": " + error.what() + "."};
}

std::optional<Error> check(const RendererOptions& options) {
  const auto bad_side = [](std::uint32_t side) {
    return side < 1 || side > kLargestSide;
  };
  if (bad_side(options.width) || bad_side(options.height)) {
    return Error{"The picture's size is " + std::to_string(options.width) + "x" +
                 std::to_string(options.height) + " pixels; each side must be 1 to " +
                 std::to_string(kLargestSide) + "."};
  }
  if (options.samples != 0 && options.samples != 1 && options.samples != 4) {
    return Error{"The number of samples a pixel is " + std::to_string(options.samples) +
                 "; it must be 1 or 4, or 0 to choose."};
  }
  if (options.shadow_size < 1 || options.shadow_size > kLargestSide / 2) {
    return Error{"The shadow map's side is " + std::to_string(options.shadow_size) +
                 " texels; it must be 1 to " + std::to_string(kLargestSide / 2) + "."};
  }
  return std::nullopt;
}

/// By the materials of a scene.
SurfaceNeeds needs_of(const FrameWorld& frame, const MaterialTextures& textures) {
  SurfaceNeeds needs;
  for (std::uint32_t row = 0; row < frame.materials.size(); ++row) {
    const AlphaMode mode = frame.materials[row].alpha_mode;
    needs.read[read_textures_row(textures.bits(row))] = true;
    needs.cut_out = needs.cut_out || mode == AlphaMode::kMask;
    needs.glass_bodies = needs.glass_bodies || mode == AlphaMode::kBlend;
  }
  return needs;
}

}  // namespace

/// Members are in the order of creation.
struct Renderer::Impl {
  Gpu gpu;
  SceneExtent extent;
  SceneBuffers buffers;
  Surfaces surfaces;
  MaterialTextures textures;
  Pipelines pipelines;
  std::vector<vk::raii::QueryPool> timestamps;  // one for each slot
  vk::raii::Pipeline window_overlay = nullptr;
  std::optional<OffscreenTarget> pictures;  // one of these two is there
  std::optional<WindowTarget> window;

  vk::SampleCountFlagBits samples = vk::SampleCountFlagBits::e1;
  std::uint64_t drawn = 0;  // frames so far
  bool redraw_panels = true;
  ArrowMesh arrows;
  std::vector<shared::ContactSpot> contacts;
  std::vector<Range> contact_ranges;
  ArrowLimits drawn_limits;  // of all pictures so far

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  Impl(Impl&&) = delete;
  Impl& operator=(Impl&&) = delete;
  ~Impl() {
    if (*gpu.device) {
      // Not by the member function, which throws; a lost device has nothing left to wait for.
      gpu.device.getDispatcher()->vkDeviceWaitIdle(static_cast<VkDevice>(*gpu.device));
    }
  }

  [[nodiscard]] ArrowScale arrow_scale(const FrameWorld& frame, const Snapshot& snapshot,
                                       const Camera& camera, const DrawOptions& options);
  void write_arrows(const FrameWorld& frame, const Snapshot& snapshot, const Camera& camera,
                    const DrawOptions& options, SlotBuffers& slot);
  void write_overlay(const OverlayDrawList* overlay, SlotBuffers& slot) const;
  void record_window_overlay(const Frame& frame, const FrameInputs& inputs);
  void record(const Frame& frame, const FrameInputs& inputs, SlotBuffers& slot);
  void draw(const Frame& target, const FrameWorld& frame, const Snapshot& snapshot,
            const Camera& camera, const DrawOptions& draw_options, const OverlayDrawList* overlay);
  [[nodiscard]] Target& target();
  [[nodiscard]] std::vector<glm::vec4> read_rows(const Buffer& buffer) const;
};

Target& Renderer::Impl::target() {
  return pictures ? static_cast<Target&>(*pictures) : static_cast<Target&>(*window);
}

ArrowScale Renderer::Impl::arrow_scale(const FrameWorld& frame, const Snapshot& snapshot,
                                       const Camera& camera, const DrawOptions& options) {
  widen(drawn_limits, snapshot.tools, snapshot.regions);
  const auto scale_or = [](double wanted, double largest) {
    const double scale = wanted > 0.0 ? wanted : largest;
    return scale > 0.0 ? scale : 1.0;
  };
  const glm::dvec3 side = extent.highest - extent.lowest;
  return {kFullArrow * std::max({side.x, side.y, side.z}),
          scale_or(options.full_force, drawn_limits.force),
          scale_or(options.full_torque, drawn_limits.torque),
          camera.pose.position,
          extent.arc_radii,
          options.torque_parts,
          scale_or(options.full_couple, drawn_limits.couple),
          frame.bodies.column<Pose>()};
}

void Renderer::Impl::write_arrows(const FrameWorld& frame, const Snapshot& snapshot,
                                  const Camera& camera, const DrawOptions& options,
                                  SlotBuffers& slot) {
  arrows.clear();
  if (options.arrows) {
    append_wrenches(snapshot, arrow_scale(frame, snapshot, camera, options), arrows);
  }
  const auto write = [&](FrameBuffer& buffer, const std::vector<glm::vec4>& rows) {
    const auto bytes = std::as_bytes(std::span(rows));
    buffer.reserve(gpu, bytes.size());
    buffer.write(0, bytes);
  };
  write(slot.arrow_positions, arrows.positions);
  write(slot.arrow_normals, arrows.normals);
  write(slot.arrow_colors, arrows.colors);
}

void Renderer::Impl::write_overlay(const OverlayDrawList* overlay, SlotBuffers& slot) const {
  if (overlay == nullptr) {
    return;
  }
  const auto vertices = std::as_bytes(std::span(overlay->vertices));
  const auto indices = std::as_bytes(std::span(overlay->indices));
  slot.overlay_vertices.reserve(gpu, vertices.size());
  slot.overlay_vertices.write(0, vertices);
  slot.overlay_indices.reserve(gpu, indices.size());
  slot.overlay_indices.write(0, indices);
}

/// Marks over the scene; over them panels, which are drawn anew only where that is wanted.
void Renderer::Impl::record_window_overlay(const Frame& frame, const FrameInputs& inputs) {
  const vk::Extent2D outer = window->window_extent();
  record_overlay(*frame.commands, window->window_view(), outer, window_overlay, inputs,
                 OverlayPart::kMarks);
  if (redraw_panels) {
    window->begin_panels(frame);
    record_overlay(*frame.commands, window->panels_view(), outer, window_overlay, inputs,
                   OverlayPart::kPanels);
    window->end_panels(frame);
  }
  window->place_panels(frame);
}

void Renderer::Impl::record(const Frame& frame, const FrameInputs& inputs, SlotBuffers& slot) {
  const vk::raii::CommandBuffer& commands = *frame.commands;
  const vk::QueryPool queries = *timestamps[frame.slot];
  commands.resetQueryPool(queries, 0, kTimestamps);
  std::uint32_t query = 0;
  const auto stamp = [&] {
    commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, queries, query++);
  };
  stamp();
  record_uploads(commands, slot);
  stamp();
  record_deform(commands, inputs);
  stamp();
  record_normals(commands, inputs);
  stamp();
  record_shadow(commands, inputs);
  stamp();
  record_draw(frame, inputs);
  stamp();
  if (window) {
    window->stretch(frame);
  }
  stamp();
  if (window) {
    record_window_overlay(frame, inputs);
  }
  stamp();
  target().finish(frame);
  stamp();
}

void Renderer::Impl::draw(const Frame& target, const FrameWorld& frame, const Snapshot& snapshot,
                          const Camera& camera, const DrawOptions& draw_options,
                          const OverlayDrawList* overlay) {
  SlotBuffers& slot = buffers.slots[target.slot];
  write_columns(frame, slot);
  const double aspect = static_cast<double>(target.extent.width) / target.extent.height;
  const shared::FrameUniforms uniforms =
      frame_uniforms(extent, camera, aspect, surfaces.shadow_map.extent.height, draw_options);
  slot.uniforms.write(0, std::as_bytes(std::span(&uniforms, 1)));
  contact_spots(snapshot, frame.bodies.size(), contacts, contact_ranges);
  slot.contacts.write(0, std::as_bytes(std::span(contacts)));
  write_arrows(frame, snapshot, camera, draw_options, slot);
  write_overlay(overlay, slot);
  const vk::Rect2D part = window ? window->visible() : vk::Rect2D{{0, 0}, target.extent};
  record(target,
         {gpu, pipelines, buffers, surfaces, textures, extent, frame, draw_options, slot,
          uniforms.background, contact_ranges, static_cast<std::uint32_t>(arrows.positions.size()),
          overlay, window.has_value(), part},
         slot);
  this->target().submit(target);
  ++drawn;
}

std::vector<glm::vec4> Renderer::Impl::read_rows(const Buffer& buffer) const {
  gpu.device.waitIdle();
  const Buffer read_back =
      make_buffer(gpu, buffer.size, vk::BufferUsageFlagBits::eTransferDst, Home::kReadBack);
  run_once(gpu, [&](const vk::raii::CommandBuffer& commands) {
    compute_to_copy(commands);
    commands.copyBuffer(*buffer.handle, *read_back.handle, vk::BufferCopy{.size = buffer.size});
    copy_to_host(commands);
  });
  std::vector<glm::vec4> rows(buffer.size / sizeof(glm::vec4));
  std::memcpy(rows.data(), read_back.mapped, rows.size() * sizeof(glm::vec4));
  return rows;
}

Renderer::Renderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Result<Renderer> Renderer::create(const RendererOptions& options, const FrameWorld& frame) try {
  if (const auto error = check(options)) {
    return *error;
  }
  Result<Gpu> gpu =
      open_gpu({options.validation, options.force_staging, options.device_name,
                options.window == nullptr ? std::vector<std::string>{} : surface_extensions(),
                options.most_texels});
  if (!gpu) {
    return gpu.error();
  }
  auto impl = std::make_unique<Impl>();
  impl->gpu = std::move(gpu).value();
  impl->extent = scene_extent(frame);
  Result<SceneBuffers> buffers = make_scene_buffers(impl->gpu, frame, kSlots);
  if (!buffers) {
    return buffers.error();
  }
  impl->buffers = std::move(buffers).value();
  const bool on_processor =
      impl->gpu.physical.getProperties().deviceType == vk::PhysicalDeviceType::eCpu;
  impl->samples = options.samples == 4 || (options.samples == 0 && !on_processor)
                      ? vk::SampleCountFlagBits::e4
                      : vk::SampleCountFlagBits::e1;
  impl->surfaces = make_surfaces(impl->gpu, options.shadow_size, options.overlay_atlas);
  impl->textures = make_material_textures(impl->gpu, frame.materials);
  if (options.window != nullptr) {
    impl->window.emplace(impl->gpu, *options.window, kSlots);
  } else {
    const vk::Extent2D size{options.width, options.height};
    impl->pictures.emplace(impl->gpu, size, kSlots);
    fit_surfaces(impl->gpu, size, impl->pictures->format(), impl->samples, impl->surfaces);
  }
  impl->pipelines = make_pipelines(
      impl->gpu, impl->target().format(), impl->samples, needs_of(frame, impl->textures),
      options.quick.value_or(impl->window.has_value() && on_processor), impl->buffers.has_texels);
  if (impl->window) {
    impl->window_overlay =
        make_overlay_pipeline(impl->gpu, impl->pipelines, impl->window->window_format());
  }
  for (std::uint32_t slot = 0; slot < kSlots; ++slot) {
    impl->timestamps.emplace_back(
        impl->gpu.device,
        vk::QueryPoolCreateInfo{.queryType = vk::QueryType::eTimestamp, .queryCount = kTimestamps});
  }
  impl->contacts.reserve(std::size_t{frame.bodies.size()} * kMaxRegionsPerBody);
  impl->contact_ranges.reserve(frame.bodies.size());
  return Renderer(std::move(impl));
} catch (const vk::SystemError& error) {
  return described(error, "it was set up");
} catch (const vk::LogicError& error) {
  return Error{std::string("Vulkan is not installed (package libvulkan1): ") + error.what() + "."};
}

Result<std::uint64_t> Renderer::draw(const FrameWorld& frame, const Snapshot& snapshot,
                                     const Camera& camera, const DrawOptions& options,
                                     const OverlayDrawList* overlay) try {
  Impl& impl = *impl_;
  if (const auto error = check_columns(impl.gpu, frame)) {
    return *error;
  }
  TORSION_ASSERT(impl.pictures.has_value());
  impl.draw(impl.pictures->begin(), frame, snapshot, camera, options, overlay);
  return impl.drawn - 1;
} catch (const vk::SystemError& error) {
  return described(error, "a picture was drawn");
}

Result<bool> Renderer::show(const FrameWorld& frame, const Snapshot& snapshot, const Camera& camera,
                            const DrawOptions& options, const OverlayDrawList* overlay,
                            const Showing& showing) try {
  Impl& impl = *impl_;
  TORSION_ASSERT(impl.window.has_value());
  if (const auto error = check_columns(impl.gpu, frame)) {
    return *error;
  }
  const vk::Extent2D before = impl.window->extent();
  if (!impl.window->fit(showing.width, showing.height, showing.share)) {
    return false;
  }
  if (impl.window->extent() != before) {
    fit_surfaces(impl.gpu, impl.window->extent(), impl.window->format(), impl.samples,
                 impl.surfaces);
  }
  const Frame target = impl.window->begin();
  if (target.commands == nullptr) {
    return false;
  }
  if (showing.keep) {
    impl.window->keep_next();
  }
  impl.redraw_panels = showing.redraw_panels || !impl.window->has_panels();
  if (impl.redraw_panels) {
    impl.window->set_panels(overlay == nullptr ? std::span<const OverlayPanel>{} : overlay->panels);
  }
  impl.draw(target, frame, snapshot, camera, options, overlay);
  return true;
} catch (const vk::SystemError& error) {
  return described(error, "a window was drawn");
}

Result<Image> Renderer::screenshot() try {
  TORSION_ASSERT(impl_->window.has_value());
  return impl_->window->screenshot();
} catch (const vk::SystemError& error) {
  return described(error, "a picture was read back");
}

Result<Image> Renderer::read_pixels(std::uint64_t number) try {
  TORSION_ASSERT(number < impl_->drawn && number + kSlots >= impl_->drawn);
  const std::span<const std::byte> pixels =
      impl_->pictures->pixels(static_cast<std::uint32_t>(number % kSlots));
  const vk::Extent2D size = impl_->pictures->extent();
  Image image{size.width, size.height, std::vector<std::uint8_t>(pixels.size())};
  std::memcpy(image.rgba.data(), pixels.data(), pixels.size());
  return image;
} catch (const vk::SystemError& error) {
  return described(error, "a picture was read back");
}

Result<PassTimes> Renderer::pass_times(std::uint64_t number) try {
  TORSION_ASSERT(number < impl_->drawn && number + kSlots >= impl_->drawn);
  const auto slot = static_cast<std::uint32_t>(number % kSlots);
  impl_->pictures ? impl_->pictures->wait(slot) : impl_->window->wait(slot);
  const auto [result, ticks] = impl_->timestamps[slot].getResults<std::uint64_t>(
      0, kTimestamps, kTimestamps * sizeof(std::uint64_t), sizeof(std::uint64_t),
      vk::QueryResultFlagBits::e64);
  const auto between = [&, &counts = ticks](std::uint32_t pass) {
    return static_cast<double>(counts[pass + 1] - counts[pass]) * impl_->gpu.milliseconds_per_tick;
  };
  return PassTimes{between(0), between(1), between(2), between(3),
                   between(4), between(5), between(6), between(7)};
} catch (const vk::SystemError& error) {
  return described(error, "times were read");
}

Result<std::vector<glm::vec4>> Renderer::read_positions() try {
  return impl_->read_rows(impl_->buffers.positions);
} catch (const vk::SystemError& error) {
  return described(error, "positions were read back");
}

Result<std::vector<glm::vec4>> Renderer::read_normals() try {
  return impl_->read_rows(impl_->buffers.normals);
} catch (const vk::SystemError& error) {
  return described(error, "normals were read back");
}

std::uint64_t Renderer::pictures() const {
  return impl_->drawn;
}

const std::string& Renderer::device_name() const {
  return impl_->gpu.name;
}

}  // namespace torsion::engine
