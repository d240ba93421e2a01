#include "identify/compressed/sliding_penalty.hpp"

#include <memory>
#include <stdexcept>
#include <utility>

namespace jointid::identify {

namespace {

// Nodes cannot be added later, so there are more than a whole recording needs.
constexpr double kDensity = 1.2;

}  // namespace

SlidingPenalty::SlidingPenalty(std::vector<std::string> terms, Residual residual, double gear_ratio,
                               double window_duration, bool mask_standstill,
                               const MotionScale& scale, search::Domain domain, double speed)
    : terms_(std::move(terms)),
      residual_(residual),
      gear_ratio_(gear_ratio),
      window_duration_(window_duration),
      mask_standstill_(mask_standstill),
      scale_(scale),
      domain_(std::move(domain)),
      speed_(speed) {
  domain_.validate();
  if (!scale.moves()) throw std::invalid_argument("scale must be that of a motion");
  if (!(speed > 0.0) || !(window_duration > 0.0)) {
    throw std::invalid_argument("speed and window_duration must be above 0, got " +
                                std::to_string(speed) + " and " + std::to_string(window_duration));
  }
}

void SlidingPenalty::append(const RecordingView& samples, Eigen::Index begin, Eigen::Index end) {
  if (begin < 0 || end <= begin || end >= samples.samples()) {
    throw std::invalid_argument("stretch " + std::to_string(begin) + " to " + std::to_string(end) +
                                " is not within the " + std::to_string(samples.samples()) +
                                " samples given");
  }
  samples.validate();
  if (!stretches_.empty() && samples.time[begin] < stretches_.back().end) {
    throw std::invalid_argument("a stretch begins at " + std::to_string(samples.time[begin]) +
                                " s, before the last one's end at " +
                                std::to_string(stretches_.back().end) + " s");
  }
  UsableIntervals usable = usable_intervals(samples, scale_, mask_standstill_);
  usable.usable = {usable.usable.begin() + begin, usable.usable.begin() + end};
  const auto cut = [&](const RecordingView::Signal& signal) {
    return signal.size() == 0 ? RecordingView::Signal(nullptr, 0)
                              : RecordingView::Signal(signal.data() + begin, end - begin + 1);
  };
  std::vector<std::int64_t> gaps;
  for (const auto gap : samples.gap_after) {
    if (gap >= begin && gap < end) gaps.push_back(gap - begin);
  }
  const RecordingView own(cut(samples.time), cut(samples.position), cut(samples.velocity),
                          cut(samples.torque), cut(samples.sensor), samples.torque_hold, gaps);
  const Penalty::Masked masked{std::make_shared<const MaskedRecording>(own, std::move(usable))};
  Penalty penalty = Penalty::fragment(masked, terms_, window_duration_, residual_, gear_ratio_);
  if (penalty.parameters() != domain_.size()) {
    throw std::invalid_argument("domain must have " + std::to_string(penalty.parameters()) +
                                " parameters, got " + std::to_string(domain_.size()));
  }
  if (penalty.peak_speed() > speed_) {
    throw std::invalid_argument("the joint moves at " + std::to_string(penalty.peak_speed()) +
                                ", faster than the " + std::to_string(speed_) +
                                " that was prepared for");
  }
  if (!nodes_ && !penalty.shaped().empty()) {
    std::string reason;
    nodes_ = shape_nodes(penalty, domain_, speed_, kDensity, reason);
    if (!nodes_) throw std::invalid_argument("the penalty cannot be compressed: " + reason);
  }
  const Stretch all{0, penalty.windows().size()};
  auto digest = digest_part(penalty, all, nodes_ ? nodes_->rates : DecayRates{}, nullptr);
  stretches_.push_back(
      {std::move(penalty), std::move(digest), samples.time[begin], samples.time[end]});
}

void SlidingPenalty::forget(double time) {
  while (!stretches_.empty() && stretches_.front().end <= time) stretches_.pop_front();
}

std::int64_t SlidingPenalty::window_count() const {
  std::int64_t count = 0;
  for (const auto& piece : stretches_) count += piece.penalty.window_count();
  return count;
}

double SlidingPenalty::begin() const {
  return stretches_.empty() ? 0.0 : stretches_.front().begin;
}

double SlidingPenalty::end() const {
  return stretches_.empty() ? 0.0 : stretches_.back().end;
}

std::optional<CompressedPenalty> SlidingPenalty::compressed() const {
  if (window_count() == 0) return std::nullopt;
  std::vector<Digest> parts;
  for (const auto& piece : stretches_) parts.push_back(piece.digest);
  return CompressedPenalty(stretches_.front().penalty, nodes_, merge(parts));
}

void SlidingPenalty::residuals(const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                               Eigen::MatrixXd& jacobian) const {
  residual.resize(window_count());
  jacobian.resize(window_count(), theta.size());
  Eigen::Index row = 0;
  Eigen::VectorXd own;
  Eigen::MatrixXd slopes;
  for (const auto& piece : stretches_) {
    piece.penalty.residuals(theta, own, &slopes);
    residual.segment(row, own.size()) = own;
    jacobian.middleRows(row, own.size()) = slopes;
    row += own.size();
  }
}

double SlidingPenalty::total(Eigen::Index coefficient) const {
  double sum = 0.0;
  for (const auto& piece : stretches_) {
    sum += piece.penalty.constant_columns().col(coefficient).sum();
  }
  return sum;
}

double SlidingPenalty::usable_duration() const {
  double sum = 0.0;
  for (const auto& piece : stretches_) sum += piece.penalty.usable_duration().sum();
  return sum;
}

}  // namespace jointid::identify
