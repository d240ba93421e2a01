#pragma once
// A signal: a view of an array that its owner keeps.

#include <Eigen/Core>

namespace jointid::signals {

using Signal = Eigen::Map<const Eigen::VectorXd>;

}  // namespace jointid::signals
