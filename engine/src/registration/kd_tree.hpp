#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "vectors.hpp"

namespace gravure::registration {

struct Neighbour {
  std::ptrdiff_t index = -1;  ///< -1: none within the radius
  double distance2 = 0;
};

/// Nearest points of a cloud. Of equally near ones the lowest index wins; what is not finite has no neighbour.
class KdTree {
 public:
  explicit KdTree(const Vectors& points);  ///< one point or more, all finite; they must outlive the tree
  KdTree(KdTree&&) noexcept;
  KdTree& operator=(KdTree&&) noexcept;
  ~KdTree();

  /// Within and on the radius.
  Neighbour nearest(const Eigen::Vector3d& place, double radius) const;
  /// The nearest `count` or fewer, nearest first.
  void nearest(const Eigen::Vector3d& place, double radius, std::size_t count, std::vector<Neighbour>& found) const;
  /// All within the radius, appended in no order.
  void within(const Eigen::Vector3d& place, double radius, std::vector<std::size_t>& found) const;

 private:
  struct Index;
  std::unique_ptr<Index> index_;
};

}  // namespace gravure::registration
