#include "identify/solve/motion_cuts.hpp"

#include <algorithm>

namespace jointid::identify {

namespace {

/// The first windows of the pieces in which the joint moves in one direction for at least half a
/// length. Motion that turns back sooner joins them.
std::vector<Eigen::Index> reversals(const MovingWindows& w, Eigen::Index first, Eigen::Index last,
                                    double length) {
  std::vector<Eigen::Index> found{first};
  double before = 0.0;
  for (Eigen::Index i = first; i < last; ++i) {
    const double travel = w.travel[i];
    if (travel == 0.0) continue;
    const bool turned = (before > 0.0 && travel < 0.0) || (before < 0.0 && travel > 0.0);
    before = travel;
    if (turned && w.start[i] - w.start[found.back()] >= 0.5 * length) found.push_back(i);
  }
  if (found.size() > 1 && w.stop[last - 1] - w.start[found.back()] < 0.5 * length) found.pop_back();
  found.push_back(last);
  return found;
}

}  // namespace

std::vector<std::int64_t> motion_cuts(const MovingWindows& w, Eigen::Index first, Eigen::Index last,
                                      double length) {
  std::vector<std::int64_t> cuts;
  const auto turns = reversals(w, first, last, length);
  std::vector<double> moved;
  for (std::size_t k = 0; k + 1 < turns.size(); ++k) {
    // In time of motion: standing still was left out and does not count.
    moved.clear();
    double sum = 0.0;
    for (Eigen::Index i = turns[k]; i < turns[k + 1]; ++i) {
      sum += w.stop[i] - w.start[i];
      moved.push_back(sum);
    }
    const auto pieces = std::max<std::int64_t>(1, static_cast<std::int64_t>(sum / length + 0.5));
    std::int64_t before = turns[k];
    for (std::int64_t piece = 1; piece < pieces; ++piece) {
      const double until = sum * static_cast<double>(piece) / static_cast<double>(pieces);
      const auto reached = std::lower_bound(moved.begin(), moved.end(), until) - moved.begin();
      const std::int64_t cut = turns[k] + 1 + reached;
      if (cut >= turns[k + 1] || cut == before) continue;
      cuts.push_back(cut);
      before = cut;
    }
    cuts.push_back(turns[k + 1]);
  }
  return cuts;
}

}  // namespace jointid::identify
