#pragma once
// Effect of each free parameter of a joint on the torque balance at a sample of a noise-free
// simulation. These columns give the information of a motion.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "identify/balance/terms.hpp"
#include "simulate/simulator.hpp"

namespace jointid::design {

/// A free parameter: the coefficient of a term, or a shape of the term.
struct Column {
  identify::Term term{};
  int shape = -1;            ///< index of the term's shape; -1: its coefficient
  double coefficient = 0.0;  ///< coefficient of the term, which multiplies the slope by a shape
  double frequency = 0.0;    ///< frequency of a harmonic, per radian of the joint
  std::vector<double> shapes{};
};

/// Torque per unit of each parameter (columns) at each sample (rows); 0 for parameters that act
/// through a window's ends.
void rates(const simulate::Signals& signals, const std::vector<Column>& columns,
           Eigen::MatrixXd& result);

/// Impulse per unit of the parameter from the ends of a window, samples a and b.
double step(const Column& column, const simulate::Signals& signals, std::size_t a, std::size_t b);

/// Whether `step` applies to the parameter instead of `rates`.
bool by_ends(const Column& column);

}  // namespace jointid::design
