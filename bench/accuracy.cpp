// Subject by subject: build it, trace it once, judge every method on the same fragments.
#include "bench/accuracy.hpp"

#include <unistd.h>

#include <algorithm>
#include <set>

#include "bench/accuracy_judge.hpp"
#include "bench/accuracy_scenes.hpp"

namespace understory {
namespace {

/// A folder of its own that goes with it.
class Scratch {
 public:
  Scratch() : path_(std::filesystem::temp_directory_path() / ("understory_accuracy_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void keep_filtered(AccuracySubject& subject, const std::string& filter) {
  const std::string place = subject.name + "/" + subject.setting + "/";
  const auto is_out = [&](const std::string& name) { return (place + name).find(filter) == std::string::npos; };
  std::erase_if(subject.methods, [&](const AccuracyMethod& method) { return is_out(method.name); });
  subject.truth_itself = subject.truth_itself && !is_out("truth");
}

void trace_canopies(const AccuracyOptions& options, AccuracyReport& report) {
  for (const double leaf_area_index : {0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) {
    const std::string name = "canopy/LAI " + std::to_string(leaf_area_index).substr(0, 3) + "/truth";
    if (name.find(options.filter) == std::string::npos) continue;
    if (options.progress) options.progress(name);
    report.canopies.push_back(trace_canopy(leaf_area_index, 8, options.rays));
  }
}

void judge_subject(Device& device, const AccuracySubject& subject, const AccuracyOptions& options,
                   std::set<std::string>& unknown, AccuracyReport& report) {
  AccuracyJudge judge(device, subject, options);
  if (subject.truth_itself) report.truth.push_back(judge.truth_itself());
  if (subject.ball.w > 0)
    report.rows.push_back(
        {subject.name, subject.setting, "plant", "any function of place", judge.best_of_ball(subject.ball)});
  for (const AccuracyMethod& method : subject.methods) {
    if (unknown.contains(method.name)) continue;
    const auto errors = judge.errors(method.methods);
    if (errors.empty()) unknown.insert(method.name);
    for (const auto& [surface, statistics] : errors)
      report.rows.push_back({subject.name, subject.setting, surface, method.name, statistics});
    if (!options.pictures.empty() && !errors.empty())
      judge.write_pictures(method.methods, method.name, options.pictures);
  }
}

}  // namespace

AccuracyReport measure_accuracy(const AccuracyOptions& options) {
  const Scratch scratch;
  std::vector<AccuracySubject> subjects = accuracy_subjects(options.data, scratch.path());
  for (AccuracySubject& subject : subjects) keep_filtered(subject, options.filter);
  std::erase_if(subjects,
                [](const AccuracySubject& subject) { return subject.methods.empty() && !subject.truth_itself; });
  Device device(options.device);
  AccuracyReport report;
  report.device = device.info().name;
  report.rays = options.rays;
  report.fragments = options.fragments;
  std::set<std::string> unknown;
  for (const AccuracySubject& subject : subjects) {
    if (options.progress) options.progress(subject.name + "/" + subject.setting);
    judge_subject(device, subject, options, unknown, report);
  }
  trace_canopies(options, report);
  report.unknown.assign(unknown.begin(), unknown.end());
  return report;
}

}  // namespace understory
