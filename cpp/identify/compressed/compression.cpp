#include "identify/compressed/compression.hpp"

#include <algorithm>
#include <cmath>

namespace jointid::identify {

namespace {

constexpr std::int64_t kSamples =
    3072;  // windows per part: small enough to share 12 s of motion among threads
constexpr std::size_t kRows = 4096;  // windows digested together; only running integrals have more
// Operations that take less time than waking sleeping threads: done on the calling thread.
constexpr double kBrief = 2e6;
// Knee at which log(1 + s v^2 / kKnee) is even enough at its lower end (fewest nodes, on
// `well_excited`).
constexpr double kKnee = 10.0;
// Pieces per octave of the scale, as a power of 2.
constexpr int kPieces = 3;
constexpr double kGolden = 0.6180339887498949;

Eigen::Index count_for(double even_length, double density) {
  return static_cast<Eigen::Index>(std::ceil(density * (9.0 * even_length + 18.0)));
}

double rate_of(double velocity, double exponent) {
  return base::exp(-exponent * base::log(velocity));
}

/// Chebyshev points of an axis, and probes between them, each with the rate `rate(shape)`.
template <class Rate>
ShapeNodes nodes_on(const ShapeAxis& axis, Eigen::Index count, double exponent, Rate rate) {
  ShapeNodes result{axis, {exponent, {}}, {}};
  for (const double point : chebyshev_points(count)) {
    result.rates.rates.push_back(rate(axis.shape(point)));
  }
  for (int i = 1; i <= 5; ++i) {
    const double share = i * kGolden - std::floor(i * kGolden);
    result.probes.push_back(axis.shape(2.0 * share - 1.0));
    result.rates.rates.push_back(rate(result.probes.back()));
  }
  return result;
}

/// Parts of the windows. A running sum cannot be cut within a recording.
std::vector<Stretch> parts_of(const Penalty& penalty) {
  std::vector<Stretch> parts;
  const auto& recordings = penalty.recording_of();
  std::size_t begin = 0;
  for (std::size_t w = 1; w <= recordings.size(); ++w) {
    const bool last = w == recordings.size();
    const bool other = !last && recordings[w] != recordings[w - 1];
    const auto& windows = penalty.windows();
    const bool full =
        !penalty.cumulative() && !last && windows[w].end - windows[begin].begin > kSamples;
    if (!last && !other && !full) continue;
    parts.push_back({begin, w});
    begin = w;
  }
  return parts;
}

/// Running sums over the rows, continued from the rows before.
void accumulate(Eigen::MatrixXd& columns, Eigen::RowVectorXd& before) {
  if (before.size() == 0) before.setZero(columns.cols());
  columns.row(0) += before;
  for (Eigen::Index row = 1; row < columns.rows(); ++row) columns.row(row) += columns.row(row - 1);
  before = columns.row(columns.rows() - 1);
}

/// For running integrals, `before` holds the sums over the recording's windows before the block.
Digest digest_block(const Penalty& penalty, const Stretch& block, const DecayRates& group,
                    const base::Cancel* cancel, Eigen::RowVectorXd& before) {
  const auto rows = static_cast<Eigen::Index>(block.end - block.begin);
  const auto first = static_cast<Eigen::Index>(block.begin);
  const auto shaped = static_cast<Eigen::Index>(penalty.shaped().size());
  Eigen::MatrixXd constant(rows, penalty.coefficients() - shaped + 1);
  Eigen::Index to = 0;
  for (Eigen::Index j = 0; j < penalty.coefficients(); ++j) {
    if (penalty.is_shaped(j)) continue;
    constant.col(to++) = penalty.constant_columns().col(j).segment(first, rows);
  }
  constant.col(to) = penalty.target().segment(first, rows);
  const auto nodes = static_cast<Eigen::Index>(group.rates.size());
  Eigen::MatrixXd columns(rows, shaped * nodes);
  Eigen::MatrixXd own(rows, shaped > 1 ? nodes : 0);
  for (Eigen::Index j = 0; j < shaped; ++j) {
    const auto& term = penalty.shaped()[static_cast<std::size_t>(j)].term;
    if (shaped == 1) {
      integrate_decays(penalty.nodes(term.direction), block, group, cancel, columns);
      break;
    }
    integrate_decays(penalty.nodes(term.direction), block, group, cancel, own);
    for (Eigen::Index k = 0; k < nodes; ++k) columns.col(k * shaped + j) = own.col(k);
  }
  if (penalty.cumulative()) accumulate(columns, before);  // the constant columns are already sums
  return digest(constant, columns, shaped);
}

/// Exponentials, and products for the triangle: about a nanosecond each.
double operations(const Penalty& penalty, const DecayRates& decays) {
  const auto rates = static_cast<double>(decays.rates.size());
  double exponentials = 0.0;
  for (const auto& shaped : penalty.shaped()) {
    const auto& nodes = penalty.nodes(shaped.term.direction);
    exponentials += rates * static_cast<double>(nodes.speed.size());
  }
  const auto constant = static_cast<double>(penalty.coefficients() + 1);
  const double columns = constant + rates * static_cast<double>(penalty.shaped().size());
  return exponentials + constant * columns * static_cast<double>(penalty.windows().size());
}

}  // namespace

std::optional<ShapeNodes> shape_nodes(const Penalty& penalty, const search::Domain& domain,
                                      double speed, double density, std::string& reason) {
  const auto& shaped = penalty.shaped();
  const Eigen::Index p = penalty.coefficients();
  for (const auto& one : shaped) {
    if (one.shapes != shaped.front().shapes) {  // each belongs to one decay
      reason = "its decaying terms have shapes of their own";
      return std::nullopt;
    }
  }
  const double low = domain.lower[p];
  const double high = domain.upper[p];
  if (shaped.front().term.basis == model::SpeedBasis::gaussian) {
    const double even = std::max(speed * speed, 1e-300) / kKnee;
    if (!(1.0 + even * low > 0.0)) {
      reason = "the bounds of stribeck reach too far below 0";
      return std::nullopt;
    }
    const ShapeAxis axis(low, high, 1.0, even, kPieces);
    return nodes_on(axis, count_for(axis.length(), density), 2.0, [](double rate) { return rate; });
  }
  if (shaped.front().term.basis != model::SpeedBasis::general) {
    reason = "there is no table for " + shaped.front().term.key;
    return std::nullopt;
  }
  const double exponent = domain.lower[p + 1];
  if (exponent < domain.upper[p + 1]) {
    reason = "stribeck_exponent is searched, for which there is no table";
    return std::nullopt;
  }
  if (!(low > 0.0) || !(exponent > 0.0)) {
    reason = "stribeck_velocity and stribeck_exponent need bounds above 0";
    return std::nullopt;
  }
  const ShapeAxis axis(low, high, 0.0, 1.0, kPieces);
  return nodes_on(axis, count_for(exponent * axis.length(), density), exponent,
                  [&](double velocity) { return rate_of(velocity, exponent); });
}

Digest digest_part(const Penalty& penalty, const Stretch& windows, const DecayRates& rates,
                   const base::Cancel* cancel) {
  // In blocks, which bounds the memory and the time between two checks of the cancel flag.
  Eigen::RowVectorXd before;
  std::vector<Digest> blocks;
  std::size_t begin = windows.begin;
  do {  // a part without windows also has a digest
    if (cancel != nullptr) cancel->check();
    const Stretch block{begin, std::min(windows.end, begin + kRows)};
    blocks.push_back(digest_block(penalty, block, rates, cancel, before));
    begin = block.end;
  } while (begin < windows.end);
  return merge(blocks);
}

Digest digest_all(const Penalty& penalty, const DecayRates& rates, base::Pool& pool) {
  const auto parts = parts_of(penalty);
  std::vector<Digest> digests(parts.size());
  const auto work = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      digests[i] = digest_part(penalty, parts[i], rates, &pool.cancel());
    }
  };
  if (operations(penalty, rates) < kBrief) {
    work(0, parts.size());
  } else {
    pool.for_each(parts.size(), work);
  }
  return merge(digests);
}

Eigen::MatrixXd functions_of(const Digest& digest) {
  const Eigen::Index nodes = digest.nodes();
  const Eigen::Index size = digest.projections.size() / nodes;  // all shaped columns of a node
  Eigen::MatrixXd result(size + digest.remainders.rows(), nodes);
  result.topRows(size) = digest.projections.reshaped(size, nodes);
  result.bottomRows(digest.remainders.rows()) = digest.remainders;
  return result;
}

}  // namespace jointid::identify
