// Each choice of methods is opened once on a device of its own (start, memory, programs); then all are timed in turn on
// one device, so that drift of the machine meets all alike, and their pictures are compared.
#include "bench/explain.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "bench/judged_views.hpp"
#include "host/frame/runner.hpp"
#include "sim/vantage.hpp"

namespace understory {
namespace {

/// One entry of `methods` that `none` switches off.
struct Switch {
  const char* term;
  const char* key;
  std::string Methods::*method;
};

constexpr Switch switches[] = {{"crowns on their own leaves and wood", "tree", &Methods::tree},
                               {"grass on its own blades", "grass", &Methods::grass},
                               {"crowns on everything else", "crowns", &Methods::crowns},
                               {"moving occluders on everything else", "occluders", &Methods::occluders},
                               {"the near field", "near", &Methods::near}};

/// What was timed and drawn of one choice of methods.
struct Choice {
  Methods methods;
  std::vector<double> frame_ms, shading_ms;  // one per round and view, in one order for all choices
  std::vector<Plane> visibility;             // per view
};

/// A frame as a camera sees it.
struct View {
  int frame = 0;
  Camera camera;
};

std::vector<View> views_of(const World& world, const std::vector<int>& frames) {
  std::vector<View> views;
  for (const int frame : frames)
    for (const Camera& camera : vantage_cameras(world)) views.push_back({frame, camera});
  return views;
}

Frame render(FrameRunner& runner, World& world, const View& view) {
  world.scene.camera = view.camera;
  return runner.render(view.frame, world.scene.time.at(view.frame));
}

constexpr double mib = 1024.0 * 1024.0;

double milliseconds_after_resolve(const Plan& plan, const Frame& frame) {
  const auto resolve = std::find_if(plan.passes.begin(), plan.passes.end(),
                                    [](const PlannedPass& pass) { return pass.name == "resolve"; });
  double sum = 0;
  for (auto pass = resolve == plan.passes.end() ? resolve : resolve + 1; pass != plan.passes.end(); ++pass) {
    const auto found = frame.pass_ms.find(pass->name);
    if (found != frame.pass_ms.end()) sum += found->second;
  }
  return sum;
}

double milliseconds_of_all(const Frame& frame) {
  double sum = 0;
  for (const auto& [pass, milliseconds] : frame.pass_ms) sum += milliseconds;
  return sum;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Opens a device for this choice alone and draws the first frame.
Footprint open_alone(World& world, const Methods& methods, const std::string& selector, Plan& plan) {
  world.scene.methods = methods;
  Device device(selector);
  const auto started = std::chrono::steady_clock::now();
  FrameRunner runner(device, world);
  runner.render(0, world.scene.time.at(0));
  Footprint footprint;
  footprint.start_s = seconds_since(started);
  footprint.buffers_mib = static_cast<double>(device.buffer_bytes()) / mib;
  footprint.peak_mib = static_cast<double>(device.peak_buffer_bytes()) / mib;
  footprint.programs = device.programs_built();
  footprint.kernels = device.kernels_made().size();
  plan = runner.plan();
  return footprint;
}

/// One round: every view with this choice, after one that touches new buffers for the first time.
void time_round(FrameRunner& runner, World& world, const std::vector<View>& views, bool keep_pictures, Choice& choice) {
  runner.choose(choice.methods);
  render(runner, world, views.front());
  for (const View& view : views) {
    Frame frame = render(runner, world, view);
    choice.frame_ms.push_back(milliseconds_of_all(frame));
    choice.shading_ms.push_back(milliseconds_after_resolve(runner.plan(), frame));
    if (keep_pictures) choice.visibility.push_back(std::move(frame.visibility));
  }
}

/// Both of one size; `covered` holds per view which pixels show a surface.
void compare_pictures(const Choice& with, const Choice& without, const std::vector<std::vector<bool>>& covered,
                      const ExplainOptions& options, TermWorth& worth) {
  std::size_t pixels = 0, changed = 0;
  double squares = 0;
  for (std::size_t view = 0; view < covered.size(); ++view)
    for (std::size_t i = 0; i < covered[view].size(); ++i) {
      if (!covered[view][i]) continue;
      const double difference = std::abs(double(with.visibility[view][i]) - without.visibility[view][i]);
      ++pixels;
      changed += difference > options.visible;
      squares += difference * difference;
      worth.most = std::max(worth.most, difference);
    }
  if (pixels > 0) {
    worth.changed = static_cast<double>(changed) / static_cast<double>(pixels);
    worth.rms = std::sqrt(squares / static_cast<double>(pixels));
  }
  worth.could_go = worth.changed < options.negligible;
}

/// What the choices cost apart, of shading: geometry is drawn alike but for the near field's guard band.
Spread95 cost_of(const Choice& with, const Choice& without, bool same_image) {
  const auto& more = same_image ? with.shading_ms : with.frame_ms;
  const auto& less = same_image ? without.shading_ms : without.frame_ms;
  std::vector<double> differences;
  for (std::size_t i = 0; i < more.size(); ++i) differences.push_back(more[i] - less[i]);
  return spread_of(std::move(differences));
}

std::vector<std::vector<bool>> covered_pixels(FrameRunner& runner, World& world, const std::vector<View>& views) {
  std::vector<std::vector<bool>> covered;
  for (const View& view : views) {
    const Frame frame = render(runner, world, view);
    covered.emplace_back();
    for (const std::uint32_t owner : frame.owner) covered.back().push_back(owner != 0);
  }
  return covered;
}

/// Whether two plans run the same for the same things.
bool same_passes(const Plan& a, const Plan& b) {
  return std::equal(
      a.passes.begin(), a.passes.end(), b.passes.begin(), b.passes.end(),
      [](const auto& one, const auto& other) { return one.name == other.name && one.because == other.because; });
}

/// The choices that each lack one term, beside what they are worth, as far as opening them tells.
std::vector<Choice> open_without_each(World& world, const ExplainOptions& options, Explanation& explanation) {
  const Methods asked = world.scene.methods;
  std::vector<Choice> choices;
  for (const Switch& one : switches) {
    Methods methods = asked;
    methods.*one.method = "none";
    if (same_passes(make_plan(world, methods), explanation.plan)) continue;  // it does nothing here
    TermWorth worth;
    worth.term = one.term;
    worth.key = std::string("methods.") + one.key;
    worth.method = asked.*one.method;
    if (options.progress) options.progress("without " + worth.term);
    Plan plan;
    worth.without = open_alone(world, methods, options.device, plan);
    explanation.terms.push_back(std::move(worth));
    choices.push_back({methods, {}, {}, {}});
  }
  world.scene.methods = asked;
  return choices;
}

void add_times(const Choice& choice, Footprint& footprint) {
  footprint.frame_ms = spread_of(choice.frame_ms);
  footprint.shading_ms = spread_of(choice.shading_ms);
}

}  // namespace

Explanation explain_scene(World world, const ExplainOptions& options) {
  Explanation explanation;
  const auto started = std::chrono::steady_clock::now();
  Device device(options.device);  // the first opens the platform too
  explanation.device = device.info();
  explanation.device_s = seconds_since(started);
  if (options.progress) options.progress("as planned");
  Choice planned = {world.scene.methods, {}, {}, {}};
  explanation.frames = spread_frames(world.scene.time.frames, options.frames);
  explanation.whole = open_alone(world, planned.methods, options.device, explanation.plan);
  std::vector<Choice> choices = open_without_each(world, options, explanation);

  FrameRunner runner(device, world);
  const std::vector<View> views = views_of(world, explanation.frames);
  const auto covered = covered_pixels(runner, world, views);
  for (const auto& view : covered)
    explanation.covered += static_cast<std::size_t>(std::count(view.begin(), view.end(), true));
  for (int round = 0; round < options.rounds; ++round) {
    if (options.progress) options.progress("round " + std::to_string(round + 1) + " of timing");
    time_round(runner, world, views, round == 0, planned);
    for (Choice& choice : choices) time_round(runner, world, views, round == 0, choice);
  }

  add_times(planned, explanation.whole);
  for (std::size_t i = 0; i < choices.size(); ++i) {
    TermWorth& worth = explanation.terms[i];
    add_times(choices[i], worth.without);
    compare_pictures(planned, choices[i], covered, options, worth);
    const bool same_image = planned.methods.near_field.guard == 0 || worth.key != "methods.near";
    worth.cost_ms = cost_of(planned, choices[i], same_image);
    const double shading = explanation.whole.shading_ms.median;
    if (shading > 0) worth.cost_share = worth.cost_ms.median / shading;
  }
  return explanation;
}

}  // namespace understory
