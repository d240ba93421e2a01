#include "identify/penalty/instruments.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/decompositions.hpp"
#include "base/householder.hpp"

namespace jointid::identify {

namespace {

constexpr double kImplied =
    1e-6;  // of a column's norm: a smaller part outside the other columns is ignored
// Gravity alone suffices if it has this share of the whole link's information. The gain's error
// then grows by a fifth at most.
constexpr double kGravityAlone = 0.7;
constexpr double kWeak = 10.0;
constexpr double kSmallest = 1e-6;  // share: smaller ones are the integrals' own rounding

/// Makes columns orthonormal one by one, and omits columns that the others imply.
class Basis {
 public:
  explicit Basis(const Eigen::MatrixXd& triangle)
      : triangle_(triangle), q_(triangle.rows(), 0), reading_(triangle.col(triangle.cols() - 1)) {}

  /// Adds columns. Returns the part of the reading's square that they explain in addition to the
  /// columns before.
  double add(Eigen::Index first, Eigen::Index count) {
    double explained = 0.0;
    for (Eigen::Index j = first; j < first + count; ++j) {
      Eigen::VectorXd column = triangle_.col(j);
      const double size = column.norm();
      for (int twice = 0; twice < 2; ++twice) {
        const Eigen::VectorXd known = q_.transpose() * column;
        column.noalias() -= q_ * known;
      }
      const double left = column.norm();
      if (!(left > kImplied * size)) continue;
      q_.conservativeResize(Eigen::NoChange, q_.cols() + 1);
      q_.col(q_.cols() - 1) = column / left;
      used_.push_back(j);
      const double along = q_.col(q_.cols() - 1).dot(reading_);
      explained += along * along;
    }
    return explained;
  }
  [[nodiscard]] Eigen::Index used() const { return q_.cols(); }
  /// Part of the reading's square that the columns do not explain.
  [[nodiscard]] double left() const {
    Eigen::VectorXd rest = reading_;
    rest.noalias() -= q_ * (q_.transpose() * reading_);
    return rest.squaredNorm();
  }
  /// Weights of all columns; the weighted sum is the projection.
  [[nodiscard]] Eigen::VectorXd weights() const {
    Eigen::MatrixXd own(triangle_.rows(), used());
    for (Eigen::Index i = 0; i < used(); ++i) {
      own.col(i) = triangle_.col(used_[static_cast<std::size_t>(i)]);
    }
    const Eigen::MatrixXd upper = q_.transpose() * own;
    const Eigen::VectorXd solved = base::solve_upper(upper, q_.transpose() * reading_);
    Eigen::VectorXd result = Eigen::VectorXd::Zero(triangle_.cols() - 1);
    for (Eigen::Index i = 0; i < used(); ++i)
      result[used_[static_cast<std::size_t>(i)]] = solved[i];
    return result;
  }

 private:
  const Eigen::MatrixXd& triangle_;
  Eigen::MatrixXd q_;
  Eigen::VectorXd reading_;
  std::vector<Eigen::Index> used_;
};

/// The reading's square without its mean.
double about_mean(const Instruments& instruments, const Eigen::MatrixXd& triangle) {
  const Eigen::VectorXd reading = triangle.col(triangle.cols() - 1);
  Eigen::VectorXd duration = Eigen::VectorXd::Zero(reading.size());
  for (Eigen::Index run = 0; run < instruments.runs; ++run) {
    duration += triangle.col(instruments.inner() + Instruments::kPosture * run + 2);
  }
  const double square = duration.squaredNorm();
  const double along = square > 0.0 ? duration.dot(reading) / square : 0.0;
  return (reading - along * duration).squaredNorm();
}

}  // namespace

bool FirstStage::weak() const {
  return !(strength >= kWeak) || !(share >= kSmallest);
}

FirstStage solve_first_stage(const Instruments& instruments, const Eigen::MatrixXd& triangle,
                             Eigen::Index windows) {
  const Eigen::Index posture = Instruments::kPosture * instruments.runs;
  Basis basis(triangle);
  basis.add(0, instruments.inner());
  const Eigen::Index own = basis.used();
  const double gravity = basis.add(instruments.inner(), posture);
  const Basis without = basis;
  const double speed = basis.add(instruments.inner() + posture, instruments.runs);
  FirstStage result;
  result.instruments = instruments;
  result.acceleration = gravity < kGravityAlone * (gravity + speed);
  const Basis& chosen = result.acceleration ? basis : without;
  result.weights = chosen.weights();
  const double explained = result.acceleration ? gravity + speed : gravity;
  const auto extra = static_cast<double>(chosen.used() - own);
  const auto freedom = static_cast<double>(windows - chosen.used());
  const double left = chosen.left();
  const double varying = about_mean(instruments, triangle);
  if (extra > 0.0 && freedom > 0.0) {
    result.strength =
        left > 0.0 ? explained / extra * freedom / left : std::numeric_limits<double>::max();
    result.share = varying > 0.0 ? explained / varying : 0.0;
  }
  return result;
}

Eigen::MatrixXd square_triangle(Eigen::MatrixXd rows) {
  const Eigen::Index m = rows.cols();
  const Eigen::Index given = rows.rows();
  if (given < m) {  // rows of zeros change nothing
    rows.conservativeResize(m, Eigen::NoChange);
    rows.bottomRows(m - given).setZero();
  }
  return base::triangle_of(rows);
}

Eigen::MatrixXd fold(const std::vector<Eigen::MatrixXd>& triangles) {
  constexpr std::size_t kFolded = 32;  // rows at a time: they stay in the cache
  Eigen::MatrixXd result = triangles.front();
  const Eigen::Index m = result.cols();
  for (std::size_t begin = 1; begin < triangles.size(); begin += kFolded) {
    const std::size_t end = std::min(triangles.size(), begin + kFolded);
    Eigen::MatrixXd stack(m * static_cast<Eigen::Index>(end - begin + 1), m);
    stack.topRows(m) = result;
    for (std::size_t i = begin; i < end; ++i) {
      stack.middleRows(m * static_cast<Eigen::Index>(i - begin + 1), m) = triangles[i];
    }
    result = square_triangle(std::move(stack));
  }
  return result;
}

}  // namespace jointid::identify
