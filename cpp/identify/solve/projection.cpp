#include "identify/solve/projection.hpp"

#include <algorithm>
#include <array>

#include "base/decompositions.hpp"
#include "identify/solve/elimination.hpp"

namespace jointid::identify {

namespace {

constexpr double kDependent = 1e-14;  // of a column's norm: a smaller remainder is rounding

FrictionNodes pick(const FrictionNodes& nodes, const std::vector<Eigen::Index>& windows) {
  FrictionNodes result;
  for (const auto window : windows) {
    const auto w = static_cast<std::size_t>(window);
    const auto begin = static_cast<std::ptrdiff_t>(nodes.first[w]);
    const auto end = static_cast<std::ptrdiff_t>(nodes.first[w + 1]);
    const auto append = [&](const std::vector<double>& from, std::vector<double>& to) {
      if (!from.empty()) to.insert(to.end(), from.begin() + begin, from.begin() + end);
    };
    append(nodes.speed, result.speed);
    append(nodes.logarithm, result.logarithm);
    append(nodes.weight, result.weight);
    result.first.push_back(result.speed.size());
  }
  return result;
}

}  // namespace

Projection::Projection(const Penalty& penalty, const search::Domain& domain,
                       const std::vector<Eigen::Index>& windows, const base::Cancel& cancel)
    : penalty_(penalty), domain_(domain), cancel_(cancel), all_(windows.empty()) {
  const Eigen::Index p = penalty.coefficients();
  for (Eigen::Index i = p; i < penalty.parameters(); ++i) {
    if (domain.lower[i] < domain.upper[i]) free_.push_back(i);
  }
  const auto rows = [&](const auto& column) -> Eigen::VectorXd {
    if (all_) return column;
    return column(windows);
  };
  std::vector<Eigen::Index> constant;
  Eigen::VectorXd target = rows(penalty.target());
  for (Eigen::Index j = 0; j < p; ++j) {
    if (penalty.is_shaped(j)) continue;
    if (domain.lower[j] < domain.upper[j]) {
      constant.push_back(j);
    } else if (domain.lower[j] != 0.0) {
      target -= domain.lower[j] * rows(penalty.constant_columns().col(j));
    }
  }
  const auto size = static_cast<Eigen::Index>(constant.size()) + 1;
  const auto shaped = static_cast<Eigen::Index>(penalty.shaped().size());
  basis_.resize(target.size(), size);
  constant_.setZero(size + shaped, p);
  for (const auto j : constant) {
    constant_.col(j).head(size) = append(rows(penalty.constant_columns().col(j)));
  }
  target_.setZero(size + shaped);
  target_.head(size) = append(target);
  if (all_) return;
  for (const auto& each : penalty.shaped()) {
    auto& own = chosen_[static_cast<std::size_t>(each.term.direction)];
    if (own.first.size() == 1) own = pick(penalty.nodes(each.term.direction), windows);
  }
}

/// Gram and Schmidt, twice, which suffices (Giraud and others 2005). A column that depends on those
/// before it adds no direction.
Eigen::VectorXd Projection::append(Eigen::VectorXd column) {
  cancel_.check();
  Eigen::VectorXd result = Eigen::VectorXd::Zero(basis_.cols());
  const double before = column.norm();
  for (int pass = 0; pass < 2 && count_ > 0; ++pass) {
    const Eigen::VectorXd along = basis_.leftCols(count_).transpose() * column;
    column.noalias() -= basis_.leftCols(count_) * along;
    result.head(count_) += along;
  }
  const double rest = column.norm();
  if (rest > kDependent * before) {
    basis_.col(count_) = column / rest;
    result[count_++] = rest;
  }
  return result;
}

const FrictionNodes& Projection::nodes_of(const Penalty::Shaped& shaped) const {
  if (all_) return penalty_.nodes(shaped.term.direction);
  return chosen_[static_cast<std::size_t>(shaped.term.direction)];
}

std::size_t Projection::nodes() const {
  std::size_t result = 0;
  for (const auto& shaped : penalty_.shaped()) result += nodes_of(shaped).speed.size();
  return result;
}

Eigen::VectorXd Projection::full(const Eigen::VectorXd& shapes) const {
  Eigen::VectorXd theta = domain_.lower;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    theta[free_[i]] = shapes[static_cast<Eigen::Index>(i)];
  }
  return theta;
}

Projection::Frame Projection::frame(const Eigen::VectorXd& theta, bool slopes) const {
  Frame result;
  result.columns = constant_;
  const auto& shaped = penalty_.shaped();
  const Eigen::Index size = basis_.cols();
  const auto basis = basis_.leftCols(count_);
  const auto count = static_cast<Eigen::Index>(shaped.size());
  Eigen::MatrixXd rests = Eigen::MatrixXd::Zero(basis_.rows(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& each = shaped[static_cast<std::size_t>(i)];
    const auto inner = static_cast<Eigen::Index>(each.shapes.size());
    std::array<double, 4> own{};
    for (std::size_t s = 0; s < each.shapes.size(); ++s) {
      own[s] = theta[penalty_.coefficients() + each.shapes[s]];
    }
    Eigen::MatrixXd columns(basis_.rows(), slopes ? 1 + inner : 1);
    if (slopes) {
      integrate_slopes(each.term, nodes_of(each), own.data(), &cancel_, columns);
    } else {
      integrate_friction(each.term, nodes_of(each), own.data(), &cancel_, columns.col(0));
    }
    const Eigen::MatrixXd along = basis.transpose() * columns;
    columns.noalias() -= basis * along;
    auto column = result.columns.col(each.coefficient);
    column.head(count_) = along.col(0);
    for (Eigen::Index before = 0; before < i; ++before) {
      column[size + before] = rests.col(before).dot(columns.col(0));
      columns.col(0) -= column[size + before] * rests.col(before);
    }
    const double rest = columns.col(0).norm();
    column[size + i] = rest;
    if (rest > 0.0) rests.col(i) = columns.col(0) / rest;
    if (!slopes) continue;
    result.slopes.emplace_back(Eigen::MatrixXd::Zero(result.columns.rows(), inner));
    result.slopes.back().topRows(count_) = along.rightCols(inner);
    result.beyond.emplace_back(columns.rightCols(inner));
  }
  for (std::size_t i = 0; i < result.slopes.size(); ++i) {
    const Eigen::MatrixXd along = rests.transpose() * result.beyond[i];
    result.beyond[i].noalias() -= rests * along;
    result.slopes[i].bottomRows(count) = along;
  }
  return result;
}

Eigen::VectorXd Projection::solve(const Frame& frame, Eigen::VectorXd& theta) const {
  const Eigen::Index p = penalty_.coefficients();
  theta.head(p) = best_coefficients(
      Balance{frame.columns, target_, penalty_.residual(), penalty_.gain_index()}, domain_);
  Eigen::VectorXd residual = target_ - frame.columns * theta.head(p);
  if (penalty_.residual() == Residual::sensor) {
    // Fixed coefficients are part of the target. The gain's column counts if it is free.
    residual /= theta[penalty_.gain_index()];
  }
  return residual;
}

double Projection::value(const Eigen::VectorXd& shapes) const {
  Eigen::VectorXd theta = full(shapes);
  return solve(frame(theta, false), theta).squaredNorm();
}

ProjectedPoint Projection::at(const Eigen::VectorXd& shapes) const {
  ProjectedPoint result;
  result.theta = full(shapes);
  const Frame frame = this->frame(result.theta, true);
  const Eigen::VectorXd residual = solve(frame, result.theta);
  result.value = residual.squaredNorm();
  const Eigen::Index p = penalty_.coefficients();
  const Eigen::Index gain = penalty_.gain_index();
  const bool divided = penalty_.residual() == Residual::sensor;
  const double scale = divided ? 1.0 / result.theta[gain] : 1.0;

  const auto count = static_cast<Eigen::Index>(free_.size());
  Eigen::MatrixXd inside = Eigen::MatrixXd::Zero(residual.size(), count);
  Eigen::MatrixXd beyond = Eigen::MatrixXd::Zero(basis_.rows(), count);
  for (std::size_t i = 0; i < frame.slopes.size(); ++i) {
    const auto& each = penalty_.shaped()[i];
    const double factor = -scale * result.theta[each.coefficient];
    for (std::size_t s = 0; s < each.shapes.size(); ++s) {
      const auto place = std::find(free_.begin(), free_.end(), p + each.shapes[s]);
      if (place == free_.end()) continue;
      const auto j = static_cast<Eigen::Index>(place - free_.begin());
      inside.col(j) += factor * frame.slopes[i].col(static_cast<Eigen::Index>(s));
      beyond.col(j) += factor * frame.beyond[i].col(static_cast<Eigen::Index>(s));
    }
  }
  result.gradient = 2.0 * inside.transpose() * residual;

  // Coefficients that are not at a bound follow the shapes.
  Eigen::MatrixXd follow(residual.size(), p);
  Eigen::Index followers = 0;
  for (Eigen::Index j = 0; j < p; ++j) {
    if (result.theta[j] <= domain_.lower[j] || result.theta[j] >= domain_.upper[j]) continue;
    auto column = follow.col(followers);
    column = frame.columns.col(j);
    if (divided && j == gain) column += residual;
    const double norm = column.norm();
    if (norm > 0.0) {
      column /= norm;
      ++followers;
    }
  }
  if (followers > 0) inside = base::outside(follow.leftCols(followers), inside);
  result.curvature = 2.0 * (inside.transpose() * inside + beyond.transpose() * beyond);
  return result;
}

}  // namespace jointid::identify
