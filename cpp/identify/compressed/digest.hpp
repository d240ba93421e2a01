#pragma once
// What some windows say about every candidate, in a few hundred numbers.
//
// With the constant columns A, the target y and a shaped column phi(s), all over the same windows,
// QR of [A y] gives a triangle R and, for each node s_k of the shape, the projection c_k = Q' phi
// and what remains of phi beyond Q. Rows are gone: windows may be digested in any parts, and the
// digests of parts merge into the digest of the whole. That is what threads, long recordings and a
// sliding window live on.

#include <Eigen/Core>
#include <vector>

#include "identify/balance/decays.hpp"

namespace jointid::identify {

struct Digest {
  Eigen::MatrixXd triangle;     ///< m x m, upper: constant columns, target
  Eigen::MatrixXd projections;  ///< m x (shaped * nodes); a node's shaped columns are neighbours
  /// Inner products of what remains of a node's shaped columns, the upper triangle column by
  /// column, one column a node.
  Eigen::MatrixXd remainders;

  [[nodiscard]] Eigen::Index nodes() const { return remainders.cols(); }
};

/// How many inner products `shaped` columns have.
constexpr Eigen::Index pairs(Eigen::Index shaped) {
  return shaped * (shaped + 1) / 2;
}

/// Digest of rows. `constant`: rows x m (the target last), `columns`: rows x (shaped * nodes), in
/// the order of the projections; both are used up.
Digest digest(Eigen::MatrixXd& constant, Eigen::MatrixXd& columns, Eigen::Index shaped);

/// The digest of all rows from the digests of parts, which must be of one shape; at least one.
Digest merge(const std::vector<Digest>& parts);

}  // namespace jointid::identify
