#pragma once
// The information of some windows about every candidate, in a few hundred numbers.
//
// A are the constant columns, y the target and phi(s) a shaped column, all over the same windows.
// QR of [A y] gives a triangle R and, for each node s_k of the shape, the projection c_k = Q' phi
// and the remainder of phi outside Q. No rows are kept: windows may be digested in any parts, and
// the digests of parts merge into the digest of the whole. Threads, long recordings and a sliding
// window use this.

#include <Eigen/Core>
#include <vector>

#include "identify/balance/decays.hpp"

namespace jointid::identify {

struct Digest {
  Eigen::MatrixXd triangle;     ///< m x m, upper: constant columns, target
  Eigen::MatrixXd projections;  ///< m x (shaped * nodes); a node's shaped columns are adjacent
  /// Inner products of the remainders of a node's shaped columns: the upper triangle by columns,
  /// one column per node.
  Eigen::MatrixXd remainders;

  [[nodiscard]] Eigen::Index nodes() const { return remainders.cols(); }
};

/// Number of inner products of `shaped` columns.
constexpr Eigen::Index pairs(Eigen::Index shaped) {
  return shaped * (shaped + 1) / 2;
}

/// Digest of rows. `constant`: rows x m (the target last), `columns`: rows x (shaped * nodes), in
/// the order of the projections. Both are overwritten.
Digest digest(Eigen::MatrixXd& constant, Eigen::MatrixXd& columns, Eigen::Index shaped);

/// The digest of all rows from the digests of parts, which must have one shape; at least one.
Digest merge(const std::vector<Digest>& parts);

}  // namespace jointid::identify
