// What the time and the error of a scene's methods are, and which of them nobody beats in both: `understory tradeoff`.
// A variant is a whole choice of methods and settings; a table holds what was measured of every one that was tried.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/timing.hpp"
#include "sim/world.hpp"

namespace understory {

/// One way to shade the whole scene.
struct Variant {
  Methods methods;
  int shrink = 1;              // images of 1/shrink of the scene's width and height
  bool relaxed_maths = false;  // programs of the visibility passes built with -cl-fast-relaxed-math

  /// "crown-field + grass-height + ...": what differs from nothing at all; unique among variants of one scene.
  std::string name() const;
  /// As `--set` takes them, all that decides the variant: "methods.tree=crown-field", "image.width=400", ... `image`:
  /// the scene's.
  std::vector<std::string> settings(const ImageSize& image) const;
};

/// Pixels of an image of 1/shrink of the width and height; at least 1.
ImageSize shrunk(const ImageSize& image, int shrink);

/// Root mean square error in V against traced truth, the truth's own noise taken out, with the 95 % interval that the
/// scatter of the judged pixels leaves. Truth noise: root mean square standard error of the truth there.
struct RmseInterval {
  std::size_t pixels = 0;
  double rmse = 0, low = 0, high = 0, bias = 0, truth_noise = 0;
};

/// The error in one frame seen by one camera (index in sim/vantage.hpp): the spread between them is the scene's own.
struct ViewError {
  int camera = 0, frame = 0;
  RmseInterval all;
  std::map<std::string, RmseInterval> classes;
};

/// How V changes from a frame to the next, against the truth's change in the same pixel.
struct TemporalError {
  double rmse_dvdt = 0;   // of dV/dt, 1/s, the truth's noise taken out
  double truth_dvdt = 0;  // root mean square of the truth's own dV/dt, 1/s, for comparison
  double flicker = 0;     // largest |change of V - change of truth| between two frames beyond the truth's interval
};

/// One measured variant.
struct TradeoffRow {
  Variant variant;
  std::string name;
  std::vector<std::string> settings;
  bool verified = false;  // finite, in [0, 1], twice the same bytes; otherwise nothing below counts
  std::string failure;    // why not
  /// Device time of a frame's resolve and all visibility passes after it: mean over the views, median and interval over
  /// rounds; the resolve's share is shared with all variants that resolve alike (bench/tradeoff_times.hpp). What comes
  /// before (posing, drawing) does not depend on the methods.
  Spread95 ms;
  Spread95 wall_ms;                              // the same passes on the host's clock
  double frame_ms = 0;                           // ms + drawing: device time of a whole frame
  std::map<std::string, Spread95> pass_ms;       // device time by pass, of those in `ms`
  std::map<std::string, Spread95> pass_wall_ms;  // host's clock by pass, each waited for; with what the host prepares
  double start_s = 0;                            // building programs and uploading tables; a bake not included
  double bake_s = -1;                            // to bake what the methods need, from nothing; -1: not measured
  double mib = 0;                                // device buffers while it runs
  RmseInterval error;
  std::map<std::string, RmseInterval> classes;  // tree, grass, ground, occluder
  std::vector<ViewError> views;
  std::optional<TemporalError> temporal;
  std::optional<double> predicted_ms, predicted_rmse;  // from its terms, measured one by one
  bool pareto = false;
  std::vector<std::string> ties;  // names of rows whose intervals overlap with this one's in time and in error
};

/// A Pareto front that was predicted from terms, and how well.
struct PredictionQuality {
  std::size_t combinations = 0, measured = 0;  // predicted, and measured whole
  double ms_bias = 0, ms_worst = 0;            // mean and largest |.| of predicted / measured - 1
  double rmse_bias = 0, rmse_worst = 0;        // mean and largest |.| of predicted - measured
};

struct TradeoffTable {
  std::string scene, device, identity;  // identity: what the numbers depend on; rows of another are not taken over
  std::vector<int> frames;              // judged
  int cameras = 0, rays = 0;
  std::size_t pixels = 0;         // judged, over all views
  std::map<int, double> draw_ms;  // by Variant::shrink: posing and drawing, median over all variants
  std::vector<TradeoffRow> rows;  // in order of ms
  PredictionQuality prediction;
};

struct TradeoffOptions {
  int frames = 3;                // judged, spread over the scene's; each with the one that follows it
  std::size_t pixels = 2000;     // judged per view, one in each cell of a grid over the image, at random
  int rays = 512;                // per judged pixel
  int rounds = 9;                // timed per view and sweep, at most: TradeoffJudge::time
  int sweeps = 3;                // over the combinations that are measured whole, forwards and backwards
  int combinations = 16;         // of the predicted front that are measured whole, at most
  bool runnable_only = false;    // only what a run may be made with: no half size, no relaxed maths, no pictures
  bool bakes = true;             // measure bake times, which takes the time of the bakes
  std::string identity;          // of scene, build and device, by the caller
  std::filesystem::path folder;  // keeps what has been measured, a file a variant; empty: nothing is kept
  /// Told after each step how many there are in all, as far as is known by then, and what was done; may be empty.
  std::function<void(int steps, const std::string& done)> progress;
  /// Asked between steps; true: returns at once, with what there is. May be empty.
  std::function<bool()> stopped;
};

/// Measures the scene's variants: terms one by one, then the combinations that they predict to be on the front, whole.
/// `world` is calibrated; its camera and image size change while it runs.
TradeoffTable measure_tradeoff(Device& device, World& world, const TradeoffOptions& options);

/// Sets `pareto` and `ties`. A row is off the front when one that is on it is clearly better in one of time and error
/// (their intervals do not overlap) and not clearly worse in the other. Rows that are off beat nobody: with wide
/// intervals they would take with them what is clearly faster than the whole front.
void mark_front(std::vector<TradeoffRow>& rows);

/// tradeoff.json. read: throws Error(invalid_input) naming `where` for text that is no such table.
std::string tradeoff_json(const TradeoffTable& table);
TradeoffTable read_tradeoff(const std::string& text, const std::string& where);
std::string tradeoff_csv(const TradeoffTable& table);
std::string tradeoff_markdown(const TradeoffTable& table);

}  // namespace understory
