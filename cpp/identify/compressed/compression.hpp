#pragma once
// From a penalty over all samples to functions of the shapes: which nodes, their digests over all
// windows, and the table through them.

#include <optional>
#include <string>
#include <vector>

#include "base/pool.hpp"
#include "identify/compressed/digest.hpp"
#include "identify/compressed/shape_table.hpp"
#include "identify/penalty/penalty.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

/// The shapes at which columns are digested. Rates are those of decays.hpp.
struct ShapeNodes {
  std::vector<ShapeAxis> axes;  ///< exponent before velocity; one axis for the Gaussian decay
  /// Parameters of the axes, among the shapes.
  std::vector<Eigen::Index> order;
  /// Of a single axis of velocities, whose exponent is fixed; 0 where that axis is of rates.
  double exponent = 0.0;
  std::vector<DecayRates> lines;  ///< Chebyshev points: one line, or one a point of the first axis
  std::vector<std::vector<double>> probes;  ///< shapes in the axes' order, between the points
};

/// Nodes for the domain's shapes, `density` times as many as usually suffice. `speed` is the
/// largest. Says in `reason` why there are none when it returns nothing; more than a search by the
/// direct sum would cost is such a reason.
std::optional<ShapeNodes> shape_nodes(const Penalty& penalty, const search::Domain& domain,
                                      double speed, double density, std::string& reason);

/// The rates of all lines and probes: those of a single line's probes behind its own, else a group
/// a probe.
std::vector<DecayRates> rates_of(const ShapeNodes& nodes);

/// One digest of some windows for each group of rates; none of shapes when there are no groups.
std::vector<Digest> digest_part(const Penalty& penalty, const Stretch& windows,
                                const std::vector<DecayRates>& groups, const base::Cancel* cancel);

/// The same of all windows, their parts over the threads unless there is little to do.
std::vector<Digest> digest_all(const Penalty& penalty, const std::vector<DecayRates>& groups,
                               base::Pool& pool);

/// The functions of one node that a digest holds: projections of each shaped column, then inner
/// products of the remainders.
Eigen::MatrixXd functions_of(const Digest& digest);

}  // namespace jointid::identify
