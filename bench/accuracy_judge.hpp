// One scene seen from four sides, its fragments' truth, and any method's error on them.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/accuracy.hpp"
#include "bench/accuracy_scenes.hpp"
#include "host/frame/runner.hpp"
#include "host/trace/truth.hpp"

namespace understory {

class AccuracyJudge {
 public:
  /// Renders the four sides, picks fragments at random and traces them. The device must outlive the judge.
  AccuracyJudge(Device& device, const AccuracySubject& subject, const AccuracyOptions& options);

  /// By surface. Empty: this build knows no such method. Throws Error for anything else that goes wrong.
  std::map<std::string, ErrorStatistics> errors(const Methods& methods);
  /// Of the best smooth function of distance from a ball's middle and angle between normal and radius, on the plant's
  /// fragments (bench/place_regression.hpp). `ball`: centre and radius, m.
  ErrorStatistics best_of_ball(glm::dvec4 ball) const;
  /// Speed and intervals of the truth on the subject's plant fragments, at 256 rays.
  TruthRow truth_itself() const;
  /// Writes truth | method | difference of the first side into `folder`, named after the scene and `method_name`.
  void write_pictures(const Methods& methods, const std::string& method_name, const std::filesystem::path& folder);

 private:
  struct Side {
    Camera camera;
    double time = 0;
    std::map<std::string, std::vector<std::size_t>> pixels;  // by surface, chosen at random
  };
  Frame render(const Side& side);
  void trace(Side& side, const AccuracyOptions& options);

  struct Points {
    std::vector<glm::vec3> positions, normals;
  };

  std::string name_, setting_;  // of the subject
  World world_;
  FrameRunner runner_;
  std::vector<Side> sides_;
  std::map<std::string, Points> points_;  // by surface, all sides after one another
  std::map<std::string, Truth> truth_;    // likewise
  std::optional<Tracer> tracer_;          // of the last side
  Frame first_truth_;                     // the whole first side, for pictures; empty when none are wanted
};

}  // namespace understory
