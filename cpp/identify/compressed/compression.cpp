#include "identify/compressed/compression.hpp"

#include <algorithm>
#include <cmath>

namespace jointid::identify {

namespace {

constexpr std::int64_t kSamples = 3072;  // of a part: small enough to share 12 s among threads
constexpr std::size_t kRows = 4096;      // digested at once: only running integrals have more
// Operations that are done sooner than sleeping processors are awake: not handed to threads.
constexpr double kBrief = 2e6;
// Sums over the samples that cost as much as a usual genetic search by the direct sum.
constexpr Eigen::Index kMostPasses = 20'000;
// Where log(1 + s v^2 / kKnee) is even enough at its lower end (fewest nodes, on `well_excited`).
constexpr double kKnee = 10.0;
// Pieces an octave of the scale, as powers of 2.
constexpr int kFine = 3;
constexpr int kCoarse = 2;
constexpr double kGolden = 0.6180339887498949;

Eigen::Index count_for(double even_length, double density) {
  return static_cast<Eigen::Index>(std::ceil(density * (9.0 * even_length + 18.0)));
}

double rate_of(double velocity, double exponent) {
  return base::exp(-exponent * base::log(velocity));
}

/// Shapes between the points of a single axis.
void add_probes(ShapeNodes& nodes) {
  for (int i = 1; i <= 5; ++i) {
    const double share = i * kGolden - std::floor(i * kGolden);
    nodes.probes.push_back({nodes.axes[0].shape(2.0 * share - 1.0)});
  }
}

/// Parts of the windows; a running sum cannot be cut within a recording.
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

/// Running sums down the rows, on from those of the rows before.
void accumulate(Eigen::MatrixXd& columns, Eigen::RowVectorXd& before) {
  if (before.size() == 0) before.setZero(columns.cols());
  columns.row(0) += before;
  for (Eigen::Index row = 1; row < columns.rows(); ++row) columns.row(row) += columns.row(row - 1);
  before = columns.row(columns.rows() - 1);
}

/// `before` holds the sums over the recording's windows before the block's, for running integrals.
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
  if (penalty.cumulative()) accumulate(columns, before);  // the constant ones are sums already
  return digest(constant, columns, shaped);
}

/// A part in blocks, so that neither memory nor the time between two looks at the cancel flag grows
/// with it.
Digest digest_group(const Penalty& penalty, const Stretch& part, const DecayRates& group,
                    const base::Cancel* cancel) {
  Eigen::RowVectorXd before;
  std::vector<Digest> blocks;
  std::size_t begin = part.begin;
  do {  // a part without windows has a digest, too
    if (cancel != nullptr) cancel->check();
    const Stretch block{begin, std::min(part.end, begin + kRows)};
    blocks.push_back(digest_block(penalty, block, group, cancel, before));
    begin = block.end;
  } while (begin < part.end);
  return merge(blocks);
}

/// Exponentials, and products on the way to a triangle: about a nanosecond each.
double operations(const Penalty& penalty, const std::vector<DecayRates>& groups) {
  double rates = 0.0;
  for (const auto& group : groups) rates += static_cast<double>(group.rates.size());
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
  const auto low = [&](Eigen::Index i) { return domain.lower[p + i]; };
  const auto high = [&](Eigen::Index i) { return domain.upper[p + i]; };
  ShapeNodes result;
  if (shaped.front().term.basis == model::SpeedBasis::stribeck) {
    const double rate = std::max(speed * speed, 1e-300) / kKnee;
    if (!(1.0 + rate * low(0) > 0.0)) {
      reason = "the bounds of stribeck reach too far below 0";
      return std::nullopt;
    }
    result.order = {0};
    result.axes = {{low(0), high(0), 1.0, rate, kFine}};
    const auto& axis = result.axes[0];
    const auto points = chebyshev_points(count_for(axis.length(), density));
    result.lines.push_back({2.0, {}});
    for (const double point : points) result.lines[0].rates.push_back(axis.shape(point));
    add_probes(result);
    return result;
  }
  if (!(low(0) > 0.0) || !(low(1) > 0.0)) {
    reason = "stribeck_velocity and stribeck_exponent need bounds above 0";
    return std::nullopt;
  }
  if (low(1) == high(1)) {
    result.order = {0};
    result.exponent = low(1);
    result.axes = {{low(0), high(0), 0.0, 1.0, kFine}};
    const auto& axis = result.axes[0];
    result.lines.push_back({result.exponent, {}});
    for (const double point :
         chebyshev_points(count_for(result.exponent * axis.length(), density))) {
      result.lines[0].rates.push_back(rate_of(axis.shape(point), result.exponent));
    }
    add_probes(result);
    return result;
  }
  result.order = {1, 0};
  result.axes = {{low(1), high(1), 0.0, 1.0, kCoarse}, {low(0), high(0), 0.0, 1.0, kFine}};
  const auto& exponents = result.axes[0];
  const auto& velocities = result.axes[1];
  // The decay depends on exponent * log(speed / velocity).
  const double reach = base::log(std::max(2.0, speed / velocities.shape(-1.0)));
  const auto outer = chebyshev_points(count_for(1.2 * exponents.length() * reach, 0.6 * density));
  const auto inner_count = [&](double exponent) {
    return count_for(exponent * velocities.length(), density);
  };
  Eigen::Index passes = 0;
  for (const double place : outer) passes += inner_count(exponents.shape(place));
  if (passes > kMostPasses) {
    reason =
        "the bounds of stribeck_velocity and stribeck_exponent are so wide that their table "
        "takes " +
        std::to_string(passes) + " sums over the samples, more than the " +
        std::to_string(kMostPasses) + " that pay";
    return std::nullopt;
  }
  for (const double place : outer) {
    const double exponent = exponents.shape(place);
    const auto inner = chebyshev_points(inner_count(exponent));
    result.lines.push_back({exponent, {}});
    for (const double point : inner) {
      result.lines.back().rates.push_back(rate_of(velocities.shape(point), exponent));
    }
  }
  for (int i = 1; i <= 9; ++i) {
    const double share = i * kGolden - std::floor(i * kGolden);
    const double other = (i - 0.5) / 9.0;
    result.probes.push_back(
        {exponents.shape(2.0 * share - 1.0), velocities.shape(2.0 * other - 1.0)});
  }
  return result;
}

std::vector<DecayRates> rates_of(const ShapeNodes& nodes) {
  auto groups = nodes.lines;
  for (const auto& probe : nodes.probes) {
    if (probe.size() == 1) {
      groups[0].rates.push_back(nodes.exponent > 0.0 ? rate_of(probe[0], nodes.exponent)
                                                     : probe[0]);
    } else {
      groups.push_back({probe[0], {rate_of(probe[1], probe[0])}});
    }
  }
  return groups;
}

std::vector<Digest> digest_part(const Penalty& penalty, const Stretch& windows,
                                const std::vector<DecayRates>& groups, const base::Cancel* cancel) {
  std::vector<Digest> result;
  if (groups.empty()) result.push_back(digest_group(penalty, windows, {}, cancel));
  for (const auto& group : groups) {
    result.push_back(digest_group(penalty, windows, group, cancel));
  }
  return result;
}

std::vector<Digest> digest_all(const Penalty& penalty, const std::vector<DecayRates>& groups,
                               base::Pool& pool) {
  const auto parts = parts_of(penalty);
  const std::size_t count = std::max<std::size_t>(1, groups.size());
  std::vector<std::vector<Digest>> digests(count, std::vector<Digest>(parts.size()));
  const auto work = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t part = i % parts.size();
      const std::size_t group = i / parts.size();
      digests[group][part] = digest_group(
          penalty, parts[part], groups.empty() ? DecayRates{} : groups[group], &pool.cancel());
    }
  };
  if (operations(penalty, groups) < kBrief) {
    work(0, count * parts.size());
  } else {
    pool.for_each(count * parts.size(), work);
  }
  std::vector<Digest> result;
  for (const auto& group : digests) result.push_back(merge(group));
  return result;
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
