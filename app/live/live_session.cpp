#include "app/live/live_session.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <glm/geometric.hpp>

#include "device/scripted_motion.hpp"
#include "ecs/assert.hpp"
#include "ecs/hash.hpp"
#include "systems/hold/virtual_coupling.hpp"
#include "systems/surface/surface_field.hpp"

namespace torsion::engine {
namespace {

// A ball of radius r pressed a quarter of r deep into a half-space takes 4/3 E* r^2 0.25^(3/2) =
// 0.17 E* r^2 (Hertz), with a stiffness of 2 E* r 0.25^(1/2) = E* r: the largest force is that one,
// which is as deep as scenes go, and the coupling is half as stiff as the contact, so that the
// hand's shaking does not show.
constexpr double kForceShare = 0.17;     // of E* r^2
constexpr double kStiffnessShare = 0.5;  // of E* r
// The friction's torque at that depth, 3 pi / 16 mu F a with a = r / 2, is 0.05 mu E* r^3. The hand
// has half as much more, so that it turns what it presses with all its force.
constexpr double kTorqueShare = 0.075;    // of mu E* r^3
constexpr double kTurnStiffShare = 0.1;   // of E* r^3: 0.6 rad at the largest torque of mu = 0.75
constexpr double kLargestFriction = 3.0;  // of a body that a hand is to overcome

/// m: of a ball with the tool's bounds, whose diagonal is 1.75 of its diameter
double tool_radius(const Model& model, std::uint32_t tool) {
  const Bounds& bounds = model.tools.at<Bounds>(tool);
  return 0.5 * glm::length(bounds.highest - bounds.lowest) / 1.75;
}

/// Whether one input can come after another in a run: of a step, the poses of tools come last.
bool goes_on(const InputEntry& last, const InputEntry& next) {
  return next.step > last.step ||
         (next.step == last.step && (last.kind != InputKind::kPose ||
                                     (next.kind == InputKind::kPose && next.index > last.index)));
}

}  // namespace

VirtualCoupling mouse_coupling(const SceneDescription& scene, double radius, double strength) {
  double modulus = 0.0;
  double friction = 0.0;
  for (const BodyDescription& body : scene.bodies) {
    modulus = std::max(modulus, body.elasticity.contact_modulus());
    friction = std::max(friction, body.friction.static_friction);
  }
  friction = std::min(friction, kLargestFriction);
  const double er = modulus * radius;
  const double deepest = kForceShare * er * radius;
  const double share = deepest > 0.0 ? std::min(strength / deepest, 1.0) : 1.0;
  // The torque goes by force and contact radius, which goes by the force's third root.
  const double torque_share = share * std::cbrt(share);
  return {share * kStiffnessShare * er,
          0.0,
          torque_share * kTurnStiffShare * er * radius * radius,
          0.0,
          share * deepest,
          torque_share * kTorqueShare * friction * er * radius * radius};
}

LiveSession::LiveSession(Session session, PrepareOptions options, std::filesystem::path record)
    : session_(std::move(session)), options_(std::move(options)), record_(std::move(record)) {
  begin_recording_of(begin_recording(session_, options_));
  auto first = std::make_unique<Generation>();
  first->simulation = std::move(session_.simulation);
  first->picks = picks_of(session_.scene, options_);
  first->frame =
      prepare_frame(session_.scene, first->simulation.world.model, first->simulation.world.state);
  generations_.push_back(std::move(first));
  const World& world = generations_.front()->simulation.world;
  loop_.wants_rows = true;
  loop_.wants_pictures = true;
  loop_.wants_inputs = true;
  reserve(loop_, session_, generations_.front()->simulation);
  for (std::uint32_t tool = 0; tool < world.model.tools.size(); ++tool) {
    slots_.push_back(std::make_unique<HandleSlot>());
    couplings_.push_back(
        mouse_coupling(session_.scene, tool_radius(world.model, tool), kGentleForce));
    loop_.tools[tool].slot = slots_.back().get();
    loop_.tools[tool].coupling = couplings_.back();
    loop_.tools[tool].smoothing.on = true;
  }
  samples_.resize(world.model.tools.size(), 0);
  held_.resize(world.model.tools.size(), 0);
}

LiveSession::~LiveSession() {
  loop_.stop.store(true, std::memory_order_release);
  if (physics_.joinable()) {
    physics_.join();
  }
  if (worker_.joinable()) {
    worker_.join();
  }
}

void LiveSession::give(SceneDevice device) {
  device_ = std::move(device);
  if (device_.link == nullptr) {
    return;
  }
  LiveTool& tool = loop_.tools[device_.tool];
  tool.slot = &device_.link->slot();
  tool.from = PoseFrom::kHandle;
  tool.at_start = PoseFrom::kHandle;
  device_view_ = &device_.link->view();
  carry_.stiffness = couplings_[device_.tool].stiffness;
  carry_.largest_force = couplings_[device_.tool].largest_force;
  device_.link->carry(carry_);
}

bool LiveSession::carries(std::uint32_t tool) const {
  return on_device(tool) && device_view_->sample.state == DeviceState::kLive &&
         (device_view_->sample.sensed & kTranslationAxes) == 0;
}

void LiveSession::carry(std::uint32_t tool, const glm::dvec3& by) {
  TORSION_ASSERT(carries(tool));
  carry_.moved += by;
  device_.link->carry(carry_);
}

void LiveSession::hold_by(ToolHold way) {
  way_ = way;
  for (LiveTool& tool : loop_.tools) {
    tool.hold = way;
  }
}

void LiveSession::start(bool privileges) {
  loop_.wants_privileges = privileges;
  physics_ = std::thread(run_live, std::ref(loop_));
  while (!loop_.ready.load(std::memory_order_acquire)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

void LiveSession::begin_recording_of(const Recording& head) {
  recording_.reset();  // before the next one needs its place
  recording_problem_.clear();
  recorded_steps_ = 0;
  Result<RecordingWriter> made = record_.empty() ? RecordingWriter::create_unnamed(head)
                                                 : RecordingWriter::create(record_, head);
  if (made) {
    recording_ = std::move(made).value();
  } else {
    recording_problem_ = made.error().text;
  }
}

void LiveSession::take_inputs() {
  while (const auto entry = loop_.inputs.pop()) {
    if (recorded_steps_ > 0 && !goes_on(last_entry_, *entry)) {
      begin_recording_of(restarted_);
    }
    last_entry_ = *entry;
    recorded_steps_ = entry->step + 1;
    if (recording_) {
      recording_->add(*entry);
    }
  }
}

double LiveSession::recorded_seconds() const {
  return static_cast<double>(recorded_steps_) / options_.rate;
}

std::string LiveSession::recording_problem() const {
  if (frame().statistics.lost_inputs > 0) {
    return "inputs were lost, and what is recorded cannot be replayed";
  }
  return recording_ ? recording_->problem() : recording_problem_;
}

Result<Done> LiveSession::save_recording(const std::filesystem::path& path) {
  const std::string problem = recording_problem();
  return problem.empty() ? recording_->save_copy(path) : Result<Done>(Error{problem});
}

Result<Done> LiveSession::finish_recording() {
  TORSION_ASSERT(!record_.empty());
  const std::string problem = recording_problem();
  Result<Done> done = problem.empty() ? recording_->finish() : Result<Done>(Error{problem});
  recording_.reset();
  recording_problem_ = done ? "it has ended" : done.error().text;
  return done;
}

bool LiveSession::refresh() {
  take_prepared();
  take_inputs();
  if (device_.link != nullptr) {
    device_view_ = &device_.link->view();
  }
  if (!loop_.frames.refresh()) {
    return false;
  }
  // The physics thread has left every generation before the one it shows.
  while (generations_.front()->number < loop_.frames.front().generation) {
    generations_.erase(generations_.begin());
  }
  return true;
}

void LiveSession::hold(std::uint32_t tool, const Pose& handle) {
  TORSION_ASSERT(!on_device(tool));
  HandleSample& sample = slots_[tool]->sample.back();
  sample.pose = handle;
  sample.number = ++samples_[tool];
  sample.time_ns = monotonic_now();
  slots_[tool]->sample.publish();
  if (held_[tool] == 0) {
    held_[tool] = 1;
    // After the sample: the loop begins there.
    send(
        {LiveCommandKind::kPoseFrom, tool, static_cast<std::uint64_t>(PoseFrom::kHandle), nullptr});
  }
}

Pose LiveSession::take(std::uint32_t tool) {
  TORSION_ASSERT(!on_device(tool));
  const Snapshot& snapshot = frame().snapshot;
  const Pose& now = snapshot.tools.at<ToolPose>(tool).now;
  if (way_ == ToolHold::kDirect) {
    return now;
  }
  Wrench contact = snapshot.tools.at<ToolWrench>(tool).total;
  contact.torque +=
      glm::cross(snapshot.tools.at<ToolMotion>(tool).mass_center - now.position, contact.force);
  couplings_[tool] = strong_enough(own_coupling(tool), contact);
  send({LiveCommandKind::kCoupling, tool, 0, nullptr, couplings_[tool]});
  return balancing_handle(couplings_[tool], now, contact);
}

void LiveSession::release(std::uint32_t tool) {
  if (held_[tool] == 0) {
    return;
  }
  held_[tool] = 0;
  send({LiveCommandKind::kPoseFrom, tool, static_cast<std::uint64_t>(PoseFrom::kScript), nullptr});
}

VirtualCoupling LiveSession::own_coupling(std::uint32_t tool) const {
  const Model& model = shown().simulation.world.model;
  return mouse_coupling(session_.scene, tool_radius(model, tool), strength_);
}

void LiveSession::set_strength(double strength) {
  strength_ = strength;
  for (std::uint32_t tool = 0; tool < couplings_.size(); ++tool) {
    if (!on_device(tool)) {
      couplings_[tool] = own_coupling(tool);
      send({LiveCommandKind::kCoupling, tool, 0, nullptr, couplings_[tool]});
    }
  }
}

bool LiveSession::choose(const std::vector<BodyPick>& picks, bool restart) {
  if (preparing()) {
    return false;
  }
  error_.clear();
  restart_ = restart;
  done_ = false;
  worker_ = std::thread(&LiveSession::prepare_in_background, this, picks);
  return true;
}

void LiveSession::prepare_in_background(std::vector<BodyPick> picks) {
  SceneDescription scene = session_.scene;
  apply_picks(picks, scene);
  PrepareOptions options = options_;
  options.contact_model = ContactModel::kAuto;  // the picks say it
  options.body_model = BodyModel::kAuto;
  options.expected_poses = expected_poses(scene);
  Result<Simulation> made = prepare(scene, options);
  if (made) {
    prepared_ = std::make_unique<Generation>();
    prepared_->simulation = std::move(made).value();
    prepared_->frame =
        prepare_frame(scene, prepared_->simulation.world.model, prepared_->simulation.world.state);
    prepared_->picks = std::move(picks);
    if (restart_) {
      restarted_ =
          recording_head(session_.scene, prepared_->picks, options_, prepared_->simulation.world);
    }
  } else {
    worker_error_ = made.error().text;
  }
  done_.store(true, std::memory_order_release);
}

void LiveSession::take_prepared() {
  if (!worker_.joinable() || !done_.load(std::memory_order_acquire)) {
    return;
  }
  worker_.join();
  error_ = std::move(worker_error_);
  worker_error_.clear();
  if (prepared_ == nullptr) {
    return;
  }
  prepared_->number = next_number_++;
  generations_.push_back(std::move(prepared_));
  send({restart_ ? LiveCommandKind::kRestart : LiveCommandKind::kSwap, 0, 0,
        generations_.back().get()});
  if (restart_) {
    std::ranges::fill(held_, std::uint8_t{0});
  }
}

}  // namespace torsion::engine
