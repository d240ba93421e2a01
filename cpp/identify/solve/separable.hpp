#pragma once
// Exact elimination of the linear parameters under their bounds, so that only the shape is
// searched.

#include <Eigen/Core>

#include "base/pool.hpp"
#include "identify/penalty/penalty_function.hpp"
#include "identify/solve/elimination.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

struct SeparableResult {
  Eigen::VectorXd best;  ///< all parameters, ordered as the penalty's names
  double penalty = 0.0;  ///< by the direct sum
  int evaluations = 0;   ///< number of shapes that were tried
};

/// Throws std::invalid_argument unless the domain has the penalty's parameters.
void require_domain(const PenaltyFunction& penalty, const search::Domain& domain);

/// The separable optimum. Without a free shape: a single solution. With one: a scan, then parabolas
/// about its best point. With several: a grid, then polishes of all parameters from its best
/// points.
SeparableResult minimise_separable(const PenaltyFunction& penalty, const search::Domain& domain,
                                   base::Pool& pool);

/// The local optimum near a start, never worse than the start. One free shape: elimination and
/// parabolas about the start's shape. Several: Levenberg-Marquardt. `everywhere` also searches the
/// whole ranges of the free shapes, as in minimise_separable, which costs little on the compressed
/// penalty.
SeparableResult refine_separable(const PenaltyFunction& penalty, const search::Domain& domain,
                                 const Eigen::VectorXd& start, base::Pool& pool, bool everywhere);

}  // namespace jointid::identify
