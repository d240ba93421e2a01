#include "design/regressors.hpp"

#include <cmath>

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

double friction(const Column& column, double velocity) {
  const auto& term = column.term;
  if (!acts(term.direction, velocity)) return 0.0;
  const double speed = std::fabs(velocity);
  const double* shapes = column.shapes.data();
  const double size =
      column.shape < 0
          ? model::basis_value(term.basis, speed, shapes)
          : column.coefficient * model::basis_slope(term.basis, speed, shapes, column.shape);
  return sign_of(velocity) * size;
}

double rate(const Column& column, const simulate::Signals& signals, std::size_t k) {
  const double velocity = signals.true_velocity[k];
  switch (column.term.integral) {
    case Integral::velocity_change:
    case Integral::displacement:
      return 0.0;
    case Integral::friction:
      return friction(column, velocity);
    case Integral::load_friction:
      return sign_of(velocity) * std::fabs(signals.torque[k]);
    case Integral::link_friction:
      return sign_of(velocity) * std::fabs(signals.link_torque[k]);
    case Integral::duration:
      return 1.0;
    case Integral::cosine:
      return base::cos(column.frequency * signals.true_position[k]);
    case Integral::sine:
      return base::sin(column.frequency * signals.true_position[k]);
    case Integral::sensor:
      return signals.reading[k];
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

void rates(const simulate::Signals& signals, const std::vector<Column>& columns, std::size_t k,
           double* result) {
  for (std::size_t c = 0; c < columns.size(); ++c) result[c] = rate(columns[c], signals, k);
}

double step(const Column& column, const simulate::Signals& signals, std::size_t a, std::size_t b) {
  if (column.term.integral == Integral::velocity_change) {
    return signals.true_velocity[b] - signals.true_velocity[a];
  }
  return signals.true_position[b] - signals.true_position[a];
}

}  // namespace jointid::design
