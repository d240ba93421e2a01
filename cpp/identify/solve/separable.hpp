#pragma once
// Exact elimination of the linear parameters under their bounds: what remains to search is the
// shape alone.

#include <Eigen/Core>

#include "base/pool.hpp"
#include "identify/penalty/penalty_function.hpp"
#include "identify/solve/elimination.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

struct SeparableResult {
  Eigen::VectorXd best;  ///< all parameters, ordered as the penalty's names
  double penalty = 0.0;  ///< by the direct sum
  int evaluations = 0;   ///< shapes tried
};

/// Throws std::invalid_argument unless the domain has the penalty's parameters.
void require_domain(const PenaltyFunction& penalty, const search::Domain& domain);

/// The separable optimum. No free shape: a single solve. One: a scan, then parabolas about its
/// best. Several: a grid, then polishes of all parameters from its best points.
SeparableResult minimise_separable(const PenaltyFunction& penalty, const search::Domain& domain,
                                   base::Pool& pool);

/// The local optimum near a start, never worse than it: for one free shape by elimination and
/// parabolas about the start's, for several by Levenberg-Marquardt. `everywhere`: the free
/// shapes are also searched over their whole ranges, as by minimise_separable, which costs next to
/// nothing on the compressed penalty.
SeparableResult refine_separable(const PenaltyFunction& penalty, const search::Domain& domain,
                                 const Eigen::VectorXd& start, base::Pool& pool, bool everywhere);

}  // namespace jointid::identify
