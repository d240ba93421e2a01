#include "identify/penalty/penalty_function.hpp"

#include <stdexcept>

namespace jointid::identify {

void PenaltyFunction::check(const Eigen::VectorXd& theta) const {
  if (theta.size() != parameters()) {
    throw std::invalid_argument("theta must have " + std::to_string(parameters()) +
                                " values, got " + std::to_string(theta.size()));
  }
  if (residual() == Residual::sensor && theta[gain_index()] == 0.0) {
    throw std::invalid_argument("sensor_gain must not be 0 with residual 'sensor'");
  }
}

}  // namespace jointid::identify
