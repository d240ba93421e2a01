#pragma once
// Steps of equal effect over a shape's domain.

#include <algorithm>
#include <cmath>

namespace jointid::identify {

/// The Gaussian decay depends on s v^2, so its shape has a square-root scale. Speeds and exponents
/// have a linear scale.
class Scale {
 public:
  Scale(double lower, double upper, bool root)
      : lower_(lower), upper_(upper), root_(root && lower >= 0.0) {}
  [[nodiscard]] bool is_root() const { return root_; }
  [[nodiscard]] double share(double shape) const {
    const auto even = [&](double value) { return root_ ? std::sqrt(value) : value; };
    return (even(shape) - even(lower_)) / (even(upper_) - even(lower_));
  }
  [[nodiscard]] double at(double share) const {
    if (share <= 0.0) return lower_;  // exactly the bounds
    if (share >= 1.0) return upper_;
    if (!root_) return lower_ + share * (upper_ - lower_);
    const double value = std::sqrt(lower_) + share * (std::sqrt(upper_) - std::sqrt(lower_));
    return std::clamp(value * value, lower_, upper_);
  }
  /// Derivative of the shape by the share.
  [[nodiscard]] double slope(double share) const {
    if (!root_) return upper_ - lower_;
    return 2.0 * std::sqrt(at(share)) * (std::sqrt(upper_) - std::sqrt(lower_));
  }

 private:
  double lower_;
  double upper_;
  bool root_;
};

}  // namespace jointid::identify
