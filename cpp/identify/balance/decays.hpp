#pragma once
// The columns of decaying friction for many shapes at once, over a stretch of windows.
//
// Both decays are exp(-rate * x). The Gaussian decay (4-1) has x = v^2 and rate = s, the general
// one (2-3) x = v^d and rate = v_s^-d. So x depends only on the speed and is computed once for all
// rates.

#include <Eigen/Core>
#include <vector>

#include "base/cancel.hpp"
#include "identify/balance/quadrature.hpp"

namespace jointid::identify {

/// Consecutive windows of a set of nodes.
struct Stretch {
  std::size_t begin;
  std::size_t end;
};

/// Shapes with a common exponent; the rates belong to consecutive columns.
struct DecayRates {
  double exponent = 2.0;
  std::vector<double> rates;
};

/// One column per rate (windows x rates).
void integrate_decays(const FrictionNodes& nodes, const Stretch& windows, const DecayRates& group,
                      const base::Cancel* cancel, Eigen::Ref<Eigen::MatrixXd> columns);

}  // namespace jointid::identify
