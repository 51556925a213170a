// Nearest neighbour among labelled points: a balanced k-d tree that can leave out points of high label.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace understory {

class NearestPoints {
 public:
  struct Point {
    glm::vec3 position;
    std::uint32_t label;
  };
  struct Hit {
    bool found = false;
    Point point{};
    float squared_distance = 0;
  };

  explicit NearestPoints(std::vector<Point> points);
  /// The nearest point whose label is below `label_limit`.
  Hit nearest(glm::vec3 position, std::uint32_t label_limit = 0xffffffffu) const;

 private:
  void build(std::size_t first, std::size_t last);
  void search(std::size_t first, std::size_t last, glm::vec3 position, std::uint32_t label_limit, Hit& best) const;

  // The middle of every range is its node: what is left of it lies below along `split_axis_`, what is right above.
  std::vector<Point> points_;
  std::vector<std::uint8_t> split_axis_;
  std::vector<std::uint32_t> lowest_label_;  // in the node's range
};

}  // namespace understory
