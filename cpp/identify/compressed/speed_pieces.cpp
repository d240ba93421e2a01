#include "identify/compressed/speed_pieces.hpp"

#include <algorithm>
#include <cmath>

#include "base/elementary.hpp"
#include "identify/compressed/shape_table.hpp"

namespace jointid::identify {

namespace {

// Half a piece in units of d log v, and the points with which any decay is known there to 1e-14.
constexpr double kHalf = 0.7;
constexpr int kPiecePoints = 20;
// Powers below e^-39 leave 1 as it is, decays behind a power of 45 are nothing beside 1.
constexpr double kResting = 39.0;
constexpr double kVanished = 45.0;
constexpr double kRounding = 5e-16;
constexpr std::size_t kMost = 1000;  // moments: the direct sum costs less then
constexpr double kRest = -1e6;       // log speed of a joint at rest

/// Points that a piece needs which ends `below` the log of the lowest velocity. The decay there is
/// a sum of (-1)^k / k! e^(k d x), x < -below, whose n-th Chebyshev coefficient over the piece is
/// below (k d width / 4)^n / n! e^(-k d below) / k!.
int points_below(double below, double width, const GeneralRange& range) {
  if (below <= 0.0) return kPiecePoints;
  double factorial = 2.0;
  for (int n = 3; n < kPiecePoints; ++n) {
    factorial *= n;
    double largest = 0.0;
    double other = 1.0;
    for (int k = 1; k <= kPiecePoints; ++k) {
      other *= k;
      const double worst = k * std::clamp(n / (k * below), range.exponent_low, range.exponent_high);
      const double size = base::exp(n * base::log(0.25 * worst * width) - worst * below);
      largest = std::max(largest, size / (factorial * other));
    }
    if (largest < kRounding) return n;
  }
  return kPiecePoints;
}

}  // namespace

std::vector<double> SpeedPieces::points() const {
  std::vector<double> result{kRest};
  for (std::size_t p = 0; p < pieces(); ++p) {
    const auto local = chebyshev_points(static_cast<Eigen::Index>(first[p + 1] - first[p]));
    for (const double x : local) {
      result.push_back(left + width * (static_cast<double>(p) + 0.5 * (x + 1.0)));
    }
  }
  return result;
}

std::optional<SpeedPieces> speed_pieces(const GeneralRange& range, double least, double most,
                                        std::string& reason) {
  const double lowest = base::log(range.velocity_low);
  SpeedPieces result;
  result.left = std::max(least, lowest - kResting / range.exponent_low);
  const double right =
      std::min(most, base::log(range.velocity_high) + base::log(kVanished) / range.exponent_low);
  const double length = std::max(right - result.left, 1e-6);
  const double pieces = std::ceil(length * range.exponent_high / (2.0 * kHalf));
  result.first.push_back(1);
  result.width = length / pieces;
  for (double p = 1.0; p <= pieces && result.first.back() <= kMost; p += 1.0) {
    const double below = lowest - (result.left + p * result.width);
    result.first.push_back(result.first.back() +
                           static_cast<std::size_t>(points_below(below, result.width, range)));
  }
  if (result.first.back() <= kMost) return result;
  reason =
      "the bounds of stribeck_velocity and stribeck_exponent are so wide that their table takes "
      "more than " +
      std::to_string(kMost) + " moments of the speed";
  return std::nullopt;
}

void add_moments(const SpeedPieces& pieces, const double* logarithm, const double* weight,
                 std::size_t count, double* row, Span& span) {
  const auto last = static_cast<double>(pieces.pieces());
  const double scale = 1.0 / pieces.width;
  for (std::size_t i = 0; i < count; ++i) {
    const double place = (logarithm[i] - pieces.left) * scale;
    if (place < 0.0) {
      row[0] += weight[i];
      span = {0, std::max(span.end, std::size_t{1})};
      continue;
    }
    if (place > last + 1e-9) continue;  // every decay has vanished
    const auto piece = std::min(static_cast<std::size_t>(place), pieces.pieces() - 1);
    const double x = 2.0 * (place - static_cast<double>(piece)) - 1.0;
    const std::size_t begin = pieces.first[piece];
    const std::size_t end = pieces.first[piece + 1];
    double before = x * weight[i];  // T_-1 = T_1
    double now = weight[i];
    for (std::size_t k = begin; k < end; ++k) {
      row[k] += now;
      const double next = 2.0 * x * now - before;
      before = now;
      now = next;
    }
    span = {std::min(span.begin, begin), std::max(span.end, end)};
  }
}

}  // namespace jointid::identify
