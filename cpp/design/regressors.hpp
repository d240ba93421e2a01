#pragma once
// What each free parameter of a joint does to the torque balance at a sample of a noise-free
// simulation: the columns of the information that a motion gives.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "identify/balance/terms.hpp"
#include "simulate/simulator.hpp"

namespace jointid::design {

/// A free parameter: the coefficient of a term, or a shape of one.
struct Column {
  identify::Term term{};
  int shape = -1;            ///< which shape of the term; -1: its coefficient
  double coefficient = 0.0;  ///< of the term, by which the slope by a shape counts
  double frequency = 0.0;    ///< of a harmonic, per radian of the joint
  std::vector<double> shapes{};
};

/// Torque per unit of each parameter (columns) at each sample (rows); 0 for those that a window's
/// ends give.
void rates(const simulate::Signals& signals, const std::vector<Column>& columns,
           Eigen::MatrixXd& result);

/// Impulse per unit of the parameter that the ends of a window give, between samples a and b.
double step(const Column& column, const simulate::Signals& signals, std::size_t a, std::size_t b);

/// Whether `step` and not `rates` holds for it.
bool by_ends(const Column& column);

}  // namespace jointid::design
