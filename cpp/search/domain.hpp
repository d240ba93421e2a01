#pragma once
// The domain of a search: a box. A parameter with equal bounds is fixed.

#include <Eigen/Core>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace jointid::search {

struct Domain {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;

  [[nodiscard]] Eigen::Index size() const { return lower.size(); }

  void validate() const {
    if (lower.size() != upper.size() || lower.size() == 0) {
      throw std::invalid_argument("domain: lower and upper must have the same, positive length");
    }
    for (Eigen::Index i = 0; i < size(); ++i) {
      if (!std::isfinite(lower[i]) || !std::isfinite(upper[i]) || lower[i] > upper[i]) {
        throw std::invalid_argument("domain: bounds of parameter " + std::to_string(i) +
                                    " must be finite with lower <= upper, got " +
                                    std::to_string(lower[i]) + " and " + std::to_string(upper[i]));
      }
    }
  }

  /// Indices of the free parameters.
  [[nodiscard]] std::vector<Eigen::Index> free() const {
    std::vector<Eigen::Index> indices;
    for (Eigen::Index i = 0; i < size(); ++i) {
      if (lower[i] < upper[i]) indices.push_back(i);
    }
    return indices;
  }
};

}  // namespace jointid::search
