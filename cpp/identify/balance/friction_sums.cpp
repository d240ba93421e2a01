// Friction at samples, and its sums over the nodes of windows.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "base/clones.hpp"
#include "identify/balance/quadrature.hpp"

namespace jointid::identify {

namespace {

constexpr std::size_t kNodesAtOnce =
    2048;  // nodes per block: two buffers fit the first-level cache

JOINTID_CLONES void log_speeds(const double* speed, std::size_t count, double* logarithm) {
  for (std::size_t i = 0; i < count; ++i) logarithm[i] = model::log_speed(speed[i]);
}

// A block's weighted values of a decay, and its weighted derivatives if requested (by_* not null).
// Written separately for each basis, because these loops must vectorise.
JOINTID_CLONES void stribeck_values(double shape, const double* speed, const double* weight,
                                    std::size_t count, double* value) {
  for (std::size_t i = 0; i < count; ++i) {
    value[i] = weight[i] * model::basis_value(model::SpeedBasis::gaussian, speed[i], &shape);
  }
}

JOINTID_CLONES void stribeck_slopes(double shape, const double* speed, const double* weight,
                                    std::size_t count, double* value, double* slope) {
  for (std::size_t i = 0; i < count; ++i) {
    const double decay = model::basis_value(model::SpeedBasis::gaussian, speed[i], &shape);
    value[i] = weight[i] * decay;
    slope[i] = weight[i] * (-speed[i] * speed[i] * decay);
  }
}

struct GeneralShapes {
  double velocity;
  double exponent;
  double origin;  ///< log of the velocity
};

JOINTID_CLONES void general_values(const GeneralShapes& shapes, const double* logarithm,
                                   const double* weight, std::size_t count, double* value) {
  const auto [velocity, exponent, origin] = shapes;
  for (std::size_t i = 0; i < count; ++i) {
    value[i] = weight[i] * model::general_decay(logarithm[i] - origin, velocity, exponent).value;
  }
}

JOINTID_CLONES void general_slopes(const GeneralShapes& shapes, const double* logarithm,
                                   const double* weight, std::size_t count, double* value,
                                   double* by_velocity, double* by_exponent) {
  const auto [velocity, exponent, origin] = shapes;
  for (std::size_t i = 0; i < count; ++i) {
    const auto decay = model::general_decay(logarithm[i] - origin, velocity, exponent);
    value[i] = weight[i] * decay.value;
    by_velocity[i] = weight[i] * decay.by_velocity;
    by_exponent[i] = weight[i] * decay.by_exponent;
  }
}

/// A block's logarithms: the stored ones, or computed now into `made`.
const double* logarithms(const FrictionNodes& nodes, std::size_t begin, std::size_t count,
                         std::array<double, kNodesAtOnce>& made) {
  if (!nodes.logarithm.empty()) return nodes.logarithm.data() + begin;
  log_speeds(nodes.speed.data() + begin, count, made.data());
  return made.data();
}

/// Sums `Columns` weighted values of each node by windows; `fill` computes a block of them.
template <std::size_t Columns, class Fill>
void sum_nodes(const FrictionNodes& nodes, const base::Cancel* cancel,
               Eigen::Ref<Eigen::MatrixXd> result, Fill fill) {
  std::array<std::array<double, kNodesAtOnce>, Columns> value;
  const std::size_t windows = nodes.first.size() - 1;
  const std::size_t total = nodes.speed.size();
  std::size_t w = 0;
  std::array<double, Columns> sum{};
  const auto finish = [&](std::size_t reached) {
    while (w < windows && nodes.first[w + 1] <= reached) {
      for (std::size_t c = 0; c < Columns; ++c) {
        result(static_cast<Eigen::Index>(w), static_cast<Eigen::Index>(c)) = sum[c];
      }
      sum.fill(0.0);
      ++w;
    }
  };
  finish(0);  // windows without a node
  for (std::size_t begin = 0; begin < total; begin += kNodesAtOnce) {
    if (cancel != nullptr) cancel->check();
    const std::size_t count = std::min(kNodesAtOnce, total - begin);
    fill(begin, count, value);
    std::size_t i = 0;
    while (i < count) {
      const std::size_t stop = std::min(count, nodes.first[w + 1] - begin);
      for (std::size_t j = i; j < stop; ++j) {
        for (std::size_t c = 0; c < Columns; ++c) sum[c] += value[c][j];
      }
      i = stop;
      finish(begin + i);
    }
  }
}

/// sgn v exp(-s v^2) of one direction or both.
JOINTID_CLONES void signed_decays(const double* velocity, std::size_t count, double shape,
                                  model::Direction direction, double* result) {
  const double forward = direction == model::Direction::negative ? 0.0 : 1.0;
  const double backward = direction == model::Direction::positive ? 0.0 : -1.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double v = velocity[i];
    const double side = (v > 0.0 ? forward : 0.0) + (v < 0.0 ? backward : 0.0);
    result[i] = side * base::exp(-shape * v * v);
  }
}

/// A general decay with exponent 2 is a Gaussian one.
bool is_gaussian(const Term& term, const double* shapes) {
  return term.basis == model::SpeedBasis::general && shapes[1] == 2.0;
}

double gaussian_rate(const double* shapes) {
  const double rate = 1.0 / (shapes[0] * shapes[0]);
  return std::min(rate, std::numeric_limits<double>::max());  // times the speed 0, the product is 0
}

}  // namespace

Eigen::VectorXd friction_basis(const Term& term, const Eigen::VectorXd& velocity,
                               const Eigen::VectorXd& shapes, double load) {
  if (!is_friction(term)) {
    throw std::invalid_argument("'" + term.key + "' is not a friction term");
  }
  if (shapes.size() != static_cast<Eigen::Index>(term.shapes.size())) {
    throw std::invalid_argument("'" + term.key + "' has " + std::to_string(term.shapes.size()) +
                                " shape parameters, got " + std::to_string(shapes.size()));
  }
  if (term.integral == Integral::displacement) return velocity;
  const bool gaussian = is_gaussian(term, shapes.data());
  if ((gaussian || term.basis == model::SpeedBasis::gaussian) && !needs_load(term)) {
    const double rate = gaussian ? gaussian_rate(shapes.data()) : shapes[0];
    Eigen::VectorXd result(velocity.size());
    signed_decays(velocity.data(), static_cast<std::size_t>(velocity.size()), rate, term.direction,
                  result.data());
    return result;
  }
  const auto value = [&](double speed) {
    return needs_load(term) ? std::fabs(load)
                            : model::basis_value(term.basis, speed, shapes.data());
  };
  return velocity.unaryExpr([&](double v) {
    if (v == 0.0 || (v > 0.0 && term.direction == model::Direction::negative) ||
        (v < 0.0 && term.direction == model::Direction::positive)) {
      return 0.0;
    }
    return std::copysign(value(std::fabs(v)), v);
  });
}

void FrictionNodes::take_logarithms() {
  logarithm.resize(speed.size());
  log_speeds(speed.data(), speed.size(), logarithm.data());
}

void integrate_friction(const Term& term, const FrictionNodes& nodes, const double* shapes,
                        const base::Cancel* cancel, Eigen::Ref<Eigen::VectorXd> column) {
  const bool gaussian = is_gaussian(term, shapes);
  const bool general = !gaussian && term.basis == model::SpeedBasis::general;
  const GeneralShapes both =
      general ? GeneralShapes{shapes[0], shapes[1], base::log(shapes[0])} : GeneralShapes{};
  std::array<double, kNodesAtOnce> made;
  sum_nodes<1>(nodes, cancel, column, [&](std::size_t begin, std::size_t count, auto& value) {
    const double* speed = nodes.speed.data() + begin;
    const double* weight = nodes.weight.data() + begin;
    double* values = value[0].data();
    if (term.basis == model::SpeedBasis::gaussian) {
      stribeck_values(shapes[0], speed, weight, count, values);
    } else if (gaussian) {
      stribeck_values(gaussian_rate(shapes), speed, weight, count, values);
    } else if (general) {
      general_values(both, logarithms(nodes, begin, count, made), weight, count, values);
    } else {
      for (std::size_t i = 0; i < count; ++i) {
        values[i] = weight[i] * model::basis_value(term.basis, speed[i], shapes);
      }
    }
  });
}

void integrate_slopes(const Term& term, const FrictionNodes& nodes, const double* shapes,
                      const base::Cancel* cancel, Eigen::Ref<Eigen::MatrixXd> columns) {
  const double* speed = nodes.speed.data();
  const double* weight = nodes.weight.data();
  if (term.basis == model::SpeedBasis::gaussian) {
    sum_nodes<2>(nodes, cancel, columns, [&](std::size_t begin, std::size_t count, auto& value) {
      stribeck_slopes(shapes[0], speed + begin, weight + begin, count, value[0].data(),
                      value[1].data());
    });
    return;
  }
  if (term.basis != model::SpeedBasis::general) {
    for (Eigen::Index c = 0; c < columns.cols(); ++c) {
      const auto at = [&](double v) {
        return c == 0 ? model::basis_value(term.basis, v, shapes)
                      : model::basis_slope(term.basis, v, shapes, static_cast<int>(c) - 1);
      };
      sum_nodes<1>(nodes, cancel, columns.col(c),
                   [&](std::size_t begin, std::size_t count, auto& value) {
                     for (std::size_t i = 0; i < count; ++i)
                       value[0][i] = weight[begin + i] * at(speed[begin + i]);
                   });
    }
    return;
  }
  const GeneralShapes both{shapes[0], shapes[1], base::log(shapes[0])};
  std::array<double, kNodesAtOnce> made;
  sum_nodes<3>(nodes, cancel, columns, [&](std::size_t begin, std::size_t count, auto& value) {
    general_slopes(both, logarithms(nodes, begin, count, made), weight + begin, count,
                   value[0].data(), value[1].data(), value[2].data());
    if (is_gaussian(term, shapes)) {  // gives the same bits as integrate_friction
      stribeck_values(gaussian_rate(shapes), speed + begin, weight + begin, count, value[0].data());
    }
  });
}

}  // namespace jointid::identify
