#include "kd_tree.hpp"

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>

#include <limits>

namespace gravure::registration {
namespace {

using Tree = flann::KDTreeSingleIndex<flann::L2_3D<double>>;
constexpr int kLeafPoints = 16;

/// FLANN asks for points nearer than worstDist(): a hair more lets equally near ones through. (std::nextafter() is a
/// call to the library.)
double hair_more(double distance2) {
  constexpr double kHair = 1 + 2 * std::numeric_limits<double>::epsilon();
  return distance2 * kHair + std::numeric_limits<double>::denorm_min();
}

class NearestOne final : public flann::ResultSet<double> {
 public:
  explicit NearestOne(double radius2) : worst_(hair_more(radius2)) { best_.distance2 = radius2; }
  bool full() const override { return true; }
  void addPoint(double distance2, std::size_t index) override {
    const auto candidate = static_cast<std::ptrdiff_t>(index);
    // FLANN asks for worstDist() once a leaf: points further than the best come, too.
    const bool nearer = distance2 < best_.distance2;
    const bool as_near = distance2 <= best_.distance2 && (best_.index < 0 || candidate < best_.index);
    if (nearer || as_near) {
      best_ = {candidate, distance2};
      worst_ = hair_more(distance2);
    }
  }
  double worstDist() const override { return worst_; }
  const Neighbour& best() const noexcept { return best_; }

 private:
  Neighbour best_;
  double worst_;
};

bool nearer(const Neighbour& a, const Neighbour& b) noexcept {
  return a.distance2 < b.distance2 || (a.distance2 == b.distance2 && a.index < b.index);
}

class NearestFew final : public flann::ResultSet<double> {
 public:
  NearestFew(double radius2, std::size_t count, std::vector<Neighbour>& found)
      : count_(count), found_(found), worst_(hair_more(radius2)) {
    found_.clear();
  }
  bool full() const override { return true; }
  void addPoint(double distance2, std::size_t index) override {
    const Neighbour candidate{static_cast<std::ptrdiff_t>(index), distance2};
    if (found_.size() < count_) {
      found_.push_back(candidate);
    } else if (!nearer(candidate, found_.back())) {
      return;
    }
    std::size_t place = found_.size() - 1;
    for (; place > 0 && nearer(candidate, found_[place - 1]); --place) {
      found_[place] = found_[place - 1];
    }
    found_[place] = candidate;
    if (found_.size() == count_) {
      worst_ = hair_more(found_.back().distance2);
    }
  }
  double worstDist() const override { return worst_; }

 private:
  std::size_t count_;
  std::vector<Neighbour>& found_;
  double worst_;
};

class AllWithin final : public flann::ResultSet<double> {
 public:
  AllWithin(double radius2, std::vector<std::size_t>& found) : found_(found), worst_(hair_more(radius2)) {}
  bool full() const override { return true; }
  void addPoint(double, std::size_t index) override { found_.push_back(index); }
  double worstDist() const override { return worst_; }

 private:
  std::vector<std::size_t>& found_;
  double worst_;
};

}  // namespace

struct KdTree::Index {
  explicit Index(const Vectors& points)
      : tree(flann::Matrix<double>(const_cast<double*>(points.front().data()), points.size(), 3),
             flann::KDTreeSingleIndexParams(kLeafPoints, true)) {
    tree.buildIndex();
  }
  Tree tree;
  flann::SearchParams all{flann::FLANN_CHECKS_UNLIMITED};
};

KdTree::KdTree(const Vectors& points) : index_(std::make_unique<Index>(points)) {}
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;
KdTree::~KdTree() = default;

Neighbour KdTree::nearest(const Eigen::Vector3d& place, double radius) const {
  if (!place.allFinite()) {
    return {};  // FLANN would leave its answer unset
  }
  NearestOne result(radius * radius);
  index_->tree.findNeighbors(result, place.data(), index_->all);
  return result.best();
}

void KdTree::nearest(const Eigen::Vector3d& place, double radius, std::size_t count,
                     std::vector<Neighbour>& found) const {
  NearestFew result(radius * radius, count, found);
  if (place.allFinite()) {
    index_->tree.findNeighbors(result, place.data(), index_->all);
  }
}

void KdTree::within(const Eigen::Vector3d& place, double radius, std::vector<std::size_t>& found) const {
  AllWithin result(radius * radius, found);
  if (place.allFinite()) {
    index_->tree.findNeighbors(result, place.data(), index_->all);
  }
}

}  // namespace gravure::registration
