#pragma once
// From a penalty over all samples to functions of the shapes: the choice of nodes, their digests
// over all windows, and the table through them.

#include <optional>
#include <string>
#include <vector>

#include "base/pool.hpp"
#include "identify/compressed/digest.hpp"
#include "identify/compressed/shape_table.hpp"
#include "identify/penalty/penalty.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

/// The shapes at which columns are digested: a rate of the Gaussian decay, or a velocity of the
/// general decay with a fixed exponent.
struct ShapeNodes {
  ShapeAxis axis;
  DecayRates rates;            ///< rates of the axis's Chebyshev points, then of the probes
  std::vector<double> probes;  ///< shapes between the points
};

/// Nodes for the domain's shape, `density` times the number that usually suffices. `speed` is the
/// largest speed. Returns nothing if there are no nodes; `reason` then says why.
std::optional<ShapeNodes> shape_nodes(const Penalty& penalty, const search::Domain& domain,
                                      double speed, double density, std::string& reason);

/// The digest of some windows at these rates.
Digest digest_part(const Penalty& penalty, const Stretch& windows, const DecayRates& rates,
                   const base::Cancel* cancel);

/// The same for all windows, with parts on the threads unless there is little to do.
Digest digest_all(const Penalty& penalty, const DecayRates& rates, base::Pool& pool);

/// The functions of one node in a digest: projections of each shaped column, then inner products of
/// the remainders.
Eigen::MatrixXd functions_of(const Digest& digest);

}  // namespace jointid::identify
