#pragma once
// A shape parameter's range on a scale on which the columns change evenly.
//
// A decay exp(-s v^2) changes most where s v^2 is near 1, for any speed. So it is even in log s,
// except where s is too small for every speed. The coordinate is therefore log z, with z affine in
// the shape. The leading bits of z cut the range into pieces, so a shape's piece is found without a
// logarithm.

#include <bit>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "base/elementary.hpp"

namespace jointid::identify {

class ShapeAxis {
 public:
  /// z = shift + rate * shape, positive over [lower, upper]; 2^bits pieces per octave of z.
  ShapeAxis(double lower, double upper, double shift, double rate, int bits)
      : lower_(lower), upper_(upper), shift_(shift), rate_(rate), drop_(52 - bits) {
    if (!(z(lower) > 0.0) || !(lower <= upper)) {
      throw std::invalid_argument("shape axis: needs a positive scale over its range, got " +
                                  std::to_string(z(lower)));
    }
    first_ = leading(z(lower));
    pieces_ = leading(z(upper)) - first_ + 1;
    left_ = edge(0);
    length_ = base::log(edge(pieces_) / left_);
  }

  [[nodiscard]] double lower() const { return lower_; }
  [[nodiscard]] double upper() const { return upper_; }
  [[nodiscard]] std::int64_t pieces() const { return pieces_; }
  /// Length of all pieces on the even scale [log units].
  [[nodiscard]] double length() const { return length_; }

  /// Position in [-1, 1] over all pieces, which reach slightly beyond the range, and the shape
  /// there.
  [[nodiscard]] double position(double shape) const {
    return 2.0 * base::log(z(shape) / left_) / length_ - 1.0;
  }
  [[nodiscard]] double shape(double position) const {
    return (left_ * base::exp(0.5 * (position + 1.0) * length_) - shift_) / rate_;
  }

  struct Place {
    std::int64_t piece;
    double local;  ///< in [-1, 1)
  };
  [[nodiscard]] Place place(double shape) const {
    const auto bits = std::bit_cast<std::int64_t>(z(shape));
    const std::int64_t rest = bits & ((std::int64_t{1} << drop_) - 1);
    return {(bits >> drop_) - first_, static_cast<double>(rest) * half_unit() - 1.0};
  }
  /// The shape at a local coordinate of a piece.
  [[nodiscard]] double shape_in(std::int64_t piece, double local) const {
    return (edge(piece) + 0.5 * (local + 1.0) * width(piece) - shift_) / rate_;
  }
  /// Derivative of the local coordinate by the shape.
  [[nodiscard]] double slope(std::int64_t piece) const { return 2.0 * rate_ / width(piece); }

 private:
  [[nodiscard]] double z(double shape) const { return shift_ + rate_ * shape; }
  [[nodiscard]] std::int64_t leading(double z) const {
    return std::bit_cast<std::int64_t>(z) >> drop_;
  }
  [[nodiscard]] double half_unit() const {
    return std::bit_cast<double>(static_cast<std::int64_t>(1023 + 1 - drop_) << 52);
  }
  [[nodiscard]] double edge(std::int64_t piece) const {
    return std::bit_cast<double>((piece + first_) << drop_);
  }
  [[nodiscard]] double width(std::int64_t piece) const { return edge(piece + 1) - edge(piece); }

  double lower_;
  double upper_;
  double shift_;
  double rate_;
  int drop_;
  std::int64_t first_ = 0;
  std::int64_t pieces_ = 0;
  double left_ = 0.0;
  double length_ = 0.0;
};

}  // namespace jointid::identify
