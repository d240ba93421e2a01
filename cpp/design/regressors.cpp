#include "design/regressors.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/clones.hpp"
#include "base/elementary.hpp"
#include "base/input_error.hpp"

namespace jointid::design {

namespace {

using identify::Integral;

double sign_of(double velocity) {
  return velocity > 0.0 ? 1.0 : (velocity < 0.0 ? -1.0 : 0.0);
}

bool acts(model::Direction direction, double velocity) {
  switch (direction) {
    case model::Direction::both:
      return true;
    case model::Direction::positive:
      return velocity > 0.0;
    case model::Direction::negative:
      return velocity < 0.0;
  }
  return true;
}

/// exp(-s v^2), with the sign of the velocity.
JOINTID_CLONES void gaussian(double shape, const double* velocity, std::size_t count,
                             double* result) {
  for (std::size_t k = 0; k < count; ++k) {
    const double v = velocity[k];
    const double value = base::exp_decay(shape * v * v);
    result[k] = v > 0.0 ? value : (v < 0.0 ? -value : 0.0);
  }
}

void friction(const Column& column, const std::vector<double>& velocity, double* result) {
  if (column.shape < 0 && column.term.direction == model::Direction::both) {
    switch (column.term.basis) {  // columns of every joint, without a choice at each sample
      case model::SpeedBasis::constant:
        std::transform(velocity.begin(), velocity.end(), result, sign_of);
        return;
      case model::SpeedBasis::linear:
        std::copy(velocity.begin(), velocity.end(), result);
        return;
      case model::SpeedBasis::gaussian:
        gaussian(column.shapes[0], velocity.data(), velocity.size(), result);
        return;
      default:
        break;
    }
  }
  const auto& term = column.term;
  const double* shapes = column.shapes.data();
  for (std::size_t k = 0; k < velocity.size(); ++k) {
    const double speed = std::fabs(velocity[k]);
    const double size =
        column.shape < 0
            ? model::basis_value(term.basis, speed, shapes)
            : column.coefficient * model::basis_slope(term.basis, speed, shapes, column.shape);
    result[k] = acts(term.direction, velocity[k]) ? sign_of(velocity[k]) * size : 0.0;
  }
}

/// The slope by the shape of exp(-s v^2), from the column of its value, which saves an exponential.
void gaussian_slope(double coefficient, const std::vector<double>& velocity, const double* value,
                    double* result) {
  for (std::size_t k = 0; k < velocity.size(); ++k) {
    result[k] = -coefficient * velocity[k] * velocity[k] * value[k];
  }
}

void by_load(const std::vector<double>& velocity, const std::vector<double>& load, double* result) {
  for (std::size_t k = 0; k < velocity.size(); ++k) {
    result[k] = sign_of(velocity[k]) * std::fabs(load[k]);
  }
}

/// Whether `value` is the coefficient's column of the term with the shape `slope`.
bool is_value_of(const Column& value, const Column& slope) {
  return value.shape < 0 && slope.shape == 0 && value.term.key == slope.term.key &&
         slope.term.basis == model::SpeedBasis::gaussian;
}

void fill(const Column& column, const simulate::Signals& signals, double* result) {
  const auto& velocity = signals.true_velocity;
  const std::size_t count = velocity.size();
  switch (column.term.integral) {
    case Integral::velocity_change:
    case Integral::displacement:
      std::fill_n(result, count, 0.0);
      return;
    case Integral::friction:
      friction(column, velocity, result);
      return;
    case Integral::load_friction:
      by_load(velocity, signals.torque, result);
      return;
    case Integral::link_friction:
      by_load(velocity, signals.link_torque, result);
      return;
    case Integral::duration:
      std::fill_n(result, count, 1.0);
      return;
    case Integral::cosine:
      for (std::size_t k = 0; k < count; ++k) {
        result[k] = base::cos(column.frequency * signals.true_position[k]);
      }
      return;
    case Integral::sine:
      for (std::size_t k = 0; k < count; ++k) {
        result[k] = base::sin(column.frequency * signals.true_position[k]);
      }
      return;
    case Integral::sensor:
      std::copy_n(signals.reading.begin(), count, result);
      return;
    case Integral::own:
      break;
  }
  throw base::InputError("no motion can be designed for the term " + column.term.key,
                         "joint.model");
}

}  // namespace

bool by_ends(const Column& column) {
  return column.term.integral == Integral::velocity_change ||
         column.term.integral == Integral::displacement;
}

void rates(const simulate::Signals& signals, const std::vector<Column>& columns,
           Eigen::MatrixXd& result) {
  const auto count = static_cast<Eigen::Index>(signals.true_velocity.size());
  result.resize(count, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) {
    double* own = result.col(static_cast<Eigen::Index>(c)).data();
    const auto value =
        std::find_if(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(c),
                     [&](const Column& other) { return is_value_of(other, columns[c]); });
    if (value != columns.begin() + static_cast<std::ptrdiff_t>(c)) {
      gaussian_slope(columns[c].coefficient, signals.true_velocity,
                     result.col(value - columns.begin()).data(), own);
    } else {
      fill(columns[c], signals, own);
    }
  }
}

double step(const Column& column, const simulate::Signals& signals, std::size_t a, std::size_t b) {
  if (column.term.integral == Integral::velocity_change) {
    return signals.true_velocity[b] - signals.true_velocity[a];
  }
  return signals.true_position[b] - signals.true_position[a];
}

}  // namespace jointid::design
